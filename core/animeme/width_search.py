"""Widths of dominance, step by step (Kuo et al. 2012, equations 8 and 9)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from core.animeme.damping import damped_step
from core.animeme.journal import TrainingJournal, WidthState
from core.animeme.levels import N_PHONEMES
from core.animeme.regression import Regression, Solved
from core.progress import Progress

# A phoneme that hardly moves a control leaves its widths undetermined; these bounds keep them sane.
NARROWEST, WIDEST = 0.05, 4.0
_AXES_SHARE = 0.98


@dataclass(frozen=True)
class TrainingSettings:
    """How to train; none of it changes what is trained.

    ridges_s : level name to its ridge, as seconds of speech that say 0
    width_pull : how strongly a width is held at 1, as a share of all squared residuals
    least_gain : stop when a step lowers the residual by less than this share
    is_projected : let the coefficients follow the widths within a step; False is the paper's EM
    """

    ridges_s: Mapping[str, float] = field(
        default_factory=lambda: {
            "class": 0.2, "phoneme": 0.2, "previous": 0.4, "following": 0.4, "duration": 0.12, "emotion": 0.12,
        }
    )  # fmt: skip
    width_pull: float = 2e-4
    least_gain: float = 5e-4
    most_steps: int = 60
    is_projected: bool = True


def leading_axes(targets: np.ndarray) -> np.ndarray:
    """Return the principal axes that carry nearly all that the controls do; shape (U, n_axes).

    The sum of squared residuals of controls that share their widths is the same along any orthonormal axes, and what
    the last axes hold costs as much time as the first and moves no width.
    """
    power, axes = np.linalg.eigh(targets.T @ targets)
    carried = np.cumsum(power[::-1])
    n_axes = 1 + int(np.searchsorted(carried, _AXES_SHARE * carried[-1])) if carried[-1] > 0 else 1
    return axes[:, ::-1][:, : min(n_axes, len(axes))]


def fit_widths(
    regression: Regression, targets: np.ndarray, settings: TrainingSettings, kept: TrainingJournal, group: int,
    progress: Progress,
) -> WidthState:  # fmt: skip
    """Take steps until the residual no longer falls; ``kept`` knows the steps of an earlier run."""
    pull = settings.width_pull * float((targets**2).sum()) / (2 * len(regression.said))

    def pulled(log_widths: np.ndarray) -> float:
        return pull * float((log_widths**2).sum())

    state = kept.state(group) or WidthState(np.zeros((2, N_PHONEMES)))
    solved = regression.solve(np.exp(state.log_widths), targets)
    loss = solved.loss + pulled(state.log_widths)
    if not state.losses:
        state = replace(state, losses=(loss,))
    while not state.is_done and len(state.losses) <= settings.most_steps:
        progress.step(0.9 * len(state.losses) / settings.most_steps, f"step {len(state.losses)}")
        squared, slope = regression.curvature(np.exp(state.log_widths), solved, settings.is_projected)
        squared[np.diag_indices_from(squared)] += pull
        slope -= pull * state.log_widths[:, regression.said].ravel()

        def attempt(step: np.ndarray, state: WidthState = state, solved: Solved = solved) -> tuple[float, tuple]:
            log_widths = _stepped(state.log_widths, regression.said, step)
            if settings.is_projected:
                tried = regression.solve(np.exp(log_widths), targets)
                return tried.loss + pulled(log_widths), (log_widths, tried)
            reached = regression.loss(np.exp(log_widths), targets, solved.coefficients)
            return reached + pulled(log_widths), (log_widths, None)

        better, damping = damped_step(squared, slope, state.damping, loss, attempt)
        if better is None:
            state = replace(state, is_done=True)
        else:
            log_widths, tried = better[1]
            solved = tried or regression.solve(np.exp(log_widths), targets)
            before, loss = loss, solved.loss + pulled(log_widths)
            is_done = before - loss < settings.least_gain * before
            state = WidthState(log_widths, damping, (*state.losses, loss), is_done)
        kept.keep(group, state)
    return state


def _stepped(log_widths: np.ndarray, said: np.ndarray, step: np.ndarray) -> np.ndarray:
    """Move the widths of the phonemes that are said, within the bounds."""
    stepped = log_widths.copy()
    stepped[:, said] = np.clip(stepped[:, said] + step.reshape(2, -1), np.log(NARROWEST), np.log(WIDEST))
    return stepped
