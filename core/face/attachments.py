"""What moves the pieces of a face that no way along the skin leads to: teeth, tongue, eyeballs, lashes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from core.face.face import PARTS, Face
from core.face.geodesic import components, seam_partners

SKIN_PARTS = ("skin", "mouth_socket")
JAW_PARTS = ("lower_teeth", "tongue")

# Sizes of the rules for pieces without a part, as fractions of the face's scale (its outer eye distance).
MOUTH_DEPTH = 0.9
ROOT_GAP = 0.03
LASH_LENGTH = 0.2
BALL_ROUNDNESS = 0.45
TALL = 0.4
LIP_PULL = 0.12


@dataclass(frozen=True)
class Attachments:
    """One entry a vertex.

    on_surface : bool; skin and mouth socket, moved by the markers along the surface
    jaw_share : float64, 0..1; how much of the jaw's motion a vertex takes (of what the skin leaves over)
    skin_share : float64, 0..1; 1 on the skin, falling to 0 where the mouth socket leaves the lips
    follows : int; the surface vertex that a lash or the like is rooted at, -1 for none
    """

    on_surface: np.ndarray
    skin_share: np.ndarray
    jaw_share: np.ndarray
    follows: np.ndarray


def attach(face: Face, marker_vertices: np.ndarray) -> Attachments:
    """Decide for every vertex of ``face`` what moves it.

    Lower teeth and tongue follow the jaw, upper teeth and eyeballs the head, lashes the skin at their roots. The mouth
    socket, or what of the skin lines the mouth, fades from the lips to the jaw below and the head above. Pieces of
    the part ``skin`` or ``other`` that carry no marker, as in a user's file without parts, go by their place: inside
    the mouth and below the mouth line to the jaw, above it to the head (gums and tongue in one piece bend between the
    two); elsewhere round ones (eyeballs) to the head; thin ones close to the skin (tear lines, lashes) with the skin;
    all else to the head.
    """
    surface = np.isin(face.part, [PARTS.index(part) for part in SKIN_PARTS])
    welded = seam_partners(face.positions, face.triangles)
    piece = components(len(face.positions), welded[face.triangles])[welded]
    with_marker = np.isin(piece, piece[marker_vertices])
    loose = (surface | (face.part == PARTS.index("other"))) & ~with_marker
    on_surface = surface & ~loose
    jaw_share = np.isin(face.part, [PARTS.index(part) for part in JAW_PARTS]).astype(float)
    follows = np.full(len(face.positions), -1)
    mouth = _Mouth.of(face)
    if mouth is not None:
        socket = (face.part == PARTS.index("mouth_socket")) | (on_surface & mouth.walls(face.positions))
        jaw_share[socket] = mouth.below(face.positions[socket])
    roots = cKDTree(face.positions[on_surface])
    surface_vertices = np.flatnonzero(on_surface)
    lashes = np.flatnonzero([PARTS[part].startswith("lashes") for part in face.part])
    strips = components(len(face.positions), face.triangles)
    for number in np.unique(strips[lashes]):
        strip = lashes[strips[lashes] == number]
        follows[strip] = surface_vertices[_root(face.positions[strip], roots)]
    for number in np.unique(piece[loose]):
        vertices = np.flatnonzero(loose & (piece == number))
        place = face.positions[vertices]
        if mouth is not None and mouth.holds(place.mean(axis=0)):
            below = mouth.below(place)
            tall = np.ptp(place[:, 1]) > TALL * mouth.scale
            jaw_share[vertices] = below if tall else float(below.mean() > 0.5)
        elif mouth is not None and _thin(place) and _rooted(roots.query(place)[0], mouth.scale):
            follows[vertices] = surface_vertices[_root(place, roots)]
    return Attachments(on_surface, _skin_share(face, on_surface, mouth), jaw_share, follows)


def _skin_share(face: Face, on_surface: np.ndarray, mouth: _Mouth | None) -> np.ndarray:
    # lips pull only the nearest of the socket along: all of it would come out through the cheeks
    share = np.ones(len(face.positions))
    socket = on_surface & (face.part == PARTS.index("mouth_socket"))
    at_rim = face.triangles[socket[face.triangles].any(axis=1) & ~socket[face.triangles].all(axis=1)]
    rim = np.setdiff1d(at_rim, np.flatnonzero(socket))
    if mouth is not None and len(rim):
        gap = cKDTree(face.positions[rim]).query(face.positions[socket])[0]
        t = np.clip(1.0 - gap / (LIP_PULL * mouth.scale), 0.0, 1.0)
        share[socket] = t * t * (3.0 - 2.0 * t)
    return share


def _rooted(gap: np.ndarray, scale: float) -> bool:
    return np.quantile(gap, 0.25) < ROOT_GAP * scale and gap.max() < LASH_LENGTH * scale


def _root(strip: np.ndarray, roots: cKDTree) -> np.ndarray:
    """Return for each vertex of a lash the skin at its root: the nearest skin of the strip's nearest rooted vertex."""
    gap, nearest = roots.query(strip)
    rooted = np.flatnonzero(gap <= np.quantile(gap, 0.4))
    return nearest[rooted[cKDTree(strip[rooted]).query(strip)[1]]]


def _thin(place: np.ndarray) -> bool:
    spread = np.linalg.svd(place - place.mean(axis=0), compute_uv=False)
    return len(spread) < 3 or spread[2] < BALL_ROUNDNESS * spread[0]


@dataclass(frozen=True)
class _Mouth:
    """The room behind the lips, found from the corners: as wide as they are apart, and a bit."""

    middle: np.ndarray
    half_width: float
    scale: float

    @classmethod
    def of(cls, face: Face) -> _Mouth | None:
        corners = [face.landmarks.get(name) for name in ("mouth_corner_left", "mouth_corner_right")]
        if None in corners:
            return None
        left, right = face.positions[corners].astype(float)
        known = {"outer_eye_left", "outer_eye_right"} <= set(face.landmarks)
        scale = face.outer_eye_distance if known else 1.7 * float(np.linalg.norm(left - right))
        return cls((left + right) / 2, float(np.linalg.norm(left - right)) / 2, scale)

    def holds(self, point: np.ndarray) -> bool:
        across, up, ahead = point - self.middle
        inside = abs(across) < 1.2 * self.half_width and abs(up) < 0.45 * self.scale
        return inside and -MOUTH_DEPTH * self.scale < ahead < 0.3 * self.scale

    def walls(self, points: np.ndarray) -> np.ndarray:
        """Tell which points of a skin lie so far behind the mouth corners that they must be the mouth's own lining."""
        across, up, ahead = (points - self.middle).T
        inside = (np.abs(across) < self.half_width) & (np.abs(up) < 0.3 * self.scale)
        return inside & (ahead < -0.1 * self.scale) & (ahead > -MOUTH_DEPTH * self.scale)

    def below(self, points: np.ndarray) -> np.ndarray:
        """Return 1 well below the line between the corners, 0 well above, smooth between."""
        t = np.clip(0.5 - (points[:, 1] - self.middle[1]) / (0.2 * self.scale), 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)
