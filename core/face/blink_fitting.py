"""Makes a blink close the eyes of each character: the unit was sculpted on one shape and falls short on others."""

from __future__ import annotations

import numpy as np

LID_THICKNESS_MM = 0.7
OVERLAP_MM = 0.2  # how far the upper lid comes down over the lower one, so that no slit stays
LEAST, MOST = 0.5, 2.0
MIDDLE = (0.3, 0.8)  # of the width of the eye


def fitted_blink(positions: np.ndarray, unit: np.ndarray, loop: np.ndarray, ball: np.ndarray) -> np.ndarray:
    """Return the blink ``unit``, stretched until the upper rim meets the lower one.

    positions, unit : shape (V, 3), mm; loop : int, the rim of the lids, in order; ball : shape (B, 3), the eyeball
    """
    rim = positions[loop]
    corners = np.array([rim[:, 0].argmin(), rim[:, 0].argmax()])
    upper, lower = _two_sides(loop, corners, positions)
    closed = positions + unit
    x = closed[lower][np.argsort(closed[lower][:, 0])]
    wanted = np.interp(closed[upper][:, 0], x[:, 0], x[:, 1]) - OVERLAP_MM - positions[upper][:, 1]
    # the middle of the eye decides for all of it: near the corners, where nothing moves, a ratio says nothing
    across = (positions[upper][:, 0] - rim[:, 0].min()) / np.ptp(rim[:, 0])
    middle = (across > MIDDLE[0]) & (across < MIDDLE[1])
    stretch = float(np.clip((wanted[middle] / np.minimum(unit[upper, 1], -0.3)[middle]).max(), LEAST, MOST))
    fitted = unit.copy()
    falling = unit[:, 1] < 0
    fitted[falling, 1:] *= stretch
    return fitted + _out_of_ball(positions, fitted, ball)


def _two_sides(loop: np.ndarray, corners: np.ndarray, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    first, last = sorted(corners.tolist())
    one, other = loop[first + 1 : last], np.concatenate([loop[last + 1 :], loop[:first]])
    return (one, other) if positions[one, 1].mean() > positions[other, 1].mean() else (other, one)


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
