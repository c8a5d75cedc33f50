"""Point sets laid on each other by scale, turn and shift (Umeyama 1991)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Similarity:
    """``scale * points @ rotation.T + shift``."""

    scale: float
    rotation: np.ndarray
    shift: np.ndarray

    def __call__(self, points: np.ndarray) -> np.ndarray:
        """Return ``points``, shape (..., 3), where the similarity takes them."""
        return self.scale * np.asarray(points) @ self.rotation.T + self.shift


def fit_similarity(points: np.ndarray, goal: np.ndarray, scale: float | None = None) -> Similarity:
    """Least-squares similarity of paired points (Umeyama 1991, equations 40 to 42); rotation without reflection.

    points, goal : shape (n, 3), n >= 1; scale : fixed, or None to estimate it
    """
    middle, goal_middle = points.mean(axis=0), goal.mean(axis=0)
    ours, theirs = points - middle, goal - goal_middle
    u, d, vt = np.linalg.svd(theirs.T @ ours)
    sign = np.array([1.0, 1.0, 1.0 if np.linalg.det(u @ vt) > 0 else -1.0])
    rotation = u * sign @ vt
    if scale is None:
        size = (ours**2).sum()
        scale = float((d * sign).sum() / size) if size > 0 else 1.0
    return Similarity(scale, rotation, goal_middle - scale * rotation @ middle)
