"""A folder of files that is there as a whole or not at all."""

from __future__ import annotations

import contextlib
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

from core.errors import UserFacingError


def check_new_folder(path: Path) -> None:
    """Raise `UserFacingError`, before any work goes into it, unless ``path`` can become a new folder.

    An empty folder that is there already will do.
    """
    try:
        if path.exists() and not path.is_dir():
            raise UserFacingError(f"'{path}' is not a folder.")
        if path.is_dir() and any(path.iterdir()):
            raise UserFacingError(f"The folder '{path}' is not empty.", "Name a new one.")
        if not path.parent.is_dir():
            raise UserFacingError(f"There is no folder '{path.parent}' to make '{path.name}' in.")
        trial = _beside(path)
        trial.mkdir()
        trial.rmdir()
    except OSError as error:
        raise UserFacingError(f"The folder '{path}' cannot be made: {error.strerror or error}.") from error


@contextlib.contextmanager
def swapped_in_folder(path: Path) -> Iterator[Path]:
    """Give a folder beside ``path`` to fill; it becomes ``path`` when the block ends well.

    When the block fails or is cancelled, nothing is left behind. See `check_new_folder` for what ``path`` may be;
    what the system refuses is raised as `UserFacingError`.
    """
    check_new_folder(path)
    beside = _beside(path)
    try:
        beside.mkdir()
        yield beside
        if path.is_dir():
            path.rmdir()  # it is empty; Windows moves no folder onto another
        beside.rename(path)
    except OSError as error:
        raise UserFacingError(f"The folder '{path}' cannot be made: {error.strerror or error}.") from error
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def _beside(path: Path) -> Path:
    return path.absolute().parent / f".{secrets.token_hex(8)}.part"
