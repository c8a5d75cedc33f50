"""Makes a blink close the eyes of each character: the unit was sculpted on one shape and falls short on others."""

from __future__ import annotations

import numpy as np

LID_THICKNESS_MM = 0.7
OVERLAP_MM = 0.2  # how far the upper lid comes down over the lower one, so that no slit stays
LEAST, MOST = 0.6, 2.0
CORNER = 0.15  # of the width of the eye


def fitted_blink(positions: np.ndarray, unit: np.ndarray, loop: np.ndarray, ball: np.ndarray) -> np.ndarray:
    """Return the blink ``unit``, stretched column by column until the upper rim meets the lower one.

    positions, unit : shape (V, 3), mm; loop : int, the rim of the lids, in order; ball : shape (B, 3), the eyeball
    """
    rim = positions[loop]
    corners = np.array([rim[:, 0].argmin(), rim[:, 0].argmax()])
    upper, lower = _two_sides(loop, corners, positions)
    closed = positions + unit
    x = closed[lower][np.argsort(closed[lower][:, 0])]
    at_x = positions[upper][:, 0]
    wanted = np.interp(closed[upper][:, 0], x[:, 0], x[:, 1]) - OVERLAP_MM - positions[upper][:, 1]
    moved = np.minimum(unit[upper, 1], -0.3)
    stretch = np.clip(wanted / moved, LEAST, MOST)
    # at the corners nothing moves, and a ratio of two nothings says nothing
    across = (at_x - rim[:, 0].min()) / np.ptp(rim[:, 0])
    inner = np.clip(np.minimum(across, 1.0 - across) / CORNER, 0.0, 1.0)
    stretch = 1.0 + inner * (stretch - 1.0)
    order = np.argsort(at_x)
    stretch = np.convolve(np.pad(stretch[order], 1, mode="edge"), [0.25, 0.5, 0.25], mode="valid")
    fitted = unit.copy()
    falling = unit[:, 1] < 0
    fitted[falling] *= np.interp(positions[falling, 0], at_x[order], stretch, left=1.0, right=1.0)[:, None]
    return fitted + _out_of_ball(positions + fitted, np.linalg.norm(fitted, axis=1) > 0.5, ball)


def _two_sides(loop: np.ndarray, corners: np.ndarray, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    first, last = sorted(corners.tolist())
    one, other = loop[first + 1 : last], np.concatenate([loop[last + 1 :], loop[:first]])
    return (one, other) if positions[one, 1].mean() > positions[other, 1].mean() else (other, one)


def _out_of_ball(closed: np.ndarray, moved: np.ndarray, ball: np.ndarray) -> np.ndarray:
    centre = (ball.min(axis=0) + ball.max(axis=0)) / 2
    radius = np.ptp(ball[:, 0]) / 2 + LID_THICKNESS_MM
    offset = closed - centre
    reach = np.linalg.norm(offset, axis=1)
    deep = moved & (reach < radius) & (reach > 0.5 * radius)
    pushed = np.zeros_like(closed)
    pushed[deep] = offset[deep] * (radius / reach[deep] - 1.0)[:, None]
    return pushed
