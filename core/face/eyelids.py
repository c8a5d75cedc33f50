"""Lids that close: how far a blink has come is read off the markers, and the face's own blink does the rest.

Skin moved by one marker a lid slides through the eyeball and leaves slits; a sculpted blink slides over it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.face.attachments import attach
from core.face.blink_fitting import fitted_blink
from core.face.face import PARTS, Face
from core.motion.marker_set import MarkerSet

# A lid that came this far counts as shut: PCA and the mean over a neighbourhood keep the last tenth back.
SHUT_AT = 0.88
WIDEST = -0.35
CLEARANCE_MM = 1.0
GAZE_SHARE = 0.011  # how much of a blink one degree of looking down takes


@dataclass(frozen=True)
class Lid:
    """One upper lid.

    vertices : int; of the skin, lashes after them; blink : float32, shape (n, 3), mm, the face's
        blink there, fitted to this face
    share : float32, 0..1; 1 on the lid, falling to 0 where the markers rule alone
    marker : the vertex under the lid's marker, and blink_there how the face's unit moves it
    under : int; vertices of the lower lid's rim; lower : int; of the lower lid
    lashes, roots : int, same shape; lash vertices and the skin they are rooted at
    centre, radius : of the eyeball, mm
    rise : how far the blink lifts the lower lid's rim, mm
    """

    vertices: np.ndarray
    blink: np.ndarray
    share: np.ndarray
    marker: int
    blink_there: np.ndarray
    under: np.ndarray
    lower: np.ndarray
    lashes: np.ndarray
    roots: np.ndarray
    centre: np.ndarray
    radius: float
    rise: float


@dataclass(frozen=True)
class Eyelids:
    """Both upper lids of a face, or as many as are known."""

    rest: np.ndarray
    lids: tuple[Lid, ...]

    @classmethod
    def of(cls, face: Face, marker_vertices: np.ndarray, marker_set: MarkerSet) -> Eyelids:
        """Find the lids of a face with blink units, followed by markers on its upper lids; none otherwise."""
        lids = []
        follows = None
        for side in ("left", "right"):
            blink = face.units.get(f"eyeBlink{side.capitalize()}")
            row = marker_set.landmark(f"upper_lid_{side}")
            ball = face.positions[face.vertices_of(f"eye_{side}")]
            if blink is None or row is None or len(ball) == 0:
                continue
            if follows is None:
                follows = attach(face, marker_vertices).follows
            lids.append(_lid(face, side, np.asarray(blink, np.float32), int(marker_vertices[row]), ball, follows))
        return cls(face.positions, tuple(lids))

    def closures(self, moved: np.ndarray) -> list[float]:
        """Return how far each lid is shut by the markers: 0 as at rest, 1 shut, negative wider."""
        return [
            float(
                np.clip(moved[lid.marker] @ lid.blink_there / (lid.blink_there @ lid.blink_there) / SHUT_AT, WIDEST, 1)
            )
            for lid in self.lids
        ]

    def apply(self, moved: np.ndarray, pitch_deg: float = 0.0) -> None:
        """Correct vertex displacements (V, 3), mm, in place; ``pitch_deg`` > 0 looks up and takes the lids along."""
        for lid, closure in zip(self.lids, self.closures(moved)):
            if pitch_deg:
                closure += (1.0 - max(closure, 0.0)) * np.clip(-GAZE_SHARE * pitch_deg, -0.25, 0.35)
            shut = max(closure, 0.0)
            # the upper lid's marker must not drag the lower lid down
            moved[lid.lower, 1] -= shut * np.minimum(moved[lid.lower, 1], 0.0)
            rise = moved[lid.under, 1].mean() if len(lid.under) else 0.0
            wanted = closure * lid.blink
            wanted[:, 1] += shut * shut * (rise - lid.rise)
            moved[lid.vertices] += lid.share[:, None] * (wanted.astype(np.float32) - moved[lid.vertices])
            for vertices in (lid.vertices, lid.lower):
                moved[vertices] += self._off_ball(lid, vertices, moved[vertices])
            if len(lid.lashes):
                moved[lid.lashes] = self._lashes(lid, moved)

    def _off_ball(self, lid: Lid, vertices: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Return the way out for lid skin that would sink into the eyeball more than at rest."""
        rest = self.rest[vertices] - lid.centre
        offset = rest + moved
        reach = np.maximum(np.sqrt(np.einsum("ij,ij->i", offset, offset)), 1e-6)
        wanted = np.minimum(np.sqrt(np.einsum("ij,ij->i", rest, rest)), lid.radius + CLEARANCE_MM)
        return (offset * np.maximum(wanted / reach - 1.0, 0.0)[:, None]).astype(np.float32)

    def _lashes(self, lid: Lid, moved: np.ndarray) -> np.ndarray:
        """Let lashes turn about the eyeball with the skin at their roots, as lids do."""
        root = self.rest[lid.roots] - lid.centre
        now = root + moved[lid.roots]
        angle = np.arctan2(now[:, 1], now[:, 2]) - np.arctan2(root[:, 1], root[:, 2])
        hair = self.rest[lid.lashes] - self.rest[lid.roots]
        cos, sin = np.cos(angle), np.sin(angle)
        turned = hair.copy()
        turned[:, 1] = cos * hair[:, 1] + sin * hair[:, 2]
        turned[:, 2] = cos * hair[:, 2] - sin * hair[:, 1]
        return moved[lid.roots] + turned - hair


