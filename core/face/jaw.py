"""A rigid jaw, fitted to what the chin markers do: it carries the lower teeth and the tongue."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.face.face import Face

# The jaw joint lies before the ear, below and behind the eyes; fractions of the outer eye distance
# (adult skulls: about 21 mm below and 63 mm behind the outer eye corners, which are 84 mm apart).
JOINT_BELOW_EYES = 0.25
JOINT_BEHIND_EYES = 0.75


@dataclass(frozen=True)
class JawHinge:
    """A jaw that turns about the axis through both joints and slides with what turning cannot explain.

    Skin over the chin is soft, so a free rigid fit to a few close markers wobbles; an anatomical hinge does not.

    hinge : float64, shape (3,), mm, the middle between the joints; the axis runs along x
    chin : float64, shape (3,), mm, the middle of the jaw markers at rest
    """

    hinge: np.ndarray
    chin: np.ndarray

    @classmethod
    def of(cls, face: Face, chin: np.ndarray) -> JawHinge:
        """Place the hinge in ``face``; ``chin`` is the middle of its jaw markers at rest, mm."""
        corners = [face.landmarks.get(name) for name in ("outer_eye_left", "outer_eye_right")]
        if None in corners:
            # with no eyes to go by, the joint is about as far above as behind the chin
            reach = 0.35 * float(np.ptp(face.positions[:, 1]))
            return cls(np.array([chin[0], chin[1] + reach, chin[2] - reach]), chin)
        eyes = face.positions[corners].mean(axis=0).astype(float)
        size = face.outer_eye_distance
        return cls(eyes - [0.0, JOINT_BELOW_EYES * size, JOINT_BEHIND_EYES * size], chin)

    def displacements(self, points: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Return how ``points`` (P, 3) on the jaw move in F frames; shape (F, P, 3), mm.

        moved : shape (F, 3), mean displacement of the jaw markers, mm
        """
        arm = (self.chin - self.hinge)[1:]
        reached = arm + moved[:, 1:]
        angle = np.arctan2(reached[:, 1], reached[:, 0]) - np.arctan2(arm[1], arm[0])
        cos, sin = np.cos(angle) - 1.0, np.sin(angle)
        turned_arm = np.stack([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]], axis=1)
        slide = moved - np.concatenate([np.zeros((len(moved), 1)), turned_arm], axis=1)
        y, z = (points - self.hinge).T[1:]
        turned = np.zeros((len(moved), len(points), 3))
        turned[:, :, 1] = cos[:, None] * y - sin[:, None] * z
        turned[:, :, 2] = sin[:, None] * y + cos[:, None] * z
        return turned + slide[:, None]
