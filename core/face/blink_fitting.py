"""Makes a blink close the eyes of each character: the unit was sculpted on one shape and falls short on others."""

from __future__ import annotations

import numpy as np

LID_THICKNESS_MM = 0.7
OVERLAP_MM = 0.2  # how far the upper lid comes down over the lower one, so that no slit stays
LEAST, MOST = 0.5, 2.0
FEWEST = 8
MIDDLE = (0.3, 0.8)  # of the width of the eye


def fitted_blink(positions: np.ndarray, unit: np.ndarray, rim: np.ndarray, ball: np.ndarray) -> np.ndarray:
    """Return the blink ``unit``, stretched until the upper rim meets the lower one.

    positions, unit : shape (V, 3), mm; rim : int, the vertices of the opening of the eye; ball : shape (B, 3), the
    eyeball. A face whose eye has no rim to go by keeps its unit
    """
    at = positions[rim]
    if len(rim) < FEWEST:
        return unit
    first, last = at[at[:, 0].argmin()], at[at[:, 0].argmax()]
    across = (at[:, 0] - first[0]) / max(last[0] - first[0], 1e-6)
    above = at[:, 1] > first[1] + across * (last[1] - first[1])
    upper, lower = rim[above], rim[~above]
    closed = positions + unit
    x = closed[lower][np.argsort(closed[lower][:, 0])]
    wanted = np.interp(closed[upper][:, 0], x[:, 0], x[:, 1]) - OVERLAP_MM - positions[upper][:, 1]
    # the middle of the eye decides for all of it: near the corners, where nothing moves, a ratio says nothing
    middle = (across[above] > MIDDLE[0]) & (across[above] < MIDDLE[1])
    if not middle.any():
        return unit
    stretch = float(np.clip((wanted[middle] / np.minimum(unit[upper, 1], -0.3)[middle]).max(), LEAST, MOST))
    fitted = unit.copy()
    falling = unit[:, 1] < 0
    fitted[falling, 1:] *= stretch
    return fitted + _out_of_ball(positions, fitted, ball)


def _out_of_ball(positions: np.ndarray, moved: np.ndarray, ball: np.ndarray) -> np.ndarray:
    centre = (ball.min(axis=0) + ball.max(axis=0)) / 2
    rest = np.linalg.norm(positions - centre, axis=1)
    offset = positions + moved - centre
    reach = np.linalg.norm(offset, axis=1)
    # the inner rim lies within the ball at rest, tucked behind the margin, and may stay so
    least = np.minimum(rest, np.ptp(ball[:, 0]) / 2 + LID_THICKNESS_MM)
    deep = (np.linalg.norm(moved, axis=1) > 0.5) & (reach < least)
    pushed = np.zeros_like(positions)
    pushed[deep] = offset[deep] * (least[deep] / reach[deep] - 1.0)[:, None]
    return pushed
