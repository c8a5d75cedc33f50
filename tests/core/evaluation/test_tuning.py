"""Tuning finds what is there to be found, and goes on after a kill as if nothing had been."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.tuning import TuningSettings, journal_path, tune
from core.evaluation.tuning_journal import TuningJournal
from core.evaluation.tuning_problem import TuningProblem
from core.evaluation.tuning_workers import TuningEvaluator, cluster_workers, local_workers

GOAL = {"alpha1": 0.3, "alpha4": 0.6, "alpha5": 20.0}


class Landscape:
    """Errors with one valley and no slope: a staircase of the distance to `GOAL`, another for each sentence."""

    def errors(self, tasks):
        for i, (weights, sentences, _exact) in enumerate(tasks):
            off = sum(np.log(getattr(weights, name) / value) ** 2 for name, value in GOAL.items())
            yield i, [float(np.ceil(20 * (0.2 + off) * (1 + 0.1 * s)) / 20) for s in sentences]


@pytest.fixture
def problem(mouth_database):
    return TuningProblem.of(mouth_database, mouth_database.held_out_recordings("tune"))


@pytest.mark.parametrize("method", ["evolution", "gradient"])
def test_the_valley_is_found_although_nothing_slopes(problem, mouth_database, method):
    result = tune(problem, mouth_database.weights, Landscape(), TuningSettings(method, starts=30, with_further=False))
    assert result.is_complete
    assert result.n_solves <= 30 * 200
    assert result.total_error < 0.25 * result.untuned_error
    for name, value in GOAL.items():
        assert abs(np.log(getattr(result.weights, name) / value)) < 0.7
    errors = [error for _, error in result.history]
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize("method", ["evolution", "gradient"])
def test_nothing_worse_than_the_untuned_weights_comes_out(problem, mouth_database, method):
    with local_workers(problem, 1) as workers:
        result = tune(problem, mouth_database.weights, workers, TuningSettings(method, starts=6, with_further=False))
    assert result.total_error <= result.untuned_error
    evaluator = TuningEvaluator(problem)
    measured = sum(evaluator.error(result.weights, s) for s in range(len(problem.sentences)))
    assert result.total_error == pytest.approx(measured, rel=1e-9)


def test_what_the_paper_lacks_is_left_alone_unless_asked_for(problem, mouth_database):
    untuned = mouth_database.weights.as_printed
    printed, further = (
        tune(problem, untuned, Landscape(), TuningSettings(starts=20, with_further=f)).weights for f in (False, True)
    )
    assert printed == printed.as_printed
    assert further.context_before > 0


def test_time_that_is_over_ends_it_with_what_was_found(problem, mouth_database):
    class Slow(Landscape):
        def errors(self, tasks):
            for answer in super().errors(tasks):
                time.sleep(0.01)
                yield answer

    result = tune(problem, mouth_database.weights, Slow(), TuningSettings(starts=200), limit_s=0.5)
    assert not result.is_complete
    assert result.total_error <= result.untuned_error


def test_a_method_that_there_is_not_is_refused():
    with pytest.raises(UserFacingError, match="method 'prayer'"):
        TuningSettings(method="prayer")


_KILLED = """
import sys
from pathlib import Path
from core.evaluation.tuning import TuningSettings, journal_path, tune
from core.evaluation.tuning_journal import TuningJournal
from core.evaluation.tuning_problem import TuningProblem
from core.evaluation.tuning_workers import local_workers
from core.motion.database import open_database

database = open_database(Path(sys.argv[1]))
problem = TuningProblem.of(database, database.held_out_recordings("tune"))
settings = TuningSettings(starts=8, with_further=False)
journal = TuningJournal(journal_path(Path(sys.argv[2]), problem, database.weights, settings))
with local_workers(problem, 1) as workers:
    tune(problem, database.weights, workers, settings, journal)
print("survived")
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
def test_a_killed_run_resumes_to_the_same_answer(problem, mouth_database, tmp_path):
    settings = TuningSettings(starts=8, with_further=False)
    path = journal_path(tmp_path, problem, mouth_database.weights, settings)
    command = [sys.executable, "-c", _KILLED, str(mouth_database.path), str(tmp_path)]
    root = Path(__file__).resolve().parents[3]
    with subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, text=True) as process:
        until = time.monotonic() + 120
        while time.monotonic() < until and not (path.is_file() and path.read_bytes().count(b"\n") > 40):
            time.sleep(0.005)
        os.kill(process.pid, signal.SIGKILL)
        assert "survived" not in process.communicate()[0]
    journal = TuningJournal(path)
    assert len(journal) > 0
    with local_workers(problem, 1) as workers:
        whole = tune(problem, mouth_database.weights, workers, settings)
        resumed = tune(problem, mouth_database.weights, workers, settings, journal)
    journal.close()
    assert resumed == whole


def test_two_processes_find_what_one_finds(problem, mouth_database):
    settings = TuningSettings(starts=4, with_further=False)
    with local_workers(problem, 1) as alone, local_workers(problem, 2) as both:
        assert tune(problem, mouth_database.weights, both, settings) == tune(
            problem, mouth_database.weights, alone, settings
        )


def test_a_cluster_that_does_not_answer_is_one_sentence(problem):
    pytest.importorskip("distributed")
    with pytest.raises(UserFacingError, match="No Dask scheduler"), cluster_workers(problem, "nonsense://nowhere"):
        pass


@pytest.mark.prove
@pytest.mark.filterwarnings("ignore")
def test_a_cluster_finds_the_same_though_a_worker_is_killed_midway(problem, mouth_database):
    distributed = pytest.importorskip("distributed")
    settings = TuningSettings(starts=12, with_further=False)
    with local_workers(problem, 1) as alone:
        expected = tune(problem, mouth_database.weights, alone, settings)
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    killed = []

    class KillOne(TuningJournal):
        def add(self, *entry):
            super().add(*entry)
            if not killed and len(self) > 60:
                victim = next(iter(cluster.workers.values()))
                killed.append(victim.pid)
                os.kill(victim.pid, signal.SIGKILL)

    with cluster, cluster_workers(problem, cluster.scheduler_address) as workers:
        found = tune(problem, mouth_database.weights, workers, settings, KillOne(None))
    assert killed
    assert found == expected
