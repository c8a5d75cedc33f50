"""Exports are written beside their target, then swapped in: a reader never sees half a file."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path

from core.errors import UserFacingError


@contextlib.contextmanager
def swapped_in(path: str | Path) -> Iterator[Path]:
    """Give a path beside ``path`` to write to; it takes the place of ``path`` when the block ends well.

    When the block fails, nothing is left behind and ``path`` stays as it was. What the system refuses
    (no folder, no right, a full disk) is raised as `UserFacingError`.
    """
    path = Path(path)
    beside = path.with_name(f".{path.name}.{os.getpid()}.part{path.suffix}")
    try:
        yield beside
        beside.replace(path)
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be written: {error.strerror or error}.") from error
    finally:
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)
