"""Which of a generic face a scan may pull: skin that a scanner sees, less of it where a scan is not to be trusted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from core.face.face import PARTS, Face
from core.face.lip_contact import LipContact
from core.face.own_face_surface import Surface

# Fractions of the outer eye distance: within the first no pull, from the second on the whole.
LIPS_FADE = (0.012, 0.045)
LIDS_FADE = (0.035, 0.085)
RIM_FADE = (0.02, 0.10)
HAIR_FADE_MM = (-4.0, 6.0)
HAIR_SHARE = 0.15
EAR_SHARE = 0.35
WALL, WALL_FACES = (0.02, 0.04, 0.07), -0.35
EAR_AT = 0.80


@dataclass(frozen=True)
class Protected:
    """What the closing must know of a generic face; n surface vertices.

    surface : int, shape (n,), vertices of skin and mouth socket; triangles : int, shape (T, 3), into ``surface``
    share : float64, shape (n,), 0..1, how much a scan may pull each; 0 in the mouth and at the rims of the lids
    pairs : int, shape (n_pairs, 2), into ``surface``, upper and lower lip where they meet at rest
    """

    surface: np.ndarray
    triangles: np.ndarray
    share: np.ndarray
    pairs: np.ndarray

    @classmethod
    def of(cls, face: Face) -> Protected:
        """Work it out; places that a face does not name (eyes, mouth, hair) are not protected."""
        skin, socket = PARTS.index("skin"), PARTS.index("mouth_socket")
        on_surface = np.isin(face.part, (skin, socket))
        chosen = face.triangles[on_surface[face.triangles].all(axis=1)]
        surface, local = np.unique(chosen, return_inverse=True)
        triangles = local.reshape(-1, 3)
        at = face.positions[surface].astype(float)
        scale = face.outer_eye_distance
        share = (face.part[surface] == skin).astype(float)
        contact = LipContact.of(face)
        pairs = np.zeros((0, 2), int)
        seams = [at[_border(triangles, face.part[surface] == socket)]]
        if contact is not None:
            place = np.full(len(face.positions), -1)
            place[surface] = np.arange(len(surface))
            pairs = np.column_stack([place[contact.upper], place[contact.lower]])
            pairs = pairs[(pairs >= 0).all(axis=1)]
            seams.append(at[pairs.ravel()])
        share *= _fade(at, np.concatenate(seams), LIPS_FADE, scale)
        rim = at[open_rim(triangles)]
        balls = [face.positions[face.vertices_of(f"eye_{side}")] for side in ("left", "right")]
        around = np.zeros(len(rim), bool)
        for ball in balls:
            if len(ball):
                margin = 0.1 * scale
                around |= ((rim > ball.min(axis=0) - margin) & (rim < ball.max(axis=0) + margin)).all(axis=1)
        share *= _fade(at, rim[around], LIDS_FADE, scale) * _fade(at, rim[~around], RIM_FADE, scale)
        share *= ~_enclosed(at, triangles, scale)
        if "hair" in face.masks:
            low, high = HAIR_FADE_MM
            t = np.clip((face.masks["hair"][surface] - low) / (high - low), 0.0, 1.0)
            share *= 1.0 - (1.0 - HAIR_SHARE) * t
        eyes = face.positions[[face.landmarks["outer_eye_left"], face.landmarks["outer_eye_right"]]].mean(axis=0)
        away = at - eyes
        ear = (np.abs(away[:, 0]) > EAR_AT * scale) & (np.abs(away[:, 1] + 0.25 * scale) < 0.5 * scale)
        share[ear & (away[:, 2] < -0.5 * scale)] *= EAR_SHARE
        return cls(surface, triangles, share, pairs)


def _enclosed(at: np.ndarray, triangles: np.ndarray, scale: float) -> np.ndarray:
    """Tell which vertices look at a wall close before them, as within nostrils: no scan shows these; bool, (n,)."""
    surface = Surface(at, triangles, spacing_mm=0.02 * scale)
    inside = np.zeros(len(at), bool)
    for away in WALL:
        near = surface.nearest(at + away * scale * surface.vertex_normals)
        opposite = np.einsum("ij,ij->i", near.normal, surface.vertex_normals) < WALL_FACES
        inside |= opposite & (near.distance < 0.9 * away * scale)
    # a ring more, so that no rim of a nostril is pulled into it
    edge = inside[triangles].any(axis=1)
    inside[triangles[edge]] = True
    return inside


def _fade(at: np.ndarray, seam: np.ndarray, reach: tuple[float, float], scale: float) -> np.ndarray:
    if len(seam) == 0:
        return np.ones(len(at))
    gap = cKDTree(seam).query(at)[0] / scale
    t = np.clip((gap - reach[0]) / (reach[1] - reach[0]), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def _border(triangles: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Return the vertices not inside of triangles that are partly inside."""
    partly = inside[triangles].any(axis=1) & ~inside[triangles].all(axis=1)
    corners = np.unique(triangles[partly])
    return corners[~inside[corners]]


def open_rim(triangles: np.ndarray) -> np.ndarray:
    """Return the vertices at edges that belong to one triangle only, int, ascending."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[uses == 1])
