"""Jobs answer on the main thread, in order, and let go of what they held in the thread that made it."""

from __future__ import annotations

import threading

import pytest

from app.jobs import JobRunner
from core.errors import UserFacingError

WAIT_MS = 5000


@pytest.fixture
def jobs(qapp):
    runner = JobRunner()
    yield runner
    runner.shut_down()
    runner.deleteLater()
    qapp.processEvents()


def test_the_work_is_elsewhere_and_the_answer_here(jobs, qtbot):
    threads = {}

    def work(request, _progress):
        threads["work"] = threading.get_ident()
        return request + 1

    def applied(answer):
        threads["applied"], threads["answer"] = threading.get_ident(), answer

    jobs.start("sum", "Adding", 41, work, applied)
    qtbot.waitUntil(lambda: "answer" in threads, timeout=WAIT_MS)
    assert threads["answer"] == 42
    assert threads["applied"] == threading.get_ident() != threads["work"]
    assert jobs.is_idle


def test_a_new_request_retires_the_old_one_and_its_late_answer_is_ignored(jobs, qtbot):
    answers, discarded = [], []
    running, first_may_end = threading.Event(), threading.Event()

    def stubborn(request, _progress):  # never asks whether it is cancelled
        running.set()
        first_may_end.wait(5)
        return request

    jobs.start("same", "First", "first", stubborn, answers.append, discarded=discarded.append)
    qtbot.waitUntil(running.is_set, timeout=WAIT_MS)
    jobs.start("same", "Second", "second", lambda request, _: request, answers.append)
    qtbot.waitUntil(lambda: answers == ["second"], timeout=WAIT_MS)
    first_may_end.set()
    qtbot.waitUntil(lambda: discarded == ["first"], timeout=WAIT_MS)
    assert answers == ["second"]


def test_a_cancelled_job_stops_at_its_next_step_and_says_nothing(jobs, qtbot):
    said, stopped, running = [], threading.Event(), threading.Event()
    jobs.failed.connect(lambda *words: said.append(words))

    def endless(_request, progress):
        try:
            while True:
                running.set()
                progress.step(0.5)
        finally:
            stopped.set()

    jobs.start("endless", "Waiting", None, endless, said.append)
    qtbot.waitUntil(running.is_set, timeout=WAIT_MS)
    jobs.cancel("endless")
    qtbot.waitUntil(stopped.is_set, timeout=WAIT_MS)
    qtbot.wait(50)
    assert said == []
    assert jobs.is_idle


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (UserFacingError("The file is empty.", "Choose another."), "The file is empty."),
        (ZeroDivisionError("1/0"), "This should not have happened while counting (ZeroDivisionError)"),
    ],
)
def test_a_failure_is_one_sentence(jobs, qtbot, caplog, error, sentence):
    def fail(_request, _progress):
        raise error

    with qtbot.waitSignal(jobs.failed, timeout=WAIT_MS) as told:
        jobs.start("fail", "Counting", None, fail, lambda _: None)
    assert told.args[0].startswith(sentence)
    is_our_fault = not isinstance(error, UserFacingError)
    assert ("ZeroDivisionError" in caplog.text) == is_our_fault


def test_what_a_cancelled_job_held_is_freed_in_its_own_thread(jobs, qtbot):
    threads = {}

    def pictures():
        threads["made"] = threading.get_ident()
        try:
            while True:
                yield 1
        finally:
            threads["freed"] = threading.get_ident()

    def work(_request, progress):
        for picture in pictures():
            progress.step(picture)

    jobs.start("film", "Composing", None, work, lambda _: None)
    qtbot.waitUntil(lambda: "made" in threads, timeout=WAIT_MS)
    jobs.cancel("film")
    qtbot.waitUntil(lambda: "freed" in threads, timeout=WAIT_MS)
    assert threads["freed"] == threads["made"] != threading.get_ident()


def test_nothing_starts_after_the_end(jobs):
    jobs.shut_down()
    jobs.start("late", "Late", None, lambda *_: None, lambda _: None)
    assert jobs.is_idle
