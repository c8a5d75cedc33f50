"""From motion units to keyframes and back: the bridge to blendshape rigs (Hong, Wen and Huang 2002, equations 3–4)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from core.iface.motion_unit import NEUTRAL, MotionUnits

# The paper's figure 4.
PAPER_KEYFRAMES = ("smile", "sad", "i", "a", "o", "f", "u", "m")


@dataclass(frozen=True)
class Keyframes:
    """Faces κ_i that a face is mixed of.

    As printed a face is ``s = Σ b_i κ_i`` of whole shapes, and none of the paper's eight is neutral, so that a neutral
    face has no exact weights. With ``of_displacements`` a face is ``s = s_0 + Σ b_i (κ_i - s_0)``, the form of
    blendshape rigs, and neutral is all zeros.

    names : one a keyframe
    shapes : float64, shape (n_keyframes, n_points, n_axes), whole faces, millimetres
    neutral : float64, shape (n_points, n_axes), the neutral face s_0
    of_displacements : mix displacements rather than whole shapes
    """

    names: tuple[str, ...]
    shapes: np.ndarray
    neutral: np.ndarray
    of_displacements: bool = False

    def faces(self, weights: np.ndarray) -> np.ndarray:
        """Return faces of keyframe weights b, shape (..., n_keyframes); shape (..., n_points, n_axes), mm."""
        faces = np.asarray(weights, float) @ self._matrix().T + self._origin()
        return faces.reshape(*faces.shape[:-1], *self.neutral.shape)

    def weights(self, faces: np.ndarray, bounded: bool = False) -> np.ndarray:
        """Return the weights b nearest to ``faces``, shape (..., n_points, n_axes), in the least-squares sense.

        Unbounded it is ``b = (KᵀK)⁻¹Kᵀ s`` (equation 4, solved by singular values, so that keyframes that are
        combinations of one another do no harm); ``bounded`` keeps every weight in [0, 1], as rigs want it.
        """
        faces = np.asarray(faces, float)
        wanted = faces.reshape(-1, self.neutral.size) - self._origin()
        matrix = self._matrix()
        if bounded:
            found = np.array([lsq_linear(matrix, face, (0.0, 1.0)).x for face in wanted])
        else:
            found = np.linalg.lstsq(matrix, wanted.T, rcond=None)[0].T
        return found.reshape(*faces.shape[:-2], len(self.names))

    def _matrix(self) -> np.ndarray:
        shapes = self.shapes - self.neutral if self.of_displacements else self.shapes
        return np.reshape(shapes, (len(self.names), -1)).astype(float).T

    def _origin(self) -> np.ndarray:
        return self.neutral.reshape(-1).astype(float) if self.of_displacements else np.zeros(self.neutral.size)


def parameters_of_weights(
    units: MotionUnits, keyframes: Keyframes, weights: np.ndarray, expression: str = NEUTRAL
) -> np.ndarray:
    """MUPs from keyframe weights (equation 4, first two lines); shape (..., n_parameters)."""
    return units.parameters(keyframes.faces(weights) - keyframes.neutral, expression)


def weights_of_parameters(
    units: MotionUnits, keyframes: Keyframes, parameters: np.ndarray, expression: str = NEUTRAL, bounded: bool = False
) -> np.ndarray:
    """Keyframe weights from MUPs (equation 4, last line); shape (..., n_keyframes)."""
    return keyframes.weights(units.deformations(parameters, expression) + keyframes.neutral, bounded)
