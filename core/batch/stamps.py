"""Whether a file is still the one that was read: its size and when it was changed."""

from __future__ import annotations

from pathlib import Path

ABSENT = (-1, -1)


def stamp(path: Path) -> tuple[int, int]:
    """Return size in bytes and time of change in ns, or `ABSENT` for what is not there."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return ABSENT
    return found.st_size, found.st_mtime_ns
