"""Where the sentences of a tuning run are solved: in this process, on all cores, or on a cluster."""

from __future__ import annotations

import contextlib
import itertools
import tempfile
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Protocol

import numpy as np

from core.batch.workers import dask_client
from core.evaluation.tuning_lattice import TuningLattice
from core.evaluation.tuning_problem import TuningProblem
from core.progress import SILENT, Progress
from core.search.transitions import BUDGET_BYTES, TransitionParts
from core.search.weights import SearchWeights

_UNPROVED = 1.5  # times as much
Task = tuple[SearchWeights, tuple[int, ...], bool]  # weights, sentences, and whether the answer must be exact
_PAGE = 1024  # float32 in a page of memory
_PORTIONS = 6  # a batch is handed to each core in so many, since some sentences take longer than others


class TuningWorkers(Protocol):
    """Whoever solves sentences."""

    def errors(self, tasks: Sequence[Task]) -> Iterator[tuple[int, list[float]]]:
        """Yield number and errors (mm², one a sentence) of each task, as they are done."""


class TuningEvaluator:
    """One process's share: the lattice of a problem, and the errors of paths that were met before.

    shared : ``parts`` and ``expected`` of another process's lattice of the same problem
    allocate : makes room for so many float32, where the lattice has to be made
    """

    def __init__(
        self,
        problem: TuningProblem,
        shared: tuple[np.ndarray | None, np.ndarray] | None = None,
        allocate: Callable[[int], np.ndarray] = lambda size: np.empty(size, np.float32),
        progress: Progress = SILENT,
    ) -> None:
        self.problem = problem
        terms, requests = problem.terms(), [s.request for s in problem.sentences]
        if shared is None:
            n_nodes = len(problem.nodes)
            parts = None
            if 12 * n_nodes**2 <= BUDGET_BYTES:
                parts = allocate(3 * n_nodes**2).reshape(3, n_nodes, n_nodes)
                computed = TransitionParts.of(terms, progress)
                for room, part in zip(parts, (computed.position_gap, computed.velocity_gap, computed.smoothing)):
                    room[:] = part
            self.lattice = TuningLattice(terms, requests, parts, allocate=allocate)
        else:
            for array in shared:
                if array is not None:
                    array.reshape(-1)[::_PAGE].sum()  # joblib replaces workers that grow later, shared pages counted
            self.lattice = TuningLattice(terms, requests, *shared)
        self._of_path: dict[tuple[int, bytes], float] = {}

    @property
    def shared(self) -> tuple[np.ndarray | None, np.ndarray]:
        """What other processes need not compute again."""
        return self.lattice.parts, self.lattice.expected

    def error(self, weights: SearchWeights, sentence: int, exact: bool = True) -> float:
        """Equation 12 of one sentence under ``weights``, mm²; see `TuningLattice.best_path`.

        More where the best path is not known without ``exact``: there it may leave the phonemes that are asked for, and
        a walk that trusted the error of the path that keeps to them would end where they are worth little.
        """
        request = self.problem.sentences[sentence].request
        path, is_proved = self.lattice.best_path(sentence, request, weights, exact)
        key = sentence, path.tobytes()
        if key not in self._of_path:
            self._of_path[key] = self.problem.error(sentence, path)
        return self._of_path[key] * (1.0 if is_proved else _UNPROVED)

    def errors(self, tasks: Sequence[Task]) -> Iterator[tuple[int, list[float]]]:
        """See `TuningWorkers.errors`."""
        for i, (weights, sentences, exact) in enumerate(tasks):
            yield i, [self.error(weights, s, exact) for s in sentences]


# A worker process keeps the evaluator of the problem that it works on; there is one at a time.
_evaluators: dict[str, TuningEvaluator] = {}
_one_at_a_time = threading.Lock()


def _evaluate(problem: TuningProblem, shared, tasks: Sequence[tuple[int, Task]]) -> list[tuple[int, list[float]]]:
    from threadpoolctl import threadpool_limits

    with _one_at_a_time, threadpool_limits(1):
        if problem.key not in _evaluators:
            _evaluators.clear()
            _evaluators[problem.key] = TuningEvaluator(problem, shared)
        evaluator = _evaluators[problem.key]
        return [(number, errors) for number, task in tasks for _, errors in evaluator.errors([task])]


class Cores:
    """All cores of this machine, by joblib; the weight-independent terms lie in one file that all of them map."""

    def __init__(self, evaluator: TuningEvaluator, n_jobs: int) -> None:
        self._evaluator = evaluator
        self._n_jobs = n_jobs

    def errors(self, tasks: Sequence[Task]) -> Iterator[tuple[int, list[float]]]:
        """See `TuningWorkers.errors`."""
        from joblib import Parallel, delayed

        problem, shared = self._evaluator.problem, self._evaluator.shared
        numbered = list(enumerate(tasks))
        n_portions = min(len(tasks), _PORTIONS * self._n_jobs)
        jobs = (delayed(_evaluate)(problem, shared, numbered[i::n_portions]) for i in range(n_portions))
        for answers in Parallel(n_jobs=self._n_jobs, return_as="generator_unordered", batch_size=1)(jobs):
            yield from answers


@contextlib.contextmanager
def local_workers(problem: TuningProblem, n_jobs: int = -1, progress: Progress = SILENT) -> Iterator[TuningWorkers]:
    """Workers of this machine: this process alone for one job, else ``n_jobs`` processes (-1: one a core)."""
    from joblib import cpu_count

    n_jobs = cpu_count() if n_jobs < 0 else n_jobs
    if n_jobs == 1:
        yield TuningEvaluator(problem, progress=progress)
        return
    with tempfile.TemporaryDirectory(prefix="efase-tuning-", ignore_cleanup_errors=True) as folder:
        files = (Path(folder) / f"terms-{i}.f32" for i in itertools.count())

        def allocate(size: int) -> np.ndarray:
            return np.memmap(next(files), np.float32, "w+", shape=(max(size, 1),))

        yield Cores(TuningEvaluator(problem, allocate=allocate, progress=progress), n_jobs)


@contextlib.contextmanager
def cluster_workers(problem: TuningProblem, address: str) -> Iterator[TuningWorkers]:
    """Workers of a Dask cluster at ``address`` (``tcp://host:port``); each computes the terms once for itself.

    A worker that dies takes nothing along: its sentences go to others, and one that joins later gets the problem too.
    Raises `UserFacingError` when `distributed` is not installed or no scheduler answers.
    """
    with dask_client(address, "Tuning") as client:
        yield Cluster(client, problem)


class Cluster:
    """A Dask cluster."""

    def __init__(self, client, problem: TuningProblem) -> None:
        from distributed.diagnostics.plugin import WorkerPlugin

        class CarryProblem(WorkerPlugin):
            """Gives each worker the problem, also one that joins, or comes back, later."""

            name = f"efase-tuning-{problem.key}"
            idempotent = True

            def setup(self, worker) -> None:
                worker.efase_tuning = problem

        self._client = client
        client.register_plugin(CarryProblem())

    def errors(self, tasks: Sequence[Task]) -> Iterator[tuple[int, list[float]]]:
        """See `TuningWorkers.errors`."""
        from distributed import as_completed

        futures = [self._client.submit(_evaluate_there, i, task, pure=False, retries=5) for i, task in enumerate(tasks)]
        for future in as_completed(futures, loop=self._client.loop):
            yield future.result()


def _evaluate_there(number: int, task: Task) -> tuple[int, list[float]]:
    from distributed import get_worker

    return _evaluate(get_worker().efase_tuning, None, [(number, task)])[0]
