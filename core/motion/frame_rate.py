"""The frame rate that a column of times tells."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.motion_track import RateUnknown

HIGHEST_HZ = 10_000.0
# how far, in frames, a time may lie from where even steps put it
_UNEVEN_FRAMES = 0.25


def check_rate_hz(rate_hz: float, path: Path) -> float:
    """Return a rate that a file or a user states; raises `UserFacingError` when it is none."""
    if not 0 < rate_hz <= HIGHEST_HZ:
        raise UserFacingError(f"'{path}': {rate_hz:g} frames a second is no rate.", "Give its rate in Hz.")
    return float(rate_hz)


def rate_of_times(times_s: np.ndarray, path: Path, lines: np.ndarray) -> float:
    """Return frames a second of a take that names the time of every frame.

    times_s : shape (F,), seconds, as read; lines : shape (F,), where in the file each was, for messages
    Raises `RateUnknown` for fewer than two frames and `UserFacingError` where the times do not advance evenly.
    """
    if len(times_s) < 2:
        raise RateUnknown(path)
    unknown = ~np.isfinite(times_s)
    if unknown.any():
        raise UserFacingError(f"'{path}', line {lines[unknown.argmax()]}: the time is not a number.")
    with np.errstate(over="ignore"):
        duration_s = times_s[-1] - times_s[0]
    if not 0 < duration_s < np.inf:
        raise UserFacingError(f"'{path}': the time does not advance.")
    rate_hz = (len(times_s) - 1) / duration_s
    off = np.abs((times_s - times_s[0]) * rate_hz - np.arange(len(times_s)))
    if off.max() > _UNEVEN_FRAMES:
        line = lines[(off > _UNEVEN_FRAMES).argmax()]
        raise UserFacingError(f"'{path}', line {line}: the time does not advance evenly.", "Give every frame its row.")
    # times are rounded to milli- or microseconds; the rate that was meant is a whole number or a television rate
    milliseconds = (times_s - times_s[0]) * 1e3
    rounding_s = 1e-3 if np.abs(milliseconds - np.rint(milliseconds)).max() < 1e-4 else 1.5e-6
    for meant in (round(rate_hz), round(rate_hz * 1.001) / 1.001):
        if abs(rate_hz - meant) <= rate_hz * max(1e-6, rounding_s / duration_s):
            rate_hz = meant
            break
    return check_rate_hz(float(rate_hz), path)
