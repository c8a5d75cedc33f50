"""One damped Gauss–Newton step, as Levenberg and Marquardt take it: it is taken only where it lowers the loss."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from scipy.linalg import solve

START = 1e-2
_LEAST, _MOST_TRIALS, _LONGEST = 1e-6, 8, 1.0

Tried = TypeVar("Tried")


def damped_step(
    squared: np.ndarray,
    slope: np.ndarray,
    damping: float,
    loss: float,
    attempt: Callable[[np.ndarray], tuple[float, Tried]],
) -> tuple[tuple[float, Tried] | None, float]:
    """Solve (JᵀJ + damping · diagonal) δ = Jᵀr (equation 9), with ever more damping until the loss falls.

    squared, slope : JᵀJ, shape (n, n), and Jᵀr, shape (n,)
    attempt : takes δ, of which no entry is beyond ±1, and returns the loss there and whatever else came of it
    returns : what the attempt that lowered ``loss`` returned, or None, and the damping to start with next time
    """
    diagonal = squared.diagonal()
    for _ in range(_MOST_TRIALS):
        held = squared + damping * np.diag(diagonal + 1e-6 * diagonal.mean() + 1e-300)
        tried = attempt(np.clip(solve(held, slope, assume_a="sym"), -_LONGEST, _LONGEST))
        if tried[0] < loss:
            return tried, max(damping / 3.0, _LEAST)
        damping *= 4.0
    return None, damping
