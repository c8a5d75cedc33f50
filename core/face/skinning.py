"""Markers move the face: weights by distance along the surface, one sparse product a frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, diags

from core.face.attachments import attach
from core.face.face import PARTS, Face
from core.face.jaw import JawHinge
from core.face.marker_weights import REACH, SIGMA, marker_weights
from core.motion.marker_set import MarkerSet

DAMPING = 0.001  # how much a marker's own vertex may lag so that vertices between markers do not overshoot


@dataclass(frozen=True)
class MarkerSkin:
    """How K markers move the V vertices of one face.

    weights : sparse float32, shape (V, K), equation 15 with a resting weight; lashes repeat the row of their root
    drive : float32, shape (K, K); turns marker motion into the motion that makes each marker's own vertex follow it
    scale : mm on the face for one mm of the actor
    jaw_markers : int, rows of the markers on the chin; none leaves the jaw still
    jaw_vertices, jaw_share : the vertices that take part in the jaw's motion, and how much of it
    jaw_points : float64, shape (n_jaw_vertices, 3), mm at rest
    hinge : where the jaw turns
    """

    weights: csr_matrix
    drive: np.ndarray
    scale: float
    jaw_markers: np.ndarray
    jaw_vertices: np.ndarray
    jaw_share: np.ndarray
    jaw_points: np.ndarray
    hinge: JawHinge

    @classmethod
    def fit(
        cls, face: Face, marker_vertices: np.ndarray, marker_set: MarkerSet, sigma: float = SIGMA, reach: float = REACH
    ) -> MarkerSkin:
        """Weigh every marker at every vertex (Deng and Neumann 2008, equations 14 and 15).

        marker_vertices : int, shape (K,), where the markers sit, in the order of ``marker_set``
        sigma, reach : see `marker_weights`

        Marker motion passes through `drive` before the weights: equation 15 gives every vertex the mean motion of its
        neighbourhood, at the markers too, and lips would never quite close. `drive` undoes that at the markers, up to
        a small damping.
        """
        marker_vertices = _on_skin(face, np.asarray(marker_vertices, int))
        attached = attach(face, marker_vertices)
        triangles = face.triangles[attached.on_surface[face.triangles].all(axis=1)]
        weights = marker_weights(face.positions, triangles, marker_vertices, sigma, reach)
        weights = csr_matrix(diags(attached.skin_share) @ weights)
        at_markers = weights[marker_vertices].toarray()
        drive = np.linalg.solve(at_markers.T @ at_markers + DAMPING * np.eye(len(at_markers)), at_markers.T)
        covered = np.asarray(weights.sum(axis=1)).ravel()
        rooted = attached.follows >= 0
        rows = np.where(rooted, attached.follows, np.arange(len(covered)))
        share = attached.jaw_share * (1.0 - np.where(attached.on_surface, covered, 0.0))
        jaw_markers = marker_set.group("jaw")
        if len(jaw_markers) == 0:
            jaw_markers = np.array([row for row in [marker_set.landmark("chin")] if row is not None], int)
        jaw_vertices = np.flatnonzero(share > 1e-3) if len(jaw_markers) else np.zeros(0, int)
        chin = face.positions[marker_vertices[jaw_markers]].astype(float)
        return cls(
            weights=weights[rows].astype(np.float32),
            drive=drive.astype(np.float32),
            scale=scale_to(face, marker_vertices, marker_set),
            jaw_markers=jaw_markers,
            jaw_vertices=jaw_vertices,
            jaw_share=share[jaw_vertices],
            jaw_points=face.positions[jaw_vertices].astype(float),
            hinge=JawHinge.of(face, chin.mean(axis=0) if len(chin) else np.zeros(3)),
        )

    def deform(self, displacement: np.ndarray) -> np.ndarray:
        """Return how the vertices move for one frame of marker displacements (K, 3) in mm; float32, shape (V, 3)."""
        return self.deform_many(np.asarray(displacement)[None])[0]

    def deform_many(self, displacements: np.ndarray) -> np.ndarray:
        """Return vertex displacements for F frames: (F, K, 3) mm of the actor to (F, V, 3) mm on the face, float32."""
        displacements = np.asarray(displacements, np.float32) * np.float32(self.scale)
        frames, count = displacements.shape[:2]
        driven = self.drive @ displacements.transpose(1, 0, 2).reshape(count, frames * 3)
        moved = (self.weights @ driven).reshape(-1, frames, 3).transpose(1, 0, 2)
        if len(self.jaw_vertices):
            chin = displacements[:, self.jaw_markers].mean(axis=1, dtype=float)
            jaw = self.hinge.displacements(self.jaw_points, chin) * self.jaw_share[:, None]
            moved[:, self.jaw_vertices] += jaw.astype(np.float32)
        return moved


def scale_to(face: Face, marker_vertices: np.ndarray, marker_set: MarkerSet) -> float:
    """Return mm on the face for one mm of the actor: the ratio of outer eye distances, else of the markers' spread."""
    eyes = [marker_set.landmark(name) for name in ("outer_eye_left", "outer_eye_right")]
    if None not in eyes and {"outer_eye_left", "outer_eye_right"} <= set(face.landmarks):
        actor = float(np.linalg.norm(marker_set.rest[eyes[0]] - marker_set.rest[eyes[1]]))
        if actor > 0:
            return face.outer_eye_distance / actor
    spread = [np.linalg.norm(p - p.mean(axis=0)) for p in (marker_set.rest, face.positions[marker_vertices])]
    return float(spread[1] / spread[0]) if min(spread) > 0 else 1.0


def _on_skin(face: Face, marker_vertices: np.ndarray) -> np.ndarray:
    # a marker put on a lash or an eyeball by mistake moves the skin beside it
    skin = face.vertices_of("skin")
    if len(skin) == 0 or (face.part[marker_vertices] == PARTS.index("skin")).all():
        return marker_vertices
    gaps = np.linalg.norm(face.positions[marker_vertices][:, None] - face.positions[skin][None], axis=2)
    return np.where(face.part[marker_vertices] == PARTS.index("skin"), marker_vertices, skin[gaps.argmin(axis=1)])
