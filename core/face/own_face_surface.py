"""The nearest place on a triangle surface, with what a fit must know of it: its normal, and whether it is a rim."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

MOST_SAMPLES = 600_000
CANDIDATES = 4
_BLOCK = 65_536


@dataclass(frozen=True)
class Nearest:
    """One entry for each point that was asked about.

    distance : float64, shape (n,); triangle : int, shape (n,); bary : float64, shape (n, 3), where on it
    place, normal : float64, shape (n, 3); at_rim : bool, shape (n,), whether the place is where the surface ends
    """

    distance: np.ndarray
    triangle: np.ndarray
    bary: np.ndarray
    place: np.ndarray
    normal: np.ndarray
    at_rim: np.ndarray


class Surface:
    """A triangle surface that answers what of it is nearest.

    Places are found among samples a ``spacing_mm`` apart, then exactly on the triangles of the nearest four. On
    triangles far larger than the spacing that is exact but for ties; tests compare it with all triangles.
    """

    def __init__(self, positions: np.ndarray, triangles: np.ndarray, spacing_mm: float = 1.5) -> None:
        self.positions = np.asarray(positions, float)
        self.triangles = np.asarray(triangles, int)
        a, b, c = self.positions[self.triangles].transpose(1, 0, 2)
        cross = np.cross(b - a, c - a)
        self.areas = np.linalg.norm(cross, axis=1) / 2
        self.normals = cross / np.maximum(2 * self.areas, 1e-12)[:, None]
        self._rim_edges = self._open_edges()
        self.vertex_normals = vertex_normals(self.positions, self.triangles)
        self.samples, self.sample_triangle = self._sampled(spacing_mm)
        self._tree = cKDTree(self.samples)

    def flipped(self) -> Surface:
        """Return the same surface with its inside out."""
        made = object.__new__(Surface)
        made.__dict__ |= self.__dict__
        made.normals, made.vertex_normals = -self.normals, -self.vertex_normals
        return made

    def nearest(self, points: np.ndarray) -> Nearest:
        """Return what is nearest to each of ``points``, shape (n, 3)."""
        points = np.asarray(points, float)
        blocks = [self._nearest(points[first : first + _BLOCK]) for first in range(0, len(points), _BLOCK)]
        if not blocks:
            blocks = [self._nearest(np.zeros((0, 3)))]
        return Nearest(
            *(np.concatenate([getattr(block, name) for block in blocks]) for name in Nearest.__annotations__)
        )

    def _nearest(self, points: np.ndarray) -> Nearest:
        k = min(CANDIDATES, len(self.samples))
        rows = self._tree.query(points, k=[*range(1, k + 1)])[1].reshape(len(points), k)
        candidates = self.sample_triangle[rows]
        best = np.full(len(points), np.inf)
        triangle, bary = np.zeros(len(points), int), np.zeros((len(points), 3))
        place = np.zeros((len(points), 3))
        for column in candidates.T:
            corners = self.positions[self.triangles[column]]
            there = closest_bary(points, corners)
            at = np.einsum("nk,nkx->nx", there, corners)
            away = np.linalg.norm(points - at, axis=1)
            nearer = away < best
            best[nearer], triangle[nearer], bary[nearer], place[nearer] = (
                away[nearer], column[nearer], there[nearer], at[nearer],
            )  # fmt: skip
        on_edge = bary < 1e-6
        at_rim = (on_edge & self._rim_edges[triangle]).any(axis=1)
        normal = np.einsum("nk,nkx->nx", bary, self.vertex_normals[self.triangles[triangle]])
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        return Nearest(best, triangle, bary, place, normal, at_rim)

    def _open_edges(self) -> np.ndarray:
        """Tell for each triangle whether the edge opposite to each corner belongs to no other; bool, (T, 3)."""
        from core.face.geodesic import seam_partners

        welded = seam_partners(self.positions, self.triangles)[self.triangles]
        edges = np.sort(np.stack([welded[:, [1, 2]], welded[:, [2, 0]], welded[:, [0, 1]]], axis=1), axis=2)
        key = edges[..., 0] * np.int64(len(self.positions)) + edges[..., 1]
        _, inverse, uses = np.unique(key, return_inverse=True, return_counts=True)
        return (uses == 1)[inverse].reshape(key.shape)

    def _sampled(self, spacing: float) -> tuple[np.ndarray, np.ndarray]:
        """Lay samples over each triangle on a grid as fine as asked, coarser where that were too many."""
        spacing = max(spacing, float(np.sqrt(self.areas.sum() / MOST_SAMPLES)))
        a, b, c = self.positions[self.triangles].transpose(1, 0, 2)
        longest = np.max([np.linalg.norm(x - y, axis=1) for x, y in ((a, b), (b, c), (c, a))], axis=0)
        n_steps = np.clip(np.ceil(longest / spacing).astype(int), 1, 64)
        places, rows = [], []
        for n in np.unique(n_steps):
            chosen = np.flatnonzero(n_steps == n)
            i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
            inside = i + j < n
            u, v = (i[inside] + 1 / 3) / n, (j[inside] + 1 / 3) / n
            bary = np.stack([1 - u - v, u, v], axis=1)
            places.append(np.einsum("mk,nkx->nmx", bary, self.positions[self.triangles[chosen]]).reshape(-1, 3))
            rows.append(np.repeat(chosen, len(bary)))
        return np.concatenate(places), np.concatenate(rows)


def closest_bary(points: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return the barycentric coordinates, shape (n, 3), of the nearest place of each triangle (n, 3, 3) to each point.

    The regions of Ericson, "Real-Time Collision Detection" (2005), section 5.1.5, all at once.
    """
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    ab, ac, ap = b - a, c - a, points - a
    d1, d2 = _dot(ab, ap), _dot(ac, ap)
    bp, cp = points - b, points - c
    d3, d4, d5, d6 = _dot(ab, bp), _dot(ac, bp), _dot(ab, cp), _dot(ac, cp)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    total = np.where(np.abs(va + vb + vc) > 0, va + vb + vc, 1.0)
    v, w = vb / total, vc / total
    bary = np.stack([1 - v - w, v, w], axis=1)
    zero, one = np.zeros(len(points)), np.ones(len(points))
    t = _ratio(d4 - d3, (d4 - d3) + (d5 - d6))
    _put(bary, (va <= 0) & (d4 >= d3) & (d5 >= d6), zero, 1 - t, t)
    t = _ratio(d2, d2 - d6)
    _put(bary, (vb <= 0) & (d2 >= 0) & (d6 <= 0), 1 - t, zero, t)
    t = _ratio(d1, d1 - d3)
    _put(bary, (vc <= 0) & (d1 >= 0) & (d3 <= 0), 1 - t, t, zero)
    _put(bary, (d6 >= 0) & (d5 <= d6), zero, zero, one)
    _put(bary, (d3 >= 0) & (d4 <= d3), zero, one, zero)
    _put(bary, (d1 <= 0) & (d2 <= 0), one, zero, zero)
    return bary


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def _ratio(part: np.ndarray, whole: np.ndarray) -> np.ndarray:
    return part / np.where(np.abs(whole) > 0, whole, 1.0)


def _put(bary: np.ndarray, where: np.ndarray, a: np.ndarray, b: np.ndarray, c: np.ndarray) -> None:
    bary[where] = np.stack([a, b, c], axis=1)[where]


def vertex_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return unit normals, float64, shape (V, 3), of triangles counted round as seen from outside."""
    a, b, c = positions[triangles].transpose(1, 0, 2)
    cross = np.cross(b - a, c - a)
    normals = np.zeros((len(positions), 3))
    for corner in range(3):
        for axis in range(3):
            normals[:, axis] += np.bincount(triangles[:, corner], cross[:, axis], len(positions))
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
