"""Points followed one by one by OpenCV's pyramidal Lucas–Kanade, and how far each is to be believed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# In a face of the size that `core.tracking.video_pictures` gives, a window of skin this large holds something to see.
_WINDOW_PX = 21
_LEVELS = 3
_STEPS, _STILL_PX = 20, 0.02
# What comes back this far from where it began is believed at 1/e.
_RETURN_PX = 1.25
# Light changes over this much, and what varies less than this many grey levels around a pixel is noise.
_LIGHT_PX = 25
_FLATTEST = 6.0


def look_of(grey: np.ndarray) -> np.ndarray:
    """Make a grey picture ready, uint8, shape (height, width).

    Slow changes of light are taken out: each pixel is counted from the mean around it, in deviations around it.
    """
    import cv2

    seen = cv2.GaussianBlur(grey, (0, 0), 1.0).astype(np.float32)
    size = (_LIGHT_PX, _LIGHT_PX)
    mean = cv2.boxFilter(seen, -1, size)
    deviation = cv2.sqrt(cv2.max(cv2.boxFilter(seen * seen, -1, size) - mean * mean, _FLATTEST**2))
    return cv2.convertScaleAbs((seen - mean) / deviation * 40.0 + 128.0)


@dataclass(frozen=True)
class Flow:
    """Where points went.

    points : float64, shape (K, 2), pixels; trust : shape (K,), 0 lost .. 1 certain; returned_px : how far from its
    start each point comes back when followed backwards
    """

    points: np.ndarray
    trust: np.ndarray
    returned_px: np.ndarray


def followed(before: np.ndarray, now: np.ndarray, points: np.ndarray, guess: np.ndarray, levels: int = _LEVELS) -> Flow:
    """Follow ``points``, shape (K, 2), from one picture to another, beginning the search at ``guess``.

    Each is followed forwards and, from where it arrives, backwards; trust falls with the distance at which it returns.
    A point that leaves the picture, or begins outside of it, has none.

    before, now : of `look_of`; levels : of the pyramid, which doubles the reach with each
    """
    import cv2

    settings = {"winSize": (_WINDOW_PX, _WINDOW_PX), "maxLevel": levels, "minEigThreshold": 1e-5,
                "criteria": (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, _STEPS, _STILL_PX),
                "flags": cv2.OPTFLOW_USE_INITIAL_FLOW}  # fmt: skip
    start = np.ascontiguousarray(points, np.float32)[:, None]
    arrived, found, _ = cv2.calcOpticalFlowPyrLK(
        before, now, start, np.ascontiguousarray(guess, np.float32)[:, None].copy(), **settings
    )
    back, found_back, _ = cv2.calcOpticalFlowPyrLK(now, before, arrived, start.copy(), **settings)
    returned = np.linalg.norm((back - start)[:, 0], axis=1)
    seen = (found & found_back).ravel().astype(bool) & within(points, before) & within(arrived[:, 0], now)
    seen &= np.isfinite(returned)
    trust = np.where(seen, np.exp(-np.square(np.minimum(returned, 1e3) / _RETURN_PX)), 0.0)
    return Flow(np.where(np.isfinite(arrived[:, 0]), arrived[:, 0], guess).astype(float), trust, returned.astype(float))


def within(points: np.ndarray, look: np.ndarray) -> np.ndarray:
    """Which points, shape (K, 2), lie in the picture."""
    return ((points >= 0) & (points <= [look.shape[1] - 1, look.shape[0] - 1])).all(axis=1)
