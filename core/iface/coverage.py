"""How much of the data so many motion units cover: what the paper chose seven and two by."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from core.iface.motion_unit import NEUTRAL, MotionUnits


def covered_by_count(deformations: Mapping[str, np.ndarray], n_utterance: int | float) -> dict[str, np.ndarray]:
    """Return the covered share (0..1) by number of units: expression to shape (n_coordinates + 1,), from no unit up.

    deformations : as `MotionUnits.fit` takes them
    n_utterance : what the expressions' residual (equation 1) is left by; see `MotionUnits.fit`

    For ``neutral`` the share is of the variance of neutral speech, for an expression of the residual's.
    """
    most = int(np.prod(np.shape(deformations[NEUTRAL])[1:]))
    whole = MotionUnits.fit({NEUTRAL: deformations[NEUTRAL]}, most)
    shares = {NEUTRAL: _shares(whole.utterance.variance, most)}
    for name, units in MotionUnits.fit(deformations, n_utterance, most).expressions.items():
        shares[name] = _shares(units.variance, most)
    return shares


def _shares(variance: np.ndarray, most: int) -> np.ndarray:
    shares = np.ones(most + 1)
    total = variance.sum()
    shares[: len(variance) + 1] = np.concatenate([[0.0], np.cumsum(variance) / total]) if total > 0 else 1.0
    return np.minimum(shares, 1.0)
