"""A lock on an open file that the system lets go of, however its holder ends."""

from __future__ import annotations

import os
from typing import IO

_BEYOND = 1 << 30  # Windows locks bytes, and nobody may read those; these hold nothing


def lock_file(file: IO) -> None:
    """Lock an open file for this process alone; raises `OSError` at once when another holds it."""
    if os.name == "nt":
        import msvcrt

        file.seek(_BEYOND)
        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
