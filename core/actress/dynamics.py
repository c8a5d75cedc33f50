"""How articulators follow their gestures: critically damped second-order systems."""

from __future__ import annotations

import numpy as np

from core.actress.gestures import GestureScore


def follow(score: GestureScore, step_s: float, start: np.ndarray) -> np.ndarray:
    """Move tract variables from rest at ``start`` after the targets of a gesture score.

    Each variable z obeys z'' + 2 w z' + w^2 (z - target) = 0 (Saltzman and Munhall 1989, critical damping), w its
    stiffness in rad/s, so that it glides without overshoot and, when time is short, stops short of the target
    (undershoot). Target and stiffness are constant within a step, for which the solution is exact.

    start : float64, shape (n_variables,)
    returns : float64, shape (n_steps, n_variables); row f is the state at the start of step f
    """
    path = np.empty_like(score.targets)
    decay = np.exp(-score.stiffness_rad_s * step_s)
    place, velocity = np.array(start, float), np.zeros(len(start))
    for f, (target, stiffness) in enumerate(zip(score.targets, score.stiffness_rad_s)):
        path[f] = place
        away = place - target
        swing = velocity + stiffness * away
        place = target + (away + swing * step_s) * decay[f]
        velocity = (velocity - stiffness * swing * step_s) * decay[f]
    return path
