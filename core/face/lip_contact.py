"""Lips that touch: where the two lips meet at rest they may part, but neither pass through each other nor miss a seal.

Markers sit outside the lips. What they leave inside them, a slit of half a millimetre or as much overlap, shows as a
dark line in p, b and m.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree

from core.face.face import PARTS, Face
from core.face.geodesic import surface_distances

# Sizes as fractions of the outer eye distance.
TOUCH = 0.022  # lips at rest are nowhere further apart where they meet
SEAL = 0.010  # a smaller gap is closed
OPEN = 0.034  # a larger one is left as it is
SPREAD = 0.040  # how far along a lip a correction reaches


@dataclass(frozen=True)
class LipContact:
    """Pairs of places on the two lips that meet at rest.

    upper, lower : int, shape (n_pairs,), vertices
    spread : sparse float32, shape (n_lip_vertices, 2 n_pairs), lays corrections at the pairs over the lips around
    vertices : int, shape (n_lip_vertices,)
    rest_gap : float32, shape (n_pairs,), mm, height of the upper over the lower
    seal_mm, open_mm : gaps that are closed, and left alone
    """

    upper: np.ndarray
    lower: np.ndarray
    spread: csr_matrix
    vertices: np.ndarray
    rest_gap: np.ndarray
    seal_mm: float
    open_mm: float

    @classmethod
    def of(cls, face: Face) -> LipContact | None:
        """Find the pairs; None for a face whose lips are unknown or do not meet at rest."""
        names = (
            "upper_lip",
            "lower_lip",
            "mouth_corner_left",
            "mouth_corner_right",
            "outer_eye_left",
            "outer_eye_right",
        )
        if any(name not in face.landmarks for name in names):
            return None
        scale = face.outer_eye_distance
        upper_lip, lower_lip, left, right = (face.landmarks[name] for name in names[:4])
        skin = np.isin(face.part, [PARTS.index("skin"), PARTS.index("mouth_socket")])
        triangles = face.triangles[skin[face.triangles].all(axis=1)]
        to_upper, to_lower = surface_distances(face.positions, triangles, np.array([upper_lip, lower_lip]))
        middle = (face.positions[left] + face.positions[right]) / 2
        near = np.abs(face.positions - middle)
        half = float(np.linalg.norm(face.positions[left] - face.positions[right])) / 2
        ahead = face.positions[:, 2] - middle[2]
        mouth = skin & (near[:, 0] < 0.97 * half) & (near[:, 1] < 0.25 * scale) & (ahead > -0.06 * scale)
        above = np.flatnonzero(mouth & (to_upper < to_lower))
        below = np.flatnonzero(mouth & (to_lower < to_upper))
        if len(above) == 0 or len(below) == 0:
            return None
        gap, nearest = cKDTree(face.positions[below]).query(face.positions[above])
        meets = gap < TOUCH * scale
        if meets.sum() < 4:
            return None
        upper, lower = above[meets], below[nearest[meets]]
        vertices, spread = _spread(face.positions, [(above, upper), (below, lower)], SPREAD * scale)
        rest_gap = (face.positions[upper] - face.positions[lower])[:, 1]
        return cls(upper, lower, spread, vertices, rest_gap, SEAL * scale, OPEN * scale)

    def gaps(self, moved: np.ndarray) -> np.ndarray:
        """Return how much further apart each pair is than at rest, mm; negative: they overlap."""
        return moved[self.upper, 1] - moved[self.lower, 1]

    def apply(self, moved: np.ndarray) -> None:
        """Close small gaps and undo overlaps in vertex displacements (V, 3), mm, in place."""
        gap = self.gaps(moved)
        if not (gap < self.open_mm).any():
            return
        # 0 up to the seal, then smoothly back to the gap as it is
        t = np.clip((gap - self.seal_mm) / (self.open_mm - self.seal_mm), 0.0, 1.0)
        change = (gap * (t * t * (3.0 - 2.0 * t)) - gap) / 2.0
        moved[self.vertices, 1] += self.spread @ np.concatenate([change, -change]).astype(np.float32)


def _spread(
    positions: np.ndarray, lips: list[tuple[np.ndarray, np.ndarray]], reach: float
) -> tuple[np.ndarray, csr_matrix]:
    """Return the vertices near the pairs and the weights that carry each pair's correction to them."""
    rows, blocks, first = [], [], 0
    total = sum(len(at) for _, at in lips)
    for lip, at in lips:
        away = np.linalg.norm(positions[lip][:, None] - positions[at][None], axis=2) / reach
        pull = np.exp(-4.0 * away**2)
        nearest = away.min(axis=1)
        fade = np.clip(1.5 - nearest, 0.0, 1.0)
        weights = np.zeros((len(lip), total), np.float32)
        own = pull / np.maximum(pull.sum(axis=1, keepdims=True), 1e-9) * fade[:, None]
        # a place of a pair takes its own correction whole
        for k, vertex in enumerate(at.tolist()):
            row = int(np.searchsorted(lip, vertex))
            own[row] = 0.0
            own[row, k] = 1.0
        weights[:, first : first + len(at)] = own
        weights[weights < 1e-3] = 0.0
        kept = weights.any(axis=1)
        rows.append(lip[kept])
        blocks.append(weights[kept])
        first += len(at)
    return np.concatenate(rows), csr_matrix(np.concatenate(blocks))
