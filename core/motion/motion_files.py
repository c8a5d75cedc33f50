"""Marker motion on disk, in whichever of the kinds we know."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.c3d import read_c3d, write_c3d
from core.motion.marker_csv import read_markers_csv, write_markers_csv

__all__ = ["SUFFIXES", "read_motion", "write_c3d", "write_markers_csv"]

SUFFIXES = (".c3d", ".csv", ".tsv")


def read_motion(path: str | Path) -> tuple[np.ndarray, tuple[str, ...], float]:
    """Read marker motion from .c3d, .csv or .tsv.

    Returns positions (float32, shape (F, K, 3), mm, NaN where a marker is missing), the K marker names, and frames
    a second. Raises `UserFacingError` for a file that is missing, empty, damaged or of another kind.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise UserFacingError(f"'{path}' is no kind of motion file that can be read.", "Use .c3d, .csv or .tsv.")
    if not path.is_file():
        raise UserFacingError(f"There is no motion file '{path}'.")
    return read_c3d(path) if suffix == ".c3d" else read_markers_csv(path)
