"""Motion Units: what speech does to a face, and what an expression adds (Hong, Wen and Huang 2002, section IV)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from core.errors import UserFacingError

NEUTRAL = "neutral"
PAPER_UTTERANCE = 0.9756  # covered by the paper's seven utterance MUs
PAPER_EXPRESSION = 0.9813  # of the residual, covered by its two expression MUs


@dataclass(frozen=True)
class MotionUnitSet:
    """One set M_k: the mean m_k0 and the units m_k1 … m_kA.

    mean : float64, shape (n_coordinates,), millimetres (or pixels, as captured)
    units : float64, shape (A, n_coordinates), orthonormal rows, largest variance first
    variance : float64, shape (A,), of the parameters over the data it was learned from
    coverage : share (0..1) of the variance of that data which the units carry
    """

    mean: np.ndarray
    units: np.ndarray
    variance: np.ndarray
    coverage: float

    @classmethod
    def fit(cls, vectors: np.ndarray, how_many: int | float) -> MotionUnitSet:
        """Principal components of ``vectors``, shape (n_samples, n_coordinates).

        ``how_many`` is a number of units, or the share of the variance (below 1) that they shall cover.
        """
        mean = vectors.mean(axis=0)
        variance, directions = np.linalg.eigh(np.cov(vectors, rowvar=False, bias=True))
        variance, directions = variance[::-1].clip(0.0), directions[:, ::-1].T
        total = variance.sum()
        shares = np.cumsum(variance) / total if total > 0 else np.ones(len(variance))
        count = how_many if isinstance(how_many, int) else int(np.searchsorted(shares, how_many - 1e-12)) + 1
        count = min(count, int((variance > variance[0] * 1e-12).sum()))
        units = directions[:count]
        # a component's sign is free; fixed here so that equal data give equal bytes
        units = units * np.sign(units[np.arange(count), np.abs(units).argmax(axis=1)])[:, None]
        return cls(mean, units, variance[:count], float(shares[count - 1]) if count else 0.0)

    def parameters(self, vectors: np.ndarray) -> np.ndarray:
        """Project ``vectors``, shape (..., n_coordinates), less the mean; returns shape (..., A)."""
        return (vectors - self.mean) @ self.units.T

    def vectors(self, parameters: np.ndarray) -> np.ndarray:
        """Return mean plus the weighted units; the inverse of `parameters` within their span."""
        return self.mean + np.asarray(parameters, float) @ self.units


@dataclass(frozen=True)
class MotionUnits:
    """Utterance MUs M_0 and one set of expression MUs M_k for every expression.

    The residual that expression MUs are learned from is ``r_ki = (d_ki - m_00) - Σ_j ((d_ki - m_00)ᵀ m_0j) m_0j``:
    equation 1 as printed leaves m_00 out, and equations 2 to 4 would then count it twice.

    utterance : M_0, learned from neutral speech
    expressions : name to M_k; its units and mean are orthogonal to the units of M_0
    n_points, n_axes : a deformation has shape (n_points, n_axes), two or three axes
    """

    utterance: MotionUnitSet
    expressions: Mapping[str, MotionUnitSet]
    n_points: int
    n_axes: int

    @classmethod
    def fit(
        cls, deformations: Mapping[str, np.ndarray], n_utterance: int | float = PAPER_UTTERANCE,
        n_expression: int | float = 2,
    ) -> MotionUnits:  # fmt: skip
        """Learn from marker positions less the neutral pose, global motion removed.

        deformations : expression (``neutral`` must be there) to array of shape (n_frames, n_points, n_axes)
        n_utterance, n_expression : see `MotionUnitSet.fit`; the expressions' share is of the residual

        Raises `UserFacingError` without neutral speech, or with fewer than two frames of an expression.
        """
        if NEUTRAL not in deformations:
            raise UserFacingError("There is no neutral speech, which utterance motion units are learned from.")
        for expression, frames in deformations.items():
            if len(frames) < 2:
                raise UserFacingError(f"Motion units need two frames of '{expression}' or more.")
        n_points, n_axes = np.shape(deformations[NEUTRAL])[1:]
        packed = {name: np.reshape(frames, (len(frames), -1)).astype(float) for name, frames in deformations.items()}
        utterance = MotionUnitSet.fit(packed[NEUTRAL], n_utterance)
        expressions = {
            name: MotionUnitSet.fit(_residual(utterance, vectors), n_expression)
            for name, vectors in packed.items() if name != NEUTRAL
        }  # fmt: skip
        return cls(utterance, MappingProxyType(expressions), n_points, n_axes)

    def n_parameters(self, expression: str = NEUTRAL) -> int:
        """Return how many parameters a frame has: A_0, and A_k more with an expression."""
        return len(self.utterance.units) + (0 if expression == NEUTRAL else len(self._set(expression).units))

    def parameters(self, deformations: np.ndarray, expression: str = NEUTRAL) -> np.ndarray:
        """Return the MUPs of ``deformations``, shape (..., n_points, n_axes): utterance first, then expression.

        Since the two sets are orthogonal this is the least-squares fit of equation 2. A face at intensity α (which
        the paper leaves at 0 or 1) is fitted as if at full strength.
        """
        vectors = self._packed(deformations)
        spoken = self.utterance.parameters(vectors)
        if expression == NEUTRAL:
            return spoken
        return np.concatenate([spoken, self._set(expression).parameters(_residual(self.utterance, vectors))], axis=-1)

    def deformations(self, parameters: np.ndarray, expression: str = NEUTRAL, intensity: float = 1.0) -> np.ndarray:
        """Equation 2, ``d = Σ_k α_k (Σ_i c_ki m_ki + m_k0)`` with α_0 = 1; shape (..., n_points, n_axes).

        ``intensity`` is α_k of the active expression; the paper knows 0 and 1 only.
        """
        parameters = np.asarray(parameters, float)
        n_spoken = len(self.utterance.units)
        if parameters.shape[-1] != self.n_parameters(expression):
            raise ValueError(
                f"{parameters.shape[-1]} parameters, but '{expression}' has {self.n_parameters(expression)}"
            )
        vectors = self.utterance.vectors(parameters[..., :n_spoken])
        if expression != NEUTRAL:
            vectors = vectors + intensity * self._set(expression).vectors(parameters[..., n_spoken:])
        return vectors.reshape(*vectors.shape[:-1], self.n_points, self.n_axes)

    def covered(self, deformations: np.ndarray, expression: str = NEUTRAL) -> float:
        """Return the share of the variance of ``deformations`` about their mean that the units give back."""
        vectors = self._packed(deformations)
        again = self._packed(self.deformations(self.parameters(deformations, expression), expression))
        spread = ((vectors - vectors.mean(axis=0)) ** 2).sum()
        return 1.0 - float(((vectors - again) ** 2).sum() / spread) if spread > 0 else 1.0

    def _set(self, expression: str) -> MotionUnitSet:
        if expression not in self.expressions:
            known = ", ".join([NEUTRAL, *self.expressions])
            raise UserFacingError(f"There are no motion units for '{expression}'.", f"There are some for {known}.")
        return self.expressions[expression]

    def _packed(self, deformations: np.ndarray) -> np.ndarray:
        deformations = np.asarray(deformations, float)
        if deformations.shape[-2:] != (self.n_points, self.n_axes):
            raise ValueError(f"deformations of shape {deformations.shape}, not (..., {self.n_points}, {self.n_axes})")
        return deformations.reshape(*deformations.shape[:-2], -1)


def _residual(utterance: MotionUnitSet, vectors: np.ndarray) -> np.ndarray:
    """Equation 1, with the m_00 that it lacks."""
    return vectors - utterance.vectors(utterance.parameters(vectors))
