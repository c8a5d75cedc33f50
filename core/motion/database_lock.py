"""Who may write to a database and its curation list: one process at a time; all others read."""

from __future__ import annotations

import contextlib
import getpass
import os
import socket
from pathlib import Path
from typing import IO

from core.errors import UserFacingError
from core.file_lock import lock_file

SUFFIX = ".lock"
_LONGEST_HOLDER = 200
_TRIES = 20


class DatabaseLocked(UserFacingError):
    """Another process writes to the database."""

    def __init__(self, path: Path, holder: str) -> None:
        self.holder = holder
        super().__init__(
            f"The database '{path}' is open for writing elsewhere{f' ({holder})' if holder else ''}.",
            "Close it there to change it here; it can be read meanwhile.",
        )


class DatabaseLock:
    """Held from its making to `release`, also as a context manager.

    A file beside the database holds who has it. The system's lock on that file is what counts, and it goes with the
    process: what a process that was killed left behind is taken over. Raises `DatabaseLocked` when another holds it,
    `UserFacingError` when the folder cannot be written.
    """

    def __init__(self, path: Path) -> None:
        self._path = path.with_name(path.name + SUFFIX)
        self._file: IO | None = None
        try:
            for _ in range(_TRIES):
                file = self._path.open("a+b")
                try:
                    lock_file(file)
                except OSError as error:
                    holder = _holder(file)
                    file.close()
                    raise DatabaseLocked(path, holder) from error
                if _is_at(file, self._path):
                    break
                file.close()  # its holder threw it away while we came: the next one counts
            else:
                raise DatabaseLocked(path, "")
            file.truncate(0)
            file.write(_myself().encode(errors="replace"))
            file.flush()
        except OSError as error:
            raise UserFacingError(f"The database '{path}' cannot be written to: {error.strerror}.") from error
        self._file = file

    def release(self) -> None:
        """Let another process write."""
        if self._file is not None:
            with contextlib.suppress(OSError):  # Windows does not throw away what is open
                self._path.unlink()
            self._file.close()
            self._file = None

    def __enter__(self) -> DatabaseLock:
        return self

    def __exit__(self, *_: object) -> None:
        self.release()


def _is_at(file: IO, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
    except OSError:
        return False


def _holder(file: IO) -> str:
    try:
        file.seek(0)
        text = file.read(_LONGEST_HOLDER).decode(errors="replace")
    except OSError:
        return ""
    return "".join(c for c in text if c.isprintable())


def _myself() -> str:
    try:
        who = getpass.getuser()
    except (OSError, KeyError, ImportError):
        who = "someone"
    return f"{who} on {socket.gethostname()}, process {os.getpid()}"
