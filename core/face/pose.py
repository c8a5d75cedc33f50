"""Head, eyes and tongue: what moves besides the skin, each by its own track."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from core.face.face import PARTS, Face

# The head turns about the top of the spine; the neck gives way between these heights. Fractions of the outer eye
# distance from the middle between the eyes; depth counts half, because a neck slants.
PIVOT = (0.0, -0.75, -0.85)
NECK_TOP, NECK_BASE = -1.20, -2.05
LEAN = 0.5


@dataclass(frozen=True)
class Head:
    """How much each vertex takes part in the head's motion: 1 on the head, 0 at the base of the neck.

    share : float32, shape (V,); pivot : float64, shape (3,), mm
    """

    share: np.ndarray
    pivot: np.ndarray

    @classmethod
    def of(cls, face: Face) -> Head:
        """Find the neck below the eyes; where these are unknown all is head, and turns about its middle."""
        share = np.ones(len(face.positions), np.float32)
        if not {"outer_eye_left", "outer_eye_right"} <= set(face.landmarks):
            return cls(share, face.positions.mean(axis=0).astype(float))
        scale = face.outer_eye_distance
        corners = [face.landmarks["outer_eye_left"], face.landmarks["outer_eye_right"]]
        eyes = face.positions[corners].mean(axis=0).astype(float)
        at = (face.positions - eyes) / scale
        t = np.clip((at[:, 1] + LEAN * at[:, 2] - NECK_BASE) / (NECK_TOP - NECK_BASE), 0.0, 1.0)
        skin = face.part == PARTS.index("skin")
        share[skin] = (t * t * (3.0 - 2.0 * t))[skin]
        return cls(share, eyes + scale * np.array(PIVOT))

    def move(self, positions: np.ndarray, rotation: np.ndarray, translation: np.ndarray) -> np.ndarray:
        """Turn by a rotation vector (radians) about the pivot, then shift (mm); positions (V, 3) to float32 (V, 3)."""
        turn = Rotation.from_rotvec(np.asarray(rotation, float)).as_matrix()
        moved = (positions - self.pivot) @ turn.T + self.pivot + translation
        return (positions + self.share[:, None] * (moved - positions)).astype(np.float32)


@dataclass(frozen=True)
class Eyeballs:
    """The vertices of each eyeball and its centre, mm."""

    balls: tuple[tuple[np.ndarray, np.ndarray], ...]

    @classmethod
    def of(cls, face: Face) -> Eyeballs:
        """Find the eyeballs of a face; none where their part is unknown."""
        balls = []
        for side in ("left", "right"):
            vertices = face.vertices_of(f"eye_{side}")
            if len(vertices):
                low, high = face.positions[vertices].min(axis=0), face.positions[vertices].max(axis=0)
                centre = ((low + high) / 2).astype(float)
                # the back of a cut eyeball is missing: its true centre lies a radius behind the front
                centre[2] = high[2] - float((high - low)[:2].max()) / 2
                balls.append((vertices, centre))
        return cls(tuple(balls))

    def turn(self, positions: np.ndarray, yaw_deg: float, pitch_deg: float) -> None:
        """Turn all eyeballs in ``positions`` (V, 3), in place; yaw > 0 to the character's left, pitch > 0 up."""
        turn = Rotation.from_euler("YX", [yaw_deg, -pitch_deg], degrees=True).as_matrix()
        for vertices, centre in self.balls:
            positions[vertices] = (positions[vertices] - centre) @ turn.T + centre


@dataclass(frozen=True)
class TongueShape:
    """How tip, back and length of the tongue move its vertices.

    vertices : int; tip, back : float32, shape (n,), 0..1, how much each takes part in the rise of the tip and the back
    ridge_mm : float64, shape (3,), behind the upper incisors, where /t/, /n/ and /l/ touch
    tip_vertex : the foremost vertex; out_mm : how far from the ridge's depth the tip comes out between the teeth
    back_mm : how far the back rises to the palate
    """

    vertices: np.ndarray
    tip: np.ndarray
    back: np.ndarray
    ridge_mm: np.ndarray
    tip_vertex: int
    out_mm: float
    back_mm: float

    @classmethod
    def of(cls, face: Face) -> TongueShape | None:
        """Measure tongue and upper teeth; None for a face that lacks one of them."""
        vertices, teeth = face.vertices_of("tongue"), face.vertices_of("upper_teeth")
        if len(vertices) == 0 or len(teeth) == 0:
            return None
        at = face.positions[vertices].astype(float)
        u = (at[:, 2] - at[:, 2].min()) / max(float(np.ptp(at[:, 2])), 1e-6)
        tip = np.clip((u - 0.25) / 0.75, 0.0, 1.0)
        incisors = face.positions[teeth].astype(float)
        front = incisors[incisors[:, 2] > incisors[:, 2].max() - 0.2 * np.ptp(incisors[:, 2])]
        size = float(np.ptp(incisors[:, 0])) / 60.0
        ridge = np.array([0.0, front[:, 1].min() + 0.8 * size, front[:, 2].max() - 3.6 * size])
        return cls(
            vertices,
            (tip * tip).astype(np.float32),
            (np.exp(-(((u - 0.45) / 0.25) ** 2))).astype(np.float32),
            ridge,
            int(vertices[at[:, 2].argmax()]),
            7.5 * size,
            9.0 * size,
        )

    def bend(self, moved: np.ndarray, rest: np.ndarray, tip: float, back: float, advance: float) -> None:
        """Add the tongue's own motion to vertex displacements (V, 3), mm, in place, on top of the jaw's.

        tip, back : 0 as the jaw carries them, 1 at the ridge behind the upper teeth, and at the palate
        advance : -1 drawn back by half a centimetre, 0 as the jaw carries it (with the tip raised: behind the teeth),
            1 out between the teeth
        """
        now = rest[self.tip_vertex] + moved[self.tip_vertex]
        raised = float(np.clip(tip, 0.0, 1.0))
        goal = self.ridge_mm.copy()
        out = float(np.clip(advance, 0.0, 1.0))
        # between the teeth the tip passes under the edge of the upper ones
        goal[1] -= 2.4 / 7.5 * self.out_mm * out
        up = (goal[1] - now[1]) * raised
        ahead = (goal[2] - now[2]) * raised + self.out_mm * out + 5.0 / 7.5 * self.out_mm * min(advance, 0.0)
        moved[self.vertices, 1] += self.tip * np.float32(up) + self.back * np.float32(self.back_mm * back)
        moved[self.vertices, 2] += np.sqrt(self.tip) * np.float32(ahead)
