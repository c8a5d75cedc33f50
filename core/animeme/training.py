"""Training: coefficients and widths in turn, until the residual no longer falls (Kuo et al. 2012, section 5.3).

The E-step solves for all coefficients at once; the M-step takes a Gauss–Newton step on the logarithms of the widths (so
that they stay positive), damped as Levenberg and Marquardt do. A step is taken only when the residual falls, hence it
never rises. Widths are found with the levels of the paper (and the viseme classes that steady rare phonemes); the levels
that depend on neighbours, duration and emotion join for the last E-step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from scipy.linalg import solve

from core.animeme.animeme import AnimemeModel
from core.animeme.design import Scene
from core.animeme.examples import Example, Lesson
from core.animeme.form import BEST, AnimemeForm
from core.animeme.journal import TrainingJournal, WidthState
from core.animeme.levels import N_PHONEMES, Level, levels_of, ridge_of, sharing
from core.animeme.regression import Regression
from core.animeme.utterances import Nearby
from core.progress import SILENT, Progress

# A phoneme that hardly moves a control leaves its widths undetermined; these bounds keep them sane.
NARROWEST, WIDEST = 0.05, 4.0
_MOST_TRIALS = 8


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
            "class": 0.04, "phoneme": 0.04, "previous": 0.4, "following": 0.4, "duration": 0.12, "emotion": 0.12,
        }
    )  # fmt: skip
    width_pull: float = 2e-4
    least_gain: float = 1e-4
    most_steps: int = 60
    is_projected: bool = True


@dataclass(frozen=True, eq=False)
class Trained:
    """A model and how it came about.

    losses : for each group of controls what was made least, after each step, in units of its training variance a frame
    """

    model: AnimemeModel
    losses: tuple[tuple[float, ...], ...]

    @property
    def n_steps(self) -> int:
        """Steps that were taken, all groups together."""
        return sum(len(losses) - 1 for losses in self.losses)


def train_animemes(
    examples: Sequence[Example],
    form: AnimemeForm = BEST,
    rest: np.ndarray | None = None,
    settings: TrainingSettings | None = None,
    importance: np.ndarray | None = None,
    journal: Path | None = None,
    progress: Progress = SILENT,
) -> Trained:
    """Learn animemes.

    rest : shape (U,), values of the controls at rest; 0 when absent
    importance : shape (U,), what an error of 1 counts in widths that controls share; the inverse of each control's
        standard deviation when absent
    journal : a file that a run which was cut goes on from; it is gone when the training ends
    Raises `UserFacingError` for examples that do not fit each other.
    """
    lesson, settings = Lesson.of(examples), settings or TrainingSettings()
    if lesson.n_emotions == 1:
        form = replace(form, emotion_degree=-1)
    n_controls = len(lesson.names)
    rest = np.zeros(n_controls) if rest is None else np.asarray(rest, float)
    offsets = lesson.values - rest
    if importance is None:
        spread = offsets.std(axis=0)
        importance = 1.0 / np.where(spread > 1e-9, spread, 1.0)
    scene = Scene(form, lesson.utterances, Nearby.of(lesson.utterances, lesson.times_s, form.neighbours))
    levels, span_s = levels_of(form, settings.ridges_s), lesson.span_s
    steady = tuple(level for level in levels if level.name in ("class", "phoneme"))
    key = f"{lesson.digest()} {form} {settings} {importance.tolist()} {rest.tolist()}"
    kept = TrainingJournal(journal, key)
    n_groups = 1 if form.has_shared_widths else n_controls
    group = np.zeros(n_controls, int) if form.has_shared_widths else np.arange(n_controls)
    stacked = np.zeros((sum(level.n_columns for level in levels), n_controls))
    widths, losses = np.empty((n_groups, 2, N_PHONEMES)), []
    of_widths, _ = _regression(scene, steady, span_s, lesson.rate_hz)
    of_all, used = _regression(scene, levels, span_s, lesson.rate_hz)
    for g in range(n_groups):
        mine = group == g
        targets = offsets[:, mine] * importance[mine]
        stage = progress.part(g / n_groups, (g + 1) / n_groups)
        state = _fit_widths(of_widths, targets, settings, kept, g, stage)
        widths[g] = np.exp(state.log_widths)
        stage.step(0.95, "solving for the animemes")
        stacked[np.ix_(used, mine)] = of_all.solve(widths[g], targets).coefficients / importance[mine]
        losses.append(tuple(loss / targets.size for loss in state.losses))
    model = AnimemeModel(
        form, lesson.names, rest, widths, group, _by_level(levels, stacked), span_s, lesson.digest()
    )  # fmt: skip
    kept.close()
    progress.step(1.0, "trained")
    return Trained(model, tuple(losses))


def _regression(
    scene: Scene, levels: Sequence[Level], span_s: np.ndarray, rate_hz: float
) -> tuple[Regression, np.ndarray]:
    """Return the regression over ``levels``, and which of their columns have data."""
    shared = sharing(levels, scene.form.degree, scene.utterances, span_s)
    used = np.flatnonzero(shared.getnnz(axis=0))
    return Regression(scene, shared[:, used], ridge_of(levels, rate_hz)[used]), used


def _by_level(levels: Sequence[Level], stacked: np.ndarray) -> dict[str, np.ndarray]:
    stops = np.cumsum([level.n_columns for level in levels])
    return {
        level.name: stacked[stop - level.n_columns : stop].reshape(level.n_rows, level.degree + 1, -1)
        for level, stop in zip(levels, stops)
    }


def _fit_widths(
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
        damping, better = state.damping, None
        for _ in range(_MOST_TRIALS):
            log_widths = _stepped(state.log_widths, regression.said, squared, slope, damping)
            if settings.is_projected:
                tried = regression.solve(np.exp(log_widths), targets)
                reached = tried.loss + pulled(log_widths)
            else:
                reached = regression.loss(np.exp(log_widths), targets, solved.coefficients) + pulled(log_widths)
            if reached < loss:
                better = log_widths
                break
            damping *= 4.0
        if better is None:
            state = replace(state, is_done=True)
        else:
            solved = tried if settings.is_projected else regression.solve(np.exp(better), targets)
            before, loss = loss, solved.loss + pulled(better)
            state = WidthState(
                better, max(damping / 3.0, 1e-6), (*state.losses, loss), before - loss < settings.least_gain * before
            )
        kept.keep(group, state)
    return state


def _stepped(
    log_widths: np.ndarray, said: np.ndarray, squared: np.ndarray, slope: np.ndarray, damping: float
) -> np.ndarray:
    """Take one damped Gauss–Newton step (equation 9), at most e-fold a width, within the bounds."""
    diagonal = squared.diagonal()
    held = squared + damping * np.diag(diagonal + 1e-6 * diagonal.mean())
    step = np.clip(solve(held, slope, assume_a="sym"), -1.0, 1.0).reshape(2, -1)
    stepped = log_widths.copy()
    stepped[:, said] = np.clip(stepped[:, said] + step, np.log(NARROWEST), np.log(WIDEST))
    return stepped
