"""Training: coefficients and widths in turn, until the residual no longer falls (Kuo et al. 2012, section 5.3).

The E-step solves for all coefficients at once; the M-step takes a Gauss–Newton step on the logarithms of the widths (so
that they stay positive), damped as Levenberg and Marquardt do. A step is taken only when the residual falls, hence it
never rises. Widths are found with the levels of the paper (and the viseme classes that steady rare phonemes); the
levels that depend on neighbours, duration and emotion join for the last E-step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.animeme.animeme import AnimemeModel
from core.animeme.design import Scene
from core.animeme.examples import Example, Lesson
from core.animeme.form import BEST, AnimemeForm
from core.animeme.journal import TrainingJournal
from core.animeme.levels import N_PHONEMES, Level, levels_of, ridge_of, sharing
from core.animeme.regression import Regression
from core.animeme.utterances import Nearby
from core.animeme.width_search import TrainingSettings, fit_widths, leading_axes
from core.evaluation.measures import BILABIALS
from core.progress import SILENT, Progress


@dataclass(frozen=True, eq=False)
class Trained:
    """A model and how it came about.

    losses : for each group of controls what was made least, before the first step and after each, a frame
    residual : RMS error of the finished model over the training frames, as a share of each control's spread; mean over
        the controls that move
    """

    model: AnimemeModel
    losses: tuple[tuple[float, ...], ...]
    residual: float

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
    spread = offsets.std(axis=0)
    if importance is None:
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
    missed = np.zeros(n_controls)
    emphasis = lesson.emphasis(BILABIALS, form.bilabial_emphasis)
    of_widths, _ = _regression(scene, steady, span_s, lesson.rate_hz, emphasis)
    of_all, used = _regression(scene, levels, span_s, lesson.rate_hz, emphasis)
    for g in range(n_groups):
        mine = group == g
        targets = offsets[:, mine] * importance[mine]
        stage = progress.part(g / n_groups, (g + 1) / n_groups)
        state = fit_widths(of_widths, targets @ leading_axes(targets), settings, kept, g, stage)
        widths[g] = np.exp(state.log_widths)
        stage.step(0.95, "solving for the animemes")
        solved = of_all.solve(widths[g], targets)
        stacked[np.ix_(used, mine)] = solved.coefficients / importance[mine]
        missed[mine] = np.sqrt(((targets - solved.fitted) ** 2).mean(axis=0)) / importance[mine]
        losses.append(tuple(loss / len(targets) for loss in state.losses))
    model = AnimemeModel(
        form, lesson.names, rest, widths, group, _by_level(levels, stacked), span_s, lesson.digest()
    )  # fmt: skip
    kept.close()
    progress.step(1.0, "trained")
    moving = spread > 1e-6
    return Trained(model, tuple(losses), float((missed[moving] / spread[moving]).mean()) if moving.any() else 0.0)


def _regression(
    scene: Scene, levels: Sequence[Level], span_s: np.ndarray, rate_hz: float, emphasis: np.ndarray
) -> tuple[Regression, np.ndarray]:
    """Return the regression over ``levels``, and which of their columns have data."""
    shared = sharing(levels, scene.form.degree, scene.utterances, span_s)
    used = np.flatnonzero(shared.getnnz(axis=0))
    return Regression(scene, shared[:, used], ridge_of(levels, rate_hz)[used], emphasis), used


def _by_level(levels: Sequence[Level], stacked: np.ndarray) -> dict[str, np.ndarray]:
    stops = np.cumsum([level.n_columns for level in levels])
    return {
        level.name: stacked[stop - level.n_columns : stop].reshape(level.n_rows, level.degree + 1, -1)
        for level, stop in zip(levels, stops)
    }
