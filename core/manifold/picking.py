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


class Picker:
    """Picks points of one map; the work that all picks share is done once, so that a pick keeps up with the pointer."""

    def __init__(self, phoneme_map: PhonemeMap) -> None:
        self._map = phoneme_map
        self._points = phoneme_map.embedding.astype(float)
        a, b, c = self._points[phoneme_map.triangles].transpose(1, 0, 2)
        u, v = b - a, c - a
        area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            second = np.column_stack([v[:, 1], -v[:, 0]]) / area[:, None]
            third = np.column_stack([-u[:, 1], u[:, 0]]) / area[:, None]
        flat = ~(np.isfinite(second).all(axis=1) & np.isfinite(third).all(axis=1))
        second[flat], third[flat] = 0.0, 0.0
        # barycentric weights of the second and third corner as linear functions of the point
        self._slopes = np.stack([second, third])
        self._offsets = -np.einsum("kni,ni->kn", self._slopes, a)
        self._offsets[:, flat] = -np.inf

    def pick(self, point: np.ndarray) -> Pick:
        """Pick ``point``, shape (2,), in map coordinates."""
        point = np.asarray(point, float)
        nearest = int(((self._points - point) ** 2).sum(axis=1).argmin())
        triangles, frames = self._map.triangles, self._map.frames
        if len(triangles):
            second, third = self._slopes @ point + self._offsets
            lowest = np.minimum(np.minimum(second, third), 1.0 - second - third)
            best = int(lowest.argmax())
            if lowest[best] >= -1e-9:
                weights = np.array([1.0 - second[best] - third[best], second[best], third[best]]).clip(0.0)
                return Pick(frames[triangles[best]], weights / weights.sum(), True, nearest)
        return Pick(frames[[nearest]], np.ones(1), False, nearest)


def pick(phoneme_map: PhonemeMap, point: np.ndarray) -> Pick:
    """Pick one ``point``, shape (2,), in map coordinates."""
    return Picker(phoneme_map).pick(point)
