"""Markers to a character's controls one frame at a time, quick enough for a live face."""

from __future__ import annotations

import numpy as np

from core.animeme.cross_mapping import RIDGE_MM2, bounded_least_squares, units_at_markers
from core.face.face import Face
from core.motion.marker_set import MarkerSet

_ROUNDS = 12
_TOLERANCE = 1e-9


class LiveWeights:
    """Finds what `core.animeme.cross_mapping.solve_controls` finds, frame after frame.

    Which controls rest at 0 or 1 changes little from one frame to the next, so the last frame's are tried first, and
    mended until the conditions of optimality hold; a frame for which they do not soon hold is solved from scratch.

    names : of the U controls
    """

    def __init__(self, face: Face, markers: MarkerSet) -> None:
        """Raises `UserFacingError` when the markers cannot be laid on the face."""
        self.names, units = units_at_markers(face, markers)
        self._basis = units.reshape(len(units), -1)
        self._ridge = RIDGE_MM2 * self._basis.shape[1] / 3.0
        self._gram = self._basis @ self._basis.T + self._ridge * np.eye(len(units))
        size = self._gram.diagonal()
        self._moves = size > 1e-9 * size.max() + self._ridge
        self._at_low, self._at_high = np.ones(len(units), bool), np.zeros(len(units), bool)

    def solve(self, displacements: np.ndarray) -> np.ndarray:
        """Return the controls, float64, shape (U,), 0..1, for markers displaced by ``displacements``, (K, 3), mm."""
        target = np.asarray(displacements, float).reshape(-1)
        wanted = self._basis @ target
        slack = _TOLERANCE * (1.0 + np.abs(wanted).max())
        low, high = self._at_low | ~self._moves, self._at_high & self._moves
        for _ in range(_ROUNDS):
            x = high.astype(float)
            free = np.flatnonzero(~(low | high))
            if len(free):
                x[free] = np.linalg.solve(
                    self._gram[np.ix_(free, free)], wanted[free] - self._gram[free][:, high].sum(axis=1)
                )
            pull = wanted - self._gram @ x
            below, above = x < -_TOLERANCE, x > 1.0 + _TOLERANCE
            low_pulls, high_pulls = low & self._moves & (pull > slack), high & (pull < -slack)
            if not (below.any() or above.any() or low_pulls.any() or high_pulls.any()):
                self._at_low, self._at_high = low, high
                return np.clip(x, 0.0, 1.0)
            low = (low & ~low_pulls) | below
            high = (high & ~high_pulls) | above
        x = bounded_least_squares(self._basis, target[None], self._ridge)[0]
        self._at_low, self._at_high = x <= 0.0, x >= 1.0
        return x
