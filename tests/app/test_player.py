"""Playback follows its clock, and goes on when the sound is gone."""

from __future__ import annotations

import numpy as np
import pytest

import app.player
from app import texts
from app.jobs import JobRunner
from app.player import Player, TimerClock
from core.media.audio import Audio

WAIT_MS = 5000


class FakeClock:
    """Stands for a sound device that stops at a given time."""

    def __init__(self, start_s, dies_at_s=np.inf):
        self._timer, self._dies_at_s, self.stopped = TimerClock(start_s), dies_at_s, False

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
    monkeypatch.setattr(app.player, "_open_clock", open_clock)
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
