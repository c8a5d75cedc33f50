"""Tuning of the search's weights on held-out sentences (Deng and Neumann 2008, section 6.4)."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.evaluation.tuning_fields import TuningSpace
from core.evaluation.tuning_journal import TuningJournal
from core.evaluation.tuning_methods import evolution, gradient_descent
from core.evaluation.tuning_problem import TuningProblem
from core.evaluation.tuning_workers import TuningWorkers
from core.progress import SILENT, Progress
from core.search.weights import SearchWeights

METHODS = ("evolution", "gradient")
SOLVES_A_START = 200
_PROMISING = 6  # weights that are measured exactly in the end


@dataclass(frozen=True)
class TuningSettings:
    """How a tuning goes about it.

    method : one of `METHODS`
    starts : random starts; the budget is `SOLVES_A_START` sentence-solves for each
    with_further : tune the terms beyond the paper too
    """

    method: str = "evolution"
    starts: int = 100
    seed: int = 2008
    with_further: bool = True

    def __post_init__(self) -> None:
        if self.method not in METHODS:
            raise UserFacingError(f"There is no tuning method '{self.method}'.", f"Choose one of {', '.join(METHODS)}.")

    @property
    def budget(self) -> int:
        """Sentence-solves."""
        return self.starts * SOLVES_A_START


@dataclass(frozen=True)
class TuningResult:
    """What a tuning found.

    total_error, untuned_error : TotalErr of equation 13 over the sentences, mm², under the weights found and before
    n_solves : sentence-solves of the walk; is_complete : the budget was spent, not the time
    history : sentence-solves spent, and the least TotalErr until then, at each improvement; of the walk, which may
        leave nodes of other phonemes out
    """

    weights: SearchWeights
    total_error: float
    untuned_error: float
    n_solves: int
    is_complete: bool
    history: tuple[tuple[int, float], ...]


class _Spent(Exception):
    """Budget or time is over."""


def journal_path(folder: Path, problem: TuningProblem, untuned: SearchWeights, settings: TuningSettings) -> Path:
    """Return where the journal of just this run lies within ``folder``."""
    asked = json.dumps([problem.key, untuned.as_dict(), asdict(settings)], sort_keys=True)
    return folder / f"tuning-{hashlib.sha256(asked.encode()).hexdigest()[:16]}.jsonl"


def tune(
    problem: TuningProblem,
    untuned: SearchWeights,
    workers: TuningWorkers,
    settings: TuningSettings | None = None,
    journal: TuningJournal | None = None,
    progress: Progress = SILENT,
    limit_s: float = np.inf,
) -> TuningResult:
    """Find weights of small TotalErr over the sentences of ``problem``.

    The untuned weights are the first start and are measured on all sentences, so nothing worse comes out. With a
    journal of an earlier, killed run of the same settings the answer is the one that it would have had.
    """
    settings = settings or TuningSettings()
    space = TuningSpace(untuned, problem.nodes, settings.with_further)
    journal = TuningJournal(None) if journal is None else journal
    run = _Run(problem, space, workers, journal, settings.budget, progress, limit_s)
    n_sentences = len(problem.sentences)
    starts = space.random_points(np.random.default_rng(settings.seed), settings.starts)
    starts[0] = space.start
    is_complete = True
    try:
        run.ask(starts[:1], range(n_sentences))
        if settings.method == "gradient":
            gradient_descent(space, starts, run.ask, n_sentences, settings.budget - run.n_solves)
        else:
            evolution(space, starts, run.ask, n_sentences, settings.seed)
    except _Spent:
        is_complete = not run.is_late
    untuned_error, (error, weights) = run.settled()
    return TuningResult(weights, error, untuned_error, run.n_solves, is_complete, tuple(run.history))


class _Run:
    """Answers for the methods, keeping book."""

    def __init__(
        self, problem: TuningProblem, space: TuningSpace, workers: TuningWorkers, journal: TuningJournal, budget: int,
        progress: Progress, limit_s: float,
    ) -> None:  # fmt: skip
        self._problem, self._space, self._workers, self._journal = problem, space, workers, journal
        self._budget, self._progress = budget, progress
        self._until = time.monotonic() + limit_s
        self._on_all: dict[bytes, tuple[float, np.ndarray]] = {}
        self.n_solves = 0
        self.history: list[tuple[int, float]] = []

    @property
    def is_late(self) -> bool:
        """Whether the time is over."""
        return time.monotonic() > self._until

    def ask(self, points: np.ndarray, sentences: Sequence[int]) -> np.ndarray:
        """See `core.evaluation.tuning_methods.Ask`; raises when the budget does not allow it or the time is over."""
        if self.n_solves + len(points) * len(sentences) > self._budget:
            raise _Spent
        weights = [self._space.weights(point) for point in points]
        errors = self._measured(points, weights, sentences, exact=False)
        self.n_solves += errors.size
        if len(sentences) == len(self._problem.sentences):
            for total, point in zip(errors.sum(axis=1).tolist(), points):
                self._on_all[point.tobytes()] = total, point
                if not self.history or total < self.history[-1][1]:
                    self.history.append((self.n_solves, total))
        return errors

    def settled(self) -> tuple[float, tuple[float, SearchWeights]]:
        """Exact TotalErr of the untuned weights; and the best exact one, with its weights, of the most promising."""
        best = sorted(self._on_all.values(), key=lambda entry: entry[0])[:_PROMISING]
        points = [np.array(list(self._space.untuned.as_dict().values())), *(point for _, point in best)]
        weights = [self._space.untuned, *(self._space.weights(point) for _, point in best)]
        self._until = np.inf  # what was found is worth to be finished
        errors = self._measured(points, weights, range(len(self._problem.sentences)), exact=True).sum(axis=1)
        least = int(errors.argmin())
        return float(errors[0]), (float(errors[least]), weights[least])

    def _measured(
        self, points: Sequence[np.ndarray], weights: Sequence[SearchWeights], sentences: Sequence[int], exact: bool
    ) -> np.ndarray:
        tasks, places = [], []
        for i, point in enumerate(points):
            missing = tuple(s for s in sentences if self._journal.error(point, exact, s) is None)
            if missing:
                tasks.append((weights[i], missing, exact))
                places.append(i)
        for number, errors in self._workers.errors(tasks) if tasks else ():
            self._journal.add(points[places[number]], exact, tasks[number][1], errors)
            self._progress.step(min(self.n_solves / self._budget, 1.0), self._message)
            if self.is_late:
                raise _Spent
        return np.array([[self._journal.error(point, exact, s) for s in sentences] for point in points])

    @property
    def _message(self) -> str:
        if not self.history:
            return "tuning"
        return f"tuning, {self.history[-1][1] / len(self._problem.sentences):.3f} mm²"
