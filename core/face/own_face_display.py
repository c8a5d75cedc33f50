"""A scan as it is shown and clicked: of one size and posture whatever its file says, and not too fine to turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from core.face.face import PARTS, Face
from core.face.own_face_closing import vertex_normals
from core.face.own_face_scan import Scan

SHOWN_MM = 300.0
MOST_TRIANGLES = 160_000
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
        a, b, c = np.asarray(positions, np.float32)[triangles].transpose(1, 0, 2)
        self._a, self._ab, self._ac = a, b - a, c - a

    def hit(self, origin: np.ndarray, direction: np.ndarray) -> np.ndarray | None:
        """Return the first place that a ray meets, shape (3,), or None (Möller and Trumbore 1997)."""
        origin, direction = np.asarray(origin, np.float32), np.asarray(direction, np.float32)
        p = np.cross(direction, self._ac)
        determinant = np.einsum("ij,ij->i", self._ab, p)
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = 1.0 / determinant
            t = origin - self._a
            u = np.einsum("ij,ij->i", t, p) * inverse
            q = np.cross(t, self._ab)
            v = q @ direction * inverse
            away = np.einsum("ij,ij->i", self._ac, q) * inverse
            met = (u >= -1e-6) & (v >= -1e-6) & (u + v <= 1 + 1e-6) & (away > 0) & np.isfinite(away)
        if not met.any():
            return None
        return (origin + direction * away[met].min()).astype(float)


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
