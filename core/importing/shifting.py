"""Motion brought onto the time axis of its sound."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from core.motion.resample import fill_gaps

_WHOLE_FRAME = 1e-3


def shifted(positions: np.ndarray, rate_hz: float, offset_s: float) -> np.ndarray:
    """Take ``offset_s`` of lateness out: frame f of the answer is what stood at f / rate + offset_s.

    Between frames a cubic spline tells; a marker missing in either neighbour stays missing. Motion that is early gets
    missing frames at its beginning; motion that is late loses those before the sound begins.

    positions : shape (n_frames, n_markers, 3), mm, NaN where missing
    """
    positions = np.asarray(positions)
    frames = offset_s * rate_hz
    n_frames = max(len(positions) - int(np.floor(frames)), 1)
    at = np.arange(n_frames) + frames
    if abs(frames - round(frames)) < _WHOLE_FRAME:
        at = np.rint(at)
    low, high = np.floor(at).astype(int), np.ceil(at).astype(int)
    outside = (low < 0) | (high >= len(positions))
    while n_frames > 1 and outside[n_frames - 1]:
        n_frames -= 1
    at, low, high, outside = (array[:n_frames] for array in (at, low, high, outside))
    seen = np.isfinite(positions).all(axis=2)
    low, high = np.clip(low, 0, len(positions) - 1), np.clip(high, 0, len(positions) - 1)
    if len(positions) < 2 or (low == high).all():
        moved = np.array(positions[low], float)
    else:
        whole, _, _ = fill_gaps(positions, 0)
        moved = CubicSpline(np.arange(len(positions)), whole, axis=0)(np.clip(at, 0, len(positions) - 1))
    moved[~(seen[low] & seen[high])] = np.nan
    moved[outside] = np.nan
    return moved.astype(positions.dtype)
