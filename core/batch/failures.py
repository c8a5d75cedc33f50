"""The table of what failed in a batch, and why."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

from core.media.swap_in import swapped_in


def write_failures(path: Path, rows: Iterable[tuple[str, str]]) -> None:
    """Write a table of what failed and why; raises `UserFacingError`."""
    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("name", "failure"))
        writer.writerows(rows)
