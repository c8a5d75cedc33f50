"""Playback keeps to the sound that is heard, measured through a PulseAudio null sink and its monitor."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.live.null_sink import null_sink
from app.texts import SOUND_LOST
from core.errors import UserFacingError

SESSION = Path(__file__).with_name("sound_session.py")
FRAME_S = 1 / 30
FIVE_MINUTES_S = 300


@pytest.fixture
def server():
    """A sound server of our own with a sink that nobody hears: its process and the environment that finds it."""
    if shutil.which("parec") is None:
        pytest.skip("pulseaudio-utils is not installed")
    devices = "import sounddevice; sounddevice.query_devices(kind='output')"
    try:
        with null_sink() as process:
            environment = {**os.environ, "PYTHONPATH": str(SESSION.parents[2])}
            if subprocess.run([sys.executable, "-c", devices], capture_output=True, check=False).returncode:
                pytest.skip("PortAudio does not reach PulseAudio (Debian package libasound2-plugins)")
            yield process, environment
    except UserFacingError as error:
        pytest.skip(error.message)


def session(environment, *arguments):
    done = subprocess.run(
        [sys.executable, str(SESSION), *map(str, arguments)],
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)


@pytest.mark.prove
def test_the_clock_stays_within_a_frame_of_what_is_heard_for_five_minutes(server, record_property):
    answer = session(server[1], "drift", FIVE_MINUTES_S)
    clicks, clock = np.array(answer["clicks"]), np.array(answer["clock"])
    assert not answer["lost"]
    assert len(clock) == len(clicks)
    ahead_s = clock - clicks
    share = len(clicks) // 5
    drift_s = float(np.median(ahead_s[-share:]) - np.median(ahead_s[:share]))
    figures = (
        f"drift {1000 * drift_s:.1f} ms, clock ahead by {1000 * ahead_s.min():.1f} to {1000 * ahead_s.max():.1f} ms"
    )
    record_property("playback", figures)
    print(figures)
    assert abs(drift_s) < FRAME_S
    assert np.ptp(ahead_s) < FRAME_S


@pytest.mark.prove
def test_playback_goes_on_by_a_timer_when_its_device_vanishes_and_says_so(server):
    process, environment = server
    answer = session(environment, "loss", process.pid)
    assert answer["clock"] == "SoundClock"
    assert answer["then"] == "TimerClock"
    assert answer["noted"] == [SOUND_LOST]
    assert answer["playing"]
    assert 2.0 < answer["after_s"] - answer["before_s"] < 4.3
