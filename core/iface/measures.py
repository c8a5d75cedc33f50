"""How near estimated displacements are to captured ones (Hong, Wen and Huang 2002, section VII-A, equations 6–8).

Displacements are from the neutral pose, mm, shape (n_frames, n_points, n_axes), of the same points at the same times.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

_STILL = 1e-12  # of the square of the largest displacement
_ROUNDING = 1e-6  # of the largest displacement


class Nearness(NamedTuple):
    """One column of the paper's tables.

    r : Pearson's product-moment correlation R of equation 6, -1..1; 0 where one of the two holds still
    spread, spread_estimated : mean standard deviations ν of equation 7, of the captured and of the estimated
    mse : mean square error of equation 8
    """

    r: float
    spread: float
    spread_estimated: float
    mse: float


def largest_displacements(displacements: np.ndarray) -> np.ndarray:
    """Return how far each point moves at most, mm, float64, shape (n_points,): what normalised displacements divide by.

    The paper takes "its maximum absolute displacement in the collected database", so that coordinates come to lie in
    [-1, 1]; it is read as a length, for a coordinate of its own would make as much of an axis along which a point only
    trembles as of those along which it moves. A point that never moves, such as the origin of head space, has infinity:
    its normalised displacement is 0, whatever rounding says.
    """
    furthest = np.linalg.norm(displacements, axis=2).max(axis=0).astype(float)
    return np.where(furthest > _ROUNDING * furthest.max(initial=0.0), furthest, np.inf)


def nearness(captured: np.ndarray, estimated: np.ndarray, largest_mm: np.ndarray) -> Nearness:
    """Measure ``estimated`` beside ``captured`` displacements, both divided by ``largest_mm``, shape (n_points,).

    ``R = tr C_dd' / √(tr C_dd · tr C_d'd')``, each signal centred by its own mean over all frames (equation 6, whose
    covariances are misprinted); ν = mean over the γ coordinates of √C_cc (equation 7); ``MSE = E|d - d'|² / γ``
    (equation 8). Raises ValueError when the shapes differ or there are no frames.
    """
    if captured.shape != estimated.shape or captured.ndim != 3 or len(captured) == 0:
        raise ValueError(f"displacements of shapes {captured.shape} and {estimated.shape} cannot be compared")
    d, e = ((moved / np.asarray(largest_mm)[:, None]).reshape(len(moved), -1) for moved in (captured, estimated))
    mse = float(((d - e) ** 2).mean())
    highest = max(float(np.abs(d).max()), float(np.abs(e).max()))
    d, e = d - d.mean(axis=0), e - e.mean(axis=0)
    variances = (d**2).mean(axis=0), (e**2).mean(axis=0)
    totals = [float(variance.sum()) for variance in variances]
    is_moving = min(totals) > _STILL * highest**2
    r = float((d * e).mean(axis=0).sum() / np.sqrt(totals[0] * totals[1])) if is_moving else 0.0
    return Nearness(r, *(float(np.sqrt(variance).mean()) for variance in variances), mse)
