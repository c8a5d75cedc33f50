"""A pose of motion units as sliders hold it: each unit in standard deviations of the speech it was learned from."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from core.iface.motion_unit import NEUTRAL, MotionUnits


@dataclass(frozen=True)
class UnitPose:
    """What equation 2 makes a face of.

    units : the motion units
    deviations : float64, shape (n_parameters,), MUPs over their standard deviation, utterance first, then expression;
        all 0 is the mean of the speech (with the expression)
    expression, intensity : the active one and its α_k, 0..1 (the paper knows 0 and 1)
    """

    units: MotionUnits
    deviations: np.ndarray
    expression: str = NEUTRAL
    intensity: float = 1.0

    @classmethod
    def mean(cls, units: MotionUnits, expression: str = NEUTRAL, intensity: float = 1.0) -> UnitPose:
        """Return the mean face of an expression's speech; raises `UserFacingError` for one that there is not."""
        return cls(units, np.zeros(units.n_parameters(expression)), expression, intensity)

    @classmethod
    def nearest(
        cls, units: MotionUnits, deformation: np.ndarray, expression: str = NEUTRAL, intensity: float = 1.0
    ) -> UnitPose:
        """Return the pose that comes nearest to a deformation, shape (n_points, n_axes), by least squares.

        As equation 4 projects, with α_k between 0 and 1 taken into account; at 0 the expression's units stay at 0.
        """
        pose = cls.mean(units, expression, intensity)
        n_spoken = units.n_parameters()
        found = units.parameters(deformation)
        if expression != NEUTRAL:
            spoken = units.deformations(found)
            left = (np.asarray(deformation, float) - spoken) / intensity if intensity > 0 else 0.0
            beyond = units.parameters(spoken + left, expression)[n_spoken:]
            found = np.concatenate([found, beyond if intensity > 0 else np.zeros_like(beyond)])
        spread = pose.spread
        return replace(pose, deviations=np.divide(found, spread, out=np.zeros_like(found), where=spread > 0))

    @property
    def spread(self) -> np.ndarray:
        """One standard deviation of each parameter, float64, shape (n_parameters,), mm."""
        variances = [self.units.utterance.variance]
        if self.expression != NEUTRAL:
            variances.append(self.units.expressions[self.expression].variance)
        return np.sqrt(np.concatenate(variances))

    @property
    def n_spoken(self) -> int:
        """How many of the deviations are of utterance units."""
        return len(self.units.utterance.units)

    def deformation(self) -> np.ndarray:
        """Return displacements from the neutral face (equation 2), float64, shape (n_points, n_axes), mm."""
        return self.units.deformations(self.deviations * self.spread, self.expression, self.intensity)

    def moved(self, unit: int, deviation: float) -> UnitPose:
        """Return the pose with one unit elsewhere."""
        deviations = self.deviations.copy()
        deviations[unit] = deviation
        return replace(self, deviations=deviations)
