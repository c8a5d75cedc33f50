"""Units of length that motion files are measured in, and how one is told from the size of a face."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.motion_track import UnitUnknown

MM_PER_UNIT = {
    "mm": 1.0, "millimeters": 1.0, "millimetres": 1.0, "millimeter": 1.0, "millimetre": 1.0,
    "cm": 10.0, "centimeters": 10.0, "centimetres": 10.0, "centimeter": 10.0, "centimetre": 10.0,
    "dm": 100.0, "m": 1000.0, "meters": 1000.0, "metres": 1000.0, "meter": 1000.0, "metre": 1000.0,
    "in": 25.4, "inch": 25.4, "inches": 25.4,
}  # fmt: skip
# A face's markers span 0.15 to 0.3 m; lips alone 0.05, head and shoulders 0.5. Between the spans of two units lies what
# could be either, and is asked for. Inches would fall between cm and dm, so they must be named.
_SPANS = {"mm": (50.0, 3000.0), "cm": (5.0, 50.0), "m": (0.05, 0.5)}


def mm_per(unit: str, path: Path) -> float:
    """Return the millimetres of a unit that a file or a user names; raises `UserFacingError` for a strange one."""
    factor = MM_PER_UNIT.get(unit.strip().lower())
    if factor is None:
        raise UserFacingError(f"'{path}': '{unit.strip()[:20]}' is no unit of length.", "Give mm, cm, m or in.")
    return factor


def unit_by_span(positions: np.ndarray, path: Path) -> tuple[str, str]:
    """Tell mm, cm and m apart by how far the markers lie apart.

    The span is the diagonal of the box around the markers of a frame, median over frames: 50 to 3000 are mm, 5 to 50
    are cm, 0.05 to 0.5 are m.

    positions : shape (F, K, 3), NaN where missing
    returns : the unit and a sentence that says how it was told; raises `UnitUnknown` for any other span
    """
    span = median_span(positions)
    for unit, (low, high) in _SPANS.items():
        if low <= span < high:
            return unit, f"Lengths are taken as {unit}: the markers span {span:.3g}."
    raise UnitUnknown(path, span)


def median_span(positions: np.ndarray) -> float:
    """Return the median diagonal of the box around the markers of a frame; 0 where no frame shows any."""
    seen = np.isfinite(positions).all(axis=2)
    shown = seen.any(axis=1)
    if not shown.any():
        return 0.0
    low = np.where(seen[..., None], positions, np.inf)[shown].min(axis=1)
    high = np.where(seen[..., None], positions, -np.inf)[shown].max(axis=1)
    return float(np.median(np.linalg.norm((high - low).astype(float), axis=1)))
