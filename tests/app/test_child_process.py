"""Work in a child process answers, refuses and ends as it would here, and a cancel does not wait for it."""

from __future__ import annotations

import multiprocessing
import os
import time

import pytest

from app.child_process import ChildFailure, run_apart
from core.errors import UserFacingError
from core.progress import SILENT, Cancelled, Progress

DIED = "It died."


class Recorded(Progress):
    def __init__(self, cancel_after_s: float = float("inf")) -> None:
        self.seen, self._until_s = [], time.monotonic() + cancel_after_s

    def step(self, fraction, message=""):
        self.seen.append((fraction, message))
        if time.monotonic() > self._until_s:
            raise Cancelled


class OddError(UserFacingError):
    def __init__(self, left, right):
        super().__init__(f"{left} {right}", "Mend it.")


def tell_and_answer(base, progress):
    progress.part(0.5, 1.0).step(0.5, "well under way")
    time.sleep(0.1)
    return base, os.getpid()


def fail(how, _progress):
    if how == "refuse":
        raise OddError("This", "is wrong.")
    if how == "system":
        raise PermissionError(13, "no", "file")
    if how == "fault":
        raise KeyError("a bug")
    os._exit(1)


def sleep(seconds, _progress):
    time.sleep(seconds)


def test_the_answer_comes_from_another_process_with_its_progress():
    progress = Recorded()
    answer, process = run_apart(tell_and_answer, ("words",), progress, DIED)
    assert answer == "words" and process != os.getpid()
    assert progress.seen[0] == (0.0, "")
    assert progress.seen[-1] == (0.75, "well under way")


@pytest.mark.parametrize(
    ("how", "kind", "says"),
    [
        ("refuse", UserFacingError, "^This is wrong. Mend it.$"),
        ("system", PermissionError, "no"),
        ("fault", ChildFailure, "KeyError: 'a bug'"),
        ("die", UserFacingError, DIED),
    ],
)
def test_a_failure_arrives_as_what_it_is(how, kind, says, capfd):
    with pytest.raises(kind, match=says):
        run_apart(fail, (how,), SILENT, DIED)
    assert capfd.readouterr().err == ""


def test_a_cancel_does_not_wait_for_the_work():
    others = multiprocessing.active_children()  # another test's pool of workers waits for more work
    began_s = time.monotonic()
    with pytest.raises(Cancelled):
        run_apart(sleep, (60,), Recorded(cancel_after_s=0.3), DIED)
    assert time.monotonic() - began_s < 10
    assert set(multiprocessing.active_children()) <= set(others)


def answer_as_a_worker(tells):
    tells.send((run_apart(tell_and_answer, ("words",), SILENT, DIED), os.getpid()))


def test_a_worker_that_may_have_no_children_does_the_work_itself():
    context = multiprocessing.get_context("spawn")
    hears, tells = context.Pipe(duplex=False)
    worker = context.Process(target=answer_as_a_worker, args=(tells,), daemon=True)
    worker.start()
    assert hears.poll(60)
    (answer, worked), itself = hears.recv()
    worker.join()
    hears.close()
    tells.close()
    worker.close()
    assert answer == "words" and worked == itself
