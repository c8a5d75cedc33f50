"""Puts teeth and tongue where they belong behind the lips: MakeHuman's sit too deep to be seen in speech."""

from __future__ import annotations

import numpy as np

from core.face.face import PARTS

# The edge of the upper incisors lies below the line where lips meet (at rest women show 2 to 4 mm of them under a
# parted upper lip) and the lower ones bite behind them.
UPPER_EDGE_BELOW_LIPS_MM = 1.7
OVERBITE_MM = 1.6
UPPER_BEHIND_LIPS_MM = 7.5
OVERJET_MM = 1.8
TONGUE_BELOW_EDGE_MM = 1.0
TONGUE_BEHIND_MM = 6.0
TONGUE_FLATTER = 0.75
ARCH_WIDTH = 0.82  # of the room behind the lips; wider teeth would come out through the cheeks


def fit_mouth(positions: np.ndarray, part: np.ndarray, lips: np.ndarray) -> None:
    """Move teeth and tongue of one head in place.

    positions : shape (V, 3), mm, changed; part : shape (V,)
    lips : shape (2, 3), mm, where the upper and the lower lip meet
    """
    line = lips.mean(axis=0)
    room = np.abs(positions[part == PARTS.index("mouth_socket"), 0]).max()
    mouth = np.isin(part, [PARTS.index(name) for name in ("upper_teeth", "lower_teeth", "tongue")])
    positions[mouth, 0] *= ARCH_WIDTH * room / np.abs(positions[mouth, 0]).max()
    upper, lower, tongue = (part == PARTS.index(name) for name in ("upper_teeth", "lower_teeth", "tongue"))
    front = line[2] - UPPER_BEHIND_LIPS_MM
    edge = line[1] - UPPER_EDGE_BELOW_LIPS_MM
    _shift(positions, upper, edge - positions[upper, 1].min(), front - positions[upper, 2].max())
    _shift(
        positions,
        lower,
        edge + OVERBITE_MM - _incisor_top(positions[lower]),
        front - OVERJET_MM - positions[lower, 2].max(),
    )
    top = positions[tongue, 1].max()
    positions[tongue, 1] = top + TONGUE_FLATTER * (positions[tongue, 1] - top)
    tip = positions[tongue][positions[tongue, 2].argmax()]
    _shift(positions, tongue, edge - TONGUE_BELOW_EDGE_MM - tip[1], front - TONGUE_BEHIND_MM - tip[2])


def _incisor_top(teeth: np.ndarray) -> float:
    front = teeth[teeth[:, 2] > teeth[:, 2].max() - 4.0]
    return float(front[:, 1].max())


def _shift(positions: np.ndarray, which: np.ndarray, up: float, ahead: float) -> None:
    positions[which] += [0.0, up, ahead]
