"""Exports are written beside their target, then swapped in: a reader never sees half a file."""

from __future__ import annotations

import contextlib
import re
import secrets
from collections.abc import Iterator
from pathlib import Path

from core.errors import UserFacingError

_LONGEST_SUFFIX = 16
_LIBRARY_MESSAGE = re.compile(r"error message = '([^']+)'")


def check_target(path: Path, folders_are_made: bool = False) -> None:
    """Raise `UserFacingError`, before any work goes into it, when ``path`` could not be written.

    folders_are_made : missing folders on the way are no hindrance
    """
    folder = path.parent
    try:
        if path.exists() and not path.is_file():
            raise UserFacingError(f"'{path}' is a folder." if path.is_dir() else f"'{path}' is not a file.")
        while folders_are_made and not folder.exists() and folder != folder.parent:
            folder = folder.parent
        if not folder.is_dir():
            raise UserFacingError(f"There is no folder '{folder}' to write '{path.name}' into.")
        trial = _beside(folder / path.name)
        trial.touch()
        trial.unlink()
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be written: {_reason(error)}.") from error


@contextlib.contextmanager
def swapped_in(path: str | Path) -> Iterator[Path]:
    """Give a path beside ``path`` to write to; it takes the place of ``path`` when the block ends well.

    When the block fails, nothing is left behind and ``path`` stays as it was. What the system refuses
    (no folder, no right, a full disk) is raised as `UserFacingError`.
    """
    path = Path(path)
    beside = _beside(path)
    try:
        yield beside
        beside.replace(path)
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be written: {_reason(error)}.") from error
    finally:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)


def _beside(path: Path) -> Path:
    # not named after its target, whose name may already be as long as the system allows
    return path.with_name(f".{secrets.token_hex(8)}.part{path.suffix[:_LONGEST_SUFFIX]}")


def _reason(error: OSError) -> str:
    """What the system said, also where HDF5 wraps it into a long message of its own."""
    wrapped = _LIBRARY_MESSAGE.search(str(error))
    return wrapped[1] if wrapped else error.strerror or str(error)
