"""One tuning as the command line asks for it."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

from app.demo import open_named
from core.evaluation.tuning import TuningResult, TuningSettings, journal_path, tune
from core.evaluation.tuning_journal import TuningJournal
from core.evaluation.tuning_problem import TuningProblem
from core.evaluation.tuning_workers import cluster_workers, local_workers
from core.folders import cache_dir
from core.media.swap_in import check_target
from core.motion.stored_weights import AS_PRINTED, SEARCH, forget_weights, store_tuned
from core.progress import SILENT, Progress
from core.search.weight_files import write_weights
from core.synthesis.options import PAPER, SynthesisOptions

SPLIT = "tune"


@dataclass(frozen=True)
class TuningJob:
    """Everything that `efase tune` was told; see its help."""

    database: Path | None = None
    settings: TuningSettings = field(default_factory=TuningSettings)
    objective: str = "all"
    as_printed: bool = False
    jobs: int = -1
    cluster: str | None = None
    limit_s: float = math.inf
    output: Path | None = None


def run(job: TuningJob, progress: Progress = SILENT) -> dict[str, object]:
    """Tune, store the weights with the database, and return the object of ``--json``.

    Raises `UserFacingError` when nothing was held out to tune on, or the result could not be written.
    """
    if job.output is not None:
        check_target(job.output)
    database = open_named(job.database, progress.part(0.0, 0.1))
    recordings = database.held_out_recordings(SPLIT)
    check_target(database.path)
    options = PAPER if job.as_printed else SynthesisOptions().single
    problem = TuningProblem.of(database, recordings, job.objective, options)
    untuned = database.untuned_weights.as_printed if job.as_printed else database.untuned_weights
    began = time.perf_counter()
    where = cache_dir() / "tuning"
    journal = TuningJournal(journal_path(where, problem, untuned, job.settings))
    n_resumed = len(journal)
    ended = False
    try:
        with _workers(job, problem, progress.part(0.1, 0.15)) as workers:
            result = tune(problem, untuned, workers, job.settings, journal, progress.part(0.15, 0.98), job.limit_s)
        record = _record(job, result, len(recordings), time.perf_counter() - began)
        store_tuned(database, record)
        if job.output is not None:
            write_weights(job.output, result.weights, record)
        ended = result.is_complete
    finally:
        journal.close(finished=ended)
    return {"database": str(database.path), **record, "resumed": n_resumed}


def _workers(job: TuningJob, problem: TuningProblem, progress: Progress):
    if job.cluster is not None:
        return cluster_workers(problem, job.cluster)
    return local_workers(problem, job.jobs, progress)


def _record(job: TuningJob, result: TuningResult, n_sentences: int, seconds: float) -> dict[str, object]:
    return {
        "tuned": AS_PRINTED if job.as_printed else SEARCH,
        "split": SPLIT,
        "sentences": n_sentences,
        "objective": job.objective,
        **asdict(job.settings),
        "weights": result.weights.as_dict(),
        "total_error": result.total_error,
        "untuned_total_error": result.untuned_error,
        "mean_error": result.total_error / n_sentences,
        "untuned_mean_error": result.untuned_error / n_sentences,
        "sentence_solves": result.n_solves,
        "complete": result.is_complete,
        "seconds": round(seconds, 1),
        "history": [list(entry) for entry in result.history],
    }


def forget(path: Path | None, progress: Progress = SILENT) -> dict[str, object]:
    """Give a database its untuned weights back; returns the object of ``--json``."""
    database = forget_weights(open_named(path, progress))
    return {"database": str(database.path), "tuned": None, "weights": database.weights.as_dict()}


def in_words(answer: Mapping[str, object]) -> str:
    """Say in a few lines what a tuning found."""
    gained = 1.0 - answer["total_error"] / answer["untuned_total_error"] if answer["untuned_total_error"] else 0.0
    weights = ", ".join(f"{name} {value:.4g}" for name, value in answer["weights"].items())
    more = "" if answer["complete"] else "\nThe time was over before the budget; the same command goes on from here."
    return (
        f"{answer['mean_error']:.3f} mm² a sentence, untuned {answer['untuned_mean_error']:.3f} ({gained:.1%} less), "
        f"over {answer['sentences']} sentences held out to tune; {answer['sentence_solves']} sentences solved in "
        f"{answer['seconds']:.0f} s\n{weights}{more}"
    )
