"""From a point on a map to a face: barycentric interpolation inside a Delaunay triangle.

Deng and Neumann 2008, section 4 and figure 7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.manifold.isomap import PhonemeMap


@dataclass(frozen=True)
class Pick:
    """A picked point.

    frames : int64, shape (3,) or (1,), rows of the database's frames; weights : same length, sum to 1
    inside : False when the point lies outside the triangulation and the nearest frame stands in
    nearest : place within the map (not a database row) of the nearest frame
    """

    frames: np.ndarray
    weights: np.ndarray
    inside: bool
    nearest: int

    def blend(self, frames: np.ndarray) -> np.ndarray:
        """Return the interpolated frame, shape (n_dims,), of the database's ``frames``."""
        return self.weights @ frames[self.frames]


def pick(phoneme_map: PhonemeMap, point: np.ndarray) -> Pick:
    """Pick ``point``, shape (2,), in map coordinates."""
    points = phoneme_map.embedding.astype(float)
    point = np.asarray(point, float)
    nearest = int(((points - point) ** 2).sum(axis=1).argmin())
    triangles = phoneme_map.triangles
    if len(triangles):
        a, b, c = points[triangles].transpose(1, 0, 2)
        u, v, w = b - a, c - a, point - a
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            second = (w[:, 0] * v[:, 1] - w[:, 1] * v[:, 0]) / area
            third = (u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]) / area
        lowest = np.minimum(np.minimum(second, third), 1.0 - second - third)
        lowest = np.where(np.isfinite(lowest), lowest, -np.inf)
        best = int(lowest.argmax())
        if lowest[best] >= -1e-9:
            weights = np.array([1.0 - second[best] - third[best], second[best], third[best]]).clip(0.0)
            return Pick(phoneme_map.frames[triangles[best]], weights / weights.sum(), True, nearest)
    return Pick(phoneme_map.frames[[nearest]], np.ones(1), False, nearest)
