"""One window a project: a lock that the system lets go of, however its holder ends."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path
from typing import IO

from core.errors import UserFacingError
from core.file_lock import lock_file
from core.folders import data_dir


class ProjectLocked(UserFacingError):
    """Another window has the project open."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"'{path}' is open in another window.", "Close it there to go on with it here.")


class ProjectLock:
    """Held from its making to `release`; raises `ProjectLocked` when another window holds it.

    It lies in the data folder, for a file system may not let us write beside the project. Two machines that open one
    file on a server are told apart later, by what they write (`core.document.project_file.ProjectFile.save`).
    """

    def __init__(self, path: Path) -> None:
        name = hashlib.sha256(os.fsencode(os.path.realpath(path))).hexdigest()[:32]
        folder = data_dir() / "locks"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._file: IO | None = (folder / f"{name}.lock").open("a+b")
        except OSError as error:
            raise UserFacingError(
                f"The data folder '{folder}' cannot be written: {error.strerror}.",
                "Let EFASE_DATA_DIR name a folder that can be.",
            ) from error
        try:
            lock_file(self._file)
        except OSError as error:
            self._file.close()
            raise ProjectLocked(path) from error

    def release(self) -> None:
        """Let another window open the project."""
        if self._file is not None:
            self._file.close()
            self._file = None
