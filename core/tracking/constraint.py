"""Noisy points brought back to what a face can do: equation 5, robust to points that went astray."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.iface.affine_fit import AffineFit, PosedUnits, linear_start, refined, too_few_points

_ROUNDS = 4
# Residuals are judged by their own spread, but no finer than pictures are sharp.
_SHARPEST_PX = 0.5
_SPREAD_OF_MAD = 1.4826
_TUKEY = 4.0


@dataclass(frozen=True)
class Constrained:
    """A robust fit.

    fit : where the face is and what it does
    weights : shape (K,), each point's trust times how well it agrees with the others
    spread_px : the usual residual of the points that agree
    """

    fit: AffineFit
    weights: np.ndarray
    spread_px: float


def constrained(
    face: PosedUnits, points: np.ndarray, trust: np.ndarray, start: AffineFit, prior: np.ndarray
) -> Constrained:
    """Fit affine and parameters to points by iteratively reweighted least squares (Tukey's biweight).

    points : shape (K, 2), pixels; trust : shape (K,), 0..1; start : of the last frame; prior : see `refined`
    """
    fit = start
    for _ in range(_ROUNDS):
        away = np.linalg.norm(fit.points(face) - points, axis=1)
        spread = spread_of(away, trust)
        weights = trust * agreement(away, spread)
        fit = refined(face, points, fit, weights, prior)
    return Constrained(fit, weights, spread)


def fresh_start(face: PosedUnits, points: np.ndarray, trust: np.ndarray, n_units: int) -> AffineFit | None:
    """Begin without a last frame, by appendix A; None where too few points are seen.

    n_units : how many of the units take part, from the first; those of a turning head are no use, since appendix A
        cannot tell (z, 0) from (0, z)
    """
    bare = PosedUnits(face.base, face.units[:n_units])
    if too_few_points(bare, int((trust > 0).sum())):
        return None
    begun = linear_start(bare, points, trust)
    return AffineFit(np.append(begun.parameters, np.zeros(len(face.units) - n_units)), begun.affine)


def spread_of(away_px: np.ndarray, trust: np.ndarray) -> float:
    """Robust standard deviation of residuals, of the points that are trusted at all."""
    seen = away_px[trust > 0.1]
    return max(_SPREAD_OF_MAD * float(np.median(seen)), _SHARPEST_PX) if len(seen) else _SHARPEST_PX


def agreement(away_px: np.ndarray, spread_px: float) -> np.ndarray:
    """Tukey's weights of residuals, 1 for none, 0 from four spreads on."""
    share = np.minimum(away_px / (_TUKEY * spread_px), 1.0)
    return np.square(1.0 - share * share)
