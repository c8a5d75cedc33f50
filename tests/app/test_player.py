"""Playback follows its clock, and goes on when the sound is gone."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import app.player
from app import texts
from app.jobs import JobRunner
from app.player import Player
from app.sound import TimerClock
from core.media.audio import Audio

WAIT_MS = 5000


class FakeClock:
    """Stands for a sound device that stops at a given time."""

    def __init__(self, passage, dies_at_s=np.inf):
        self._timer, self._dies_at_s, self.stopped = TimerClock(passage), dies_at_s, False

    def now_s(self):
        return min(self._timer.now_s(), self._dies_at_s)

    @property
    def lost(self):
        return self._timer.now_s() >= self._dies_at_s

    def stop(self):
        self.stopped = True


@pytest.fixture
def player(qapp):
    jobs = JobRunner()
    made = Player(jobs)
    made.set_audio(Audio(np.zeros(4000, np.float32), 8000))
    yield made
    made.pause()
    jobs.shut_down()


@pytest.fixture
def clocks(monkeypatch):
    """Collect the clocks that the player opens; ``dies_at_s`` can be set."""
    opened = []

    def open_clock(request, _progress):
        opened.append(FakeClock(request[1], open_clock.dies_at_s))
        return opened[-1], ""

    open_clock.dies_at_s, open_clock.all = np.inf, opened
    monkeypatch.setattr(app.player, "open_clock", open_clock)
    return open_clock


def test_it_moves_with_its_clock_and_stops_at_the_end(player, clocks, qtbot):
    moved = []
    player.moved.connect(moved.append)
    player.play()
    qtbot.waitUntil(lambda: not player.is_playing, timeout=WAIT_MS)
    assert moved == sorted(moved)
    assert moved[-1] == pytest.approx(0.5)
    assert len(moved) > 10
    assert clocks.all[0].stopped


def test_a_seek_while_it_plays_starts_there(player, clocks, qtbot):
    moved = []
    player.play()
    qtbot.waitUntil(lambda: len(clocks.all) == 1, timeout=WAIT_MS)
    player.seek(0.4)
    player.moved.connect(moved.append)
    qtbot.waitUntil(lambda: moved != [], timeout=WAIT_MS)
    assert moved[0] >= 0.4
    assert clocks.all[0].stopped


def test_a_device_that_vanishes_does_not_stop_the_picture(player, clocks, qtbot):
    clocks.dies_at_s = 0.1
    notes = []
    player.noted.connect(notes.append)
    player.play()
    qtbot.waitUntil(lambda: not player.is_playing, timeout=WAIT_MS)
    assert notes == [texts.SOUND_LOST]


def test_a_pause_before_the_device_is_open_leaves_it_closed(player, clocks, qtbot):
    player.play()
    player.pause()
    qtbot.wait(200)
    assert all(clock.stopped for clock in clocks.all)
    assert not player.is_playing


def test_without_sound_there_is_nothing_to_play(player):
    player.set_audio(None)
    player.play()
    assert not player.is_playing
    assert player.duration_s == 0.0


def test_it_plays_backwards_to_the_start_and_faster_each_time_it_is_asked(player, clocks, qtbot):
    moved = []
    player.seek(0.4)
    player.moved.connect(moved.append)
    player.shuttle(-1)
    player.shuttle(-1)
    qtbot.waitUntil(lambda: not player.is_playing, timeout=WAIT_MS)
    assert moved == sorted(moved, reverse=True)
    assert moved[-1] == 0.0
    assert len(clocks.all) <= 2


def test_a_loop_is_repeated_until_it_is_paused(player, clocks, qtbot):
    moved = []
    player.set_loop((0.1, 0.2))
    player.moved.connect(moved.append)
    player.play()
    qtbot.waitUntil(lambda: len([1 for a, b in itertools.pairwise(moved) if b < a]) >= 2, timeout=WAIT_MS)
    assert player.is_playing
    assert min(moved) >= 0.1
    assert max(moved) < 0.2
    player.shuttle(0)
    assert not player.is_playing


def test_a_loop_too_short_to_hear_is_none(player):
    player.set_loop((0.2, 0.21))
    assert player.loop is None