def _lid(face: Face, side: str, unit: np.ndarray, marker: int, ball: np.ndarray, follows: np.ndarray) -> Lid:
    blink = fitted_blink(face.positions, unit, eye_opening(face, ball), ball).astype(np.float32)
    skin = face.vertices_of("skin")
    falls = -blink[skin, 1]
    most = max(float(falls.max()), 1e-6)
    # the lid proper moves by a quarter of the most or more; above it the fold fades out
    t = np.clip((falls / most - 0.04) / 0.16, 0.0, 1.0)
    share = t * t * (3.0 - 2.0 * t)
    low, high = ball.min(axis=0), ball.max(axis=0)
    centre, radius = (low + high) / 2, float(high[0] - low[0]) / 2
    centre[2] = high[2] - radius
    at = face.positions[skin]
    reach = np.linalg.norm(at - centre, axis=1)
    # the corners of the eye hardly move in a blink, and must not be dragged along by the lid's marker
    around = np.clip((radius + 11.0 - reach) / 5.0, 0.0, 1.0) * np.clip((at[:, 1] - centre[1]) / 4.0 + 1.75, 0.0, 1.0)
    share = np.maximum(share, around * (at[:, 2] > centre[2]))
    chosen = share > 0
    low_lid = (
        (reach < radius + 5.0) & (at[:, 1] < centre[1] + 0.1 * radius) & (at[:, 2] > centre[2]) & ~(falls > 0.1 * most)
    )
    middle = np.abs(at[:, 0] - face.positions[marker, 0]) < 0.35 * radius
    under = skin[low_lid & middle]
    under = under[np.argsort(-face.positions[under, 1])[:4]]
    lashes = face.vertices_of(f"lashes_upper_{side}")
    lashes = lashes[follows[lashes] >= 0]
    return Lid(
        vertices=skin[chosen],
        blink=blink[skin[chosen]],
        share=share[chosen].astype(np.float32),
        marker=marker,
        blink_there=unit[marker],
        under=under,
        lower=skin[low_lid],
        lashes=lashes,
        roots=follows[lashes],
        centre=centre.astype(np.float32),
        radius=radius,
        rise=float(blink[under, 1].mean()) if len(under) else 0.0,
    )


def eye_opening(face: Face, ball: np.ndarray) -> np.ndarray:
    """Return the vertices of the skin's edge around one eyeball, int."""
    edges = np.sort(
        np.concatenate([face.triangles[:, [0, 1]], face.triangles[:, [1, 2]], face.triangles[:, [2, 0]]]), 1
    )
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    edge = np.unique(unique[uses == 1])
    low, high = ball.min(axis=0) - 3.0, ball.max(axis=0) + 3.0
    at = face.positions[edge]
    return edge[(face.part[edge] == PARTS.index("skin")) & (at > low).all(axis=1) & (at < high).all(axis=1)]
