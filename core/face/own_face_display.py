"""A scan as it is shown and clicked: of one size and posture whatever its file says, and not too fine to turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from core.face.face import PARTS, Face
from core.face.own_face_scan import Scan
from core.face.own_face_surface import vertex_normals

SHOWN_MM = 300.0
MOST_TRIANGLES = 100_000
_FINEST = 400


@dataclass(frozen=True)
class ShownScan:
    """A scan as a face without landmarks: shown place = ``scale`` · ``turn`` · (place - ``middle``).

    turn : shape (3, 3); middle : shape (3,), in the scan's unit
    """

    face: Face
    scale: float
    turn: np.ndarray
    middle: np.ndarray
    normals: np.ndarray
    tree: cKDTree

    @classmethod
    def of(cls, scan: Scan, turn: np.ndarray | None = None) -> ShownScan:
        """Make it; ``turn`` brings the head upright, its face to +z, where the file has it otherwise."""
        turn = np.eye(3) if turn is None else turn
        positions, triangles, uv = _split(scan)
        positions, triangles, uv = _coarser(positions, triangles, uv)
        low, high = positions.min(axis=0), positions.max(axis=0)
        middle, scale = (low + high) / 2, SHOWN_MM / max(float((high - low).max()), 1e-12)
        shown = (scale * (positions - middle) @ turn.T).astype(np.float32)
        part = np.full(len(shown), PARTS.index("skin"), np.uint8)
        picture = None if uv is None else scan.picture
        face = Face(scan.name, shown, triangles.astype(np.int32), part, uv, texture=picture)
        return cls(face, scale, turn, middle, vertex_normals(shown.astype(float), triangles), cKDTree(shown))

    def shown(self, places: np.ndarray) -> np.ndarray:
        """Return where places of the scan, shape (n, 3), are shown."""
        return self.scale * (np.asarray(places, float) - self.middle) @ self.turn.T

    def original(self, shown: np.ndarray) -> np.ndarray:
        """Undo `shown`."""
        return np.asarray(shown, float) @ self.turn / self.scale + self.middle

    def normals_at(self, shown: np.ndarray) -> np.ndarray:
        """Return the normals nearest to shown places (n, 3), unit, shape (n, 3)."""
        return self.normals[self.tree.query(shown)[1]]


class Clickable:
    """The triangles of a face, ready to be hit by rays."""

    def __init__(self, positions: np.ndarray, triangles: np.ndarray) -> None:
        corners = np.asarray(positions, np.float32)[triangles]
        self._a, self._ab, self._ac = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        self._middle = corners.mean(axis=1)
        self._radius = np.sqrt(np.square(corners - self._middle[:, None]).sum(axis=2).max(axis=1))

    def hit(self, origin: np.ndarray, directions: np.ndarray, slit_mm: float = np.inf) -> np.ndarray | None:
        """Return the place that the first of ``directions`` (n, 3), unit, meets, shape (3,), or None.

        slit_mm : where it meets nothing, or something that lies so much deeper than what one of the other rays meets,
            it went through a slit, as between lips or lids, and the nearest to it of the others decides
        """
        origin, rays = np.asarray(origin, np.float32), np.asarray(directions, np.float32)
        # most triangles are nowhere near; the others' rays part by the length of the way times their spread
        away = self._middle - origin
        along = away @ rays[0]
        spread = np.linalg.norm(rays - rays[0], axis=1).max()
        off = np.linalg.norm(away - along[:, None] * rays[0], axis=1)
        near = np.flatnonzero(off <= self._radius + spread * np.maximum(along, 0.0) + 1e-3)
        depths = np.array([self._depth(origin, ray, near) for ray in rays])
        front = depths.min()
        if not np.isfinite(front):
            return None
        best = int(np.argmax(depths <= front + slit_mm)) if np.isfinite(slit_mm) else 0
        if not np.isfinite(depths[best]):
            return None
        return (origin + rays[best] * np.float32(depths[best])).astype(float)

    def _depth(self, origin: np.ndarray, ray: np.ndarray, near: np.ndarray) -> float:
        """How far along a ray the first of some triangles is met; inf for none (Moeller and Trumbore 1997)."""
        ab, ac, t = self._ab[near], self._ac[near], origin - self._a[near]
        p = np.cross(ray, ac)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / np.einsum("ij,ij->i", ab, p)
            u = np.einsum("ij,ij->i", t, p) * inverse
            q = np.cross(t, ab)
            v = q @ ray * inverse
            depth = np.einsum("ij,ij->i", ac, q) * inverse
            met = (u >= -1e-5) & (v >= -1e-5) & (u + v <= 1 + 1e-5) & (depth > 0) & np.isfinite(depth)
        return float(depth[met].min()) if met.any() else np.inf


def _split(scan: Scan) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Return the mesh with a vertex for every texture coordinate, as drawing needs it."""
    if scan.picture is None or scan.corner_uv is None:
        used, local = np.unique(scan.triangles, return_inverse=True)
        return scan.positions[used], local.reshape(-1, 3), None
    flat = np.nan_to_num(scan.corner_uv.reshape(-1, 2)).astype(np.float32)
    key = np.column_stack([scan.triangles.ravel().astype(float), flat])
    unique, local = np.unique(key, axis=0, return_inverse=True)
    return scan.positions[unique[:, 0].astype(int)], local.reshape(-1, 3), unique[:, 1:].astype(np.float32)


def _coarser(
    positions: np.ndarray, triangles: np.ndarray, uv: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Join vertices in the cells of a grid until few enough triangles are left; the first of a cell stands for it."""
    n_cells = _FINEST
    kept = triangles
    while len(kept) > MOST_TRIANGLES and n_cells > 8:
        low, size = positions.min(axis=0), float(np.ptp(positions, axis=0).max())
        cell = np.minimum((positions - low) / max(size, 1e-12) * n_cells, n_cells - 1).astype(np.int64)
        _, first, same = np.unique(cell @ [n_cells * n_cells, n_cells, 1], return_index=True, return_inverse=True)
        joined = first[same][triangles]
        alive = (joined[:, 0] != joined[:, 1]) & (joined[:, 1] != joined[:, 2]) & (joined[:, 2] != joined[:, 0])
        kept = joined[alive]
        n_cells = int(n_cells * 0.8)
    used, local = np.unique(kept, return_inverse=True)
    return positions[used], local.reshape(-1, 3), None if uv is None else uv[used]
