"""Markers as a table: ``frame,time_s,<marker>_x,<marker>_y,<marker>_z,...``, millimetres.

`core.motion.readers.marker_text` reads it back.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.media.swap_in import swapped_in


def write_markers_csv(path: str | Path, positions: np.ndarray, names: Sequence[str], rate_hz: float) -> None:
    """Write markers, one row a frame; ``frame`` counts from 0 and a missing marker leaves its cells empty.

    positions : shape (F, K, 3), mm, NaN where missing; names : K; rate_hz : frames a second

    Raises `UserFacingError` when the file cannot be written.
    """
    positions = np.asarray(positions, float)
    if positions.ndim != 3 or positions.shape[1:] != (len(names), 3):
        raise ValueError(f"positions have shape {positions.shape}; {len(names)} markers need (F, {len(names)}, 3)")
    header = ["frame", "time_s", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(header)
        for f, frame in enumerate(positions.reshape(len(positions), -1)):
            cells = ["" if value != value else f"{value:.5f}" for value in frame.tolist()]
            rows.writerow([f, f"{f / rate_hz:.9f}", *cells])
