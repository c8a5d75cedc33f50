"""What the window's watchdog tells apart, and a measurement that comes to an end whatever the window does."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import pytest

from app import window_bench
from app.watchdog import Block, Watchdog
from app.window_script import ACTIONS, ScriptedAnimator, script
from app.window_session import figures
from core.errors import UserFacingError
from core.progress import SILENT

BUSY_S = 0.2


def compute(seconds: float) -> None:
    """Compute for so long on this thread's own clock, however busy the machine is."""
    end_s = time.thread_time() + seconds
    while time.thread_time() < end_s:
        np.linalg.norm(np.ones(1000))


@pytest.fixture
def watched(qtbot):
    """Return a function that has something done under a watchdog: the block that it made."""

    def do(what) -> Block:
        dog = Watchdog()
        dog.action = "before"
        dog.start()
        qtbot.waitUntil(lambda: len(dog.blocks) > 3)
        dog.action = "it"
        what()
        qtbot.waitUntil(lambda: dog.blocks[-1].action == "it")
        dog.stop()
        return max((block for block in dog.blocks if block.action == "it"), key=lambda block: block.wall_s)

    return do


def test_computing_is_told_from_waiting(watched):
    computed, waited = watched(lambda: compute(BUSY_S)), watched(lambda: time.sleep(BUSY_S))
    assert computed.wall_s >= computed.cpu_s >= BUSY_S and "compute" in computed.where
    assert waited.wall_s >= BUSY_S - 0.02 and waited.cpu_s < BUSY_S / 2
    for block in (computed, waited):
        assert 0 <= block.queued_s <= block.wall_s and block.own_s == pytest.approx(block.wall_s - block.queued_s)
    assert waited.own_s > BUSY_S / 2  # asleep it did not queue for a processor


def test_figures_count_what_is_late_by_the_clock_by_itself_and_by_computing():
    blocks = [Block("start", 9.0, 9.0, 0.0, "a"), Block("pin", 0.3, 0.02, 0.25, "b"), Block("pin", 0.2, 0.06, 0.0, "c"),
              Block("undo", 0.01, 0.01, 0.0, "")]  # fmt: skip
    seen = figures(blocks)
    assert (seen["beats"], seen["late"], seen["own_late"], seen["computed_late"]) == (3, 2, 1, 1)
    assert (seen["longest_ms"], seen["longest_own_ms"], seen["longest_computed_ms"]) == pytest.approx((300, 200, 60))
    assert [row["where"] for row in seen["worst"][:2]] == ["a", "c"]
    assert {row["action"]: row["longest_ms"] for row in seen["by_action"]} == pytest.approx(
        {"start": 9000, "pin": 300, "undo": 10}
    )


def test_the_script_has_two_hundred_actions_and_is_the_same_each_time():
    assert len(script()) == window_bench.ACTIONS == 200
    assert script() == script() and set(script()) == set(ACTIONS)


def test_an_action_that_a_dialog_holds_up_is_ended_and_named(qtbot, qapp, monkeypatch):
    from PySide6.QtWidgets import QDialog

    monkeypatch.setattr("app.window_script._STUCK_MS", 300)
    for action in ("undo", "redo"):
        monkeypatch.setitem(ACTIONS, action, (1, 10))
    animator = ScriptedAnimator.__new__(ScriptedAnimator)
    animator.watchdog, animator.stuck = type("Dog", (), {"action": ""})(), []
    animator._do = {"undo": lambda: QDialog().exec(), "redo": lambda: None}
    begun = []
    animator.perform(["undo", "redo"], lambda i, action: begun.append((i, action)))
    assert animator.stuck == ["undo"] and begun == [(0, "undo"), (1, "redo")]


def test_a_window_that_stands_still_is_ended_and_what_it_did_is_named(monkeypatch):
    monkeypatch.setattr(window_bench, "STILL_LIMIT_S", 1)
    code = "print('0.5 7 of 9: pin', flush=True); import time; time.sleep(60)"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        try:
            with pytest.raises(UserFacingError, match="stood still for 1 s at '7 of 9: pin'"):
                window_bench._listen(process, SILENT)
        finally:
            process.kill()


def test_a_window_that_ends_is_heard_to_its_end(monkeypatch):
    told = []

    class Told(type(SILENT)):
        def step(self, fraction, message=""):
            told.append((fraction, message))

    code = "print('0.25 one', flush=True); import time; time.sleep(0.3); print('0.75 two', flush=True)"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True) as process:
        window_bench._listen(process, Told())
        assert process.returncode == 0
    assert told[0][0] in (0.25, 0.75) and told[-1] == (0.75, "two")
