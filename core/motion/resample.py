"""From one frame rate to another, and gaps filled."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.ndimage import gaussian_filter1d


def resample(values: np.ndarray, rate_hz: float, new_rate_hz: float, n_frames: int) -> np.ndarray:
    """Sample a track at another rate by a natural cubic spline.

    Going down, a Gaussian takes out what the new rate cannot carry: of a wave of f Hz it leaves 2 ** -(f / c) ** 2,
    c being half the new rate (-6 dB there; from 240 to 120 Hz, 98.8 % of a wave of 8 Hz). Frame f stands at
    f / rate; before the first and after the last sample the track holds still.

    values : shape (n_old, ...), finite
    returns : float64, shape (n_frames, ...)
    """
    values = np.asarray(values, float)
    if len(values) == 0:
        raise ValueError("a track without frames cannot be resampled")
    if new_rate_hz < rate_hz * 0.99:
        cutoff_hz = new_rate_hz / 2
        sigma_frames = np.sqrt(np.log(2) / 2) / np.pi * rate_hz / cutoff_hz
        values = gaussian_filter1d(values, sigma_frames, axis=0, mode="nearest")
    times = np.clip(np.arange(n_frames) / new_rate_hz, 0.0, (len(values) - 1) / rate_hz)
    if len(values) < 3:
        old = np.arange(len(values)) / rate_hz
        flat = values.reshape(len(values), -1)
        columns = [np.interp(times, old, column) for column in flat.T]
        return np.stack(columns, axis=1).reshape(n_frames, *values.shape[1:])
    return CubicSpline(np.arange(len(values)) / rate_hz, values, axis=0, bc_type="natural")(times)


def frame_bounds(starts_s: Sequence[float], ends_s: Sequence[float], rate_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Return first and one-past-last frame of each span, rounded so that neighbours share their boundary."""
    start, stop = (np.rint(np.asarray(times_s, float) * rate_hz).astype(int) for times_s in (starts_s, ends_s))
    return start, stop


def fill_gaps(positions: np.ndarray, longest_frames: int) -> tuple[np.ndarray, int, np.ndarray]:
    """Bridge the short gaps of each marker by a monotone cubic; mask the frames of the long ones.

    A gap at the very start or end is short when it has at most ``longest_frames``, and holds the nearest frame.

    positions : shape (n_frames, n_markers, 3), NaN where missing
    returns : finite positions of the same shape (long gaps are bridged too, so that filters have something to stand
        on), the number of marker samples that were filled in short gaps, and a bool mask, shape (n_frames,), of
        frames that must not be used
    """
    filled = np.array(positions, float)
    missing = ~np.isfinite(filled).all(axis=2)
    masked = np.zeros(len(filled), bool)
    n_filled = 0
    frames = np.arange(len(filled))
    for k in np.flatnonzero(missing.any(axis=0)):
        seen = ~missing[:, k]
        if seen.sum() < 2:
            masked[:] = True
            filled[:, k] = filled[seen, k].mean(axis=0) if seen.any() else 0.0
            continue
        bridge = PchipInterpolator(frames[seen], filled[seen, k], axis=0)
        first, last = frames[seen][[0, -1]]
        filled[~seen, k] = bridge(np.clip(frames[~seen], first, last))
        edges = np.diff(np.concatenate(([0], missing[:, k].astype(int), [0])))
        for start, stop in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)):
            if stop - start > longest_frames:
                masked[start:stop] = True
            else:
                n_filled += int(stop - start)
    return filled, n_filled, masked
