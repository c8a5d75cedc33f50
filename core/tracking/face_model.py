"""What a tracked face may look like: its points at rest, and the motion units that deform them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.errors import UserFacingError
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.iface.units_of_database import units_of_database
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet

ANY = "any"
# Marker sets are x to the actor's left, y up; a picture of her face has x right, y down.
_TO_PICTURE = np.array([1.0, -1.0, 1.0])
# How far a head turns while it speaks (sine of the angle), and how much of a mean deformation a frame may have.
_TURN, _MEAN_SHARE = 0.15, 1.0
_CAMERA_MM = 900.0
CLICKED = ("mouth_corner_right", "mouth_corner_left", "outer_eye_right", "outer_eye_left")


@dataclass(frozen=True)
class FaceModel:
    """Generic points and units, in picture axes (x right, y down, z towards the camera), millimetres.

    names : K points; rest : float64, shape (K, 3), the neutral face s_0
    units : float64, shape (A, K, 3); variance : shape (A,), of their parameters in speech
    landmarks : anatomical name to row
    has_depth : the z of rest and units is known

    Among the units stand the means m_00 and m_k0 themselves, with parameters of their own: the paper gives them weight
    1 always, which no neutral first frame has, and an expression comes and goes.
    """

    names: tuple[str, ...]
    rest: np.ndarray
    units: np.ndarray
    variance: np.ndarray
    landmarks: Mapping[str, int]
    has_depth: bool = True

    @classmethod
    def of(cls, markers: MarkerSet, units: MotionUnits, expression: str = ANY) -> FaceModel:
        """Take the utterance units and those of ``expression``: ``neutral``, the name of one, or ``any`` for all.

        Raises `UserFacingError` for an expression that the units lack, and for a face without mouth corners.
        """
        chosen = () if expression == NEUTRAL else tuple(units.expressions) if expression == ANY else (expression,)
        unknown = [name for name in chosen if name not in units.expressions]
        if unknown:
            known = ", ".join([ANY, NEUTRAL, *units.expressions])
            raise UserFacingError(f"There are no motion units for '{unknown[0]}'.", f"There are some for {known}.")
        rows = {name: row for name in markers.landmarks if (row := markers.landmark(name)) is not None}
        lacking = [name for name in CLICKED[:2] if name not in rows]
        if lacking:
            raise UserFacingError(
                f"The database's markers do not say which of them is the {lacking[0].replace('_', ' ')}, "
                "where tracking begins."
            )
        sets = [units.utterance, *(units.expressions[name] for name in chosen)]
        vectors = [vector for each in sets for vector in (each.mean, *each.units)]
        variance = [v for each in sets for v in (_MEAN_SHARE**2, *each.variance)]
        shaped = np.reshape(vectors, (len(vectors), units.n_points, units.n_axes))
        deep = np.zeros((*shaped.shape[:2], 3))
        deep[..., : units.n_axes] = shaped
        has_depth = units.n_axes == 3 and float(np.ptp(markers.rest[:, 2])) > 0
        moved = np.abs(shaped).max(axis=(1, 2)) > 0
        return cls(markers.names, markers.rest * _TO_PICTURE, (deep * _TO_PICTURE)[moved], np.array(variance)[moved],
                   rows, has_depth)  # fmt: skip

    @classmethod
    def of_database(cls, database: MotionDatabase, expression: str = ANY) -> FaceModel:
        """Learn the units from the sentences of ``database``; see `of` for what is raised."""
        return cls.of(database.markers, units_of_database(database), expression)

    @cached_property
    def seen(self) -> np.ndarray:
        """The points at rest as a camera in front sees them, shape (K, 2), mm in the plane of mouth and eyes.

        What lies farther back is smaller. How far the camera is nobody knows; at an arm's length and a half it is wrong
        by less than a camera without perspective, which would put temples and jaw beside the head.
        """
        plane = self.rest[[self.landmarks[name] for name in CLICKED if name in self.landmarks], 2].mean()
        return self.rest[:, :2] * (_CAMERA_MM / (_CAMERA_MM - (self.rest[:, 2:] - plane)))

    @cached_property
    def flat_units(self) -> np.ndarray:
        """The units as a camera in front sees them, and two more that a turning head needs, shape (A + 2, K, 2).

        An affine map of the plane cannot shift near points against far ones. With depth known, the units (z, 0) and
        (0, z) let equation 5 do so: its 2D affine becomes the affine camera, which the paper leaves to 3D units.
        """
        flat = self.units[..., :2]
        if not self.has_depth:
            return flat
        z = self.rest[:, 2] - self.rest[:, 2].mean()
        zero = np.zeros_like(z)
        return np.concatenate([flat, [np.stack([z, zero], 1), np.stack([zero, z], 1)]])

    @cached_property
    def flat_variance(self) -> np.ndarray:
        """Variance of the parameters of `flat_units`."""
        return np.append(self.variance, [_TURN**2] * 2) if self.has_depth else self.variance
