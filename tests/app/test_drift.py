"""Playback keeps to the sound that is heard, measured through a PulseAudio null sink and its monitor."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from app.texts import SOUND_LOST

SESSION = Path(__file__).with_name("sound_session.py")
FRAME_S = 1 / 30
FIVE_MINUTES_S = 300


@pytest.fixture
def server(tmp_path):
    """A sound server of our own with a sink that nobody hears: its process and the environment that finds it."""
    if not all(map(shutil.which, ("pulseaudio", "parec", "pactl"))):
        pytest.skip("pulseaudio and pulseaudio-utils are not installed")
    socket = tmp_path / "native"
    environment = {
        **os.environ, "PULSE_RUNTIME_PATH": str(tmp_path), "PULSE_STATE_PATH": str(tmp_path),
        "PULSE_SERVER": f"unix:{socket}", "PYTHONPATH": str(SESSION.parents[2]),
    }  # fmt: skip
    process = subprocess.Popen(
        ["pulseaudio", "-n", "--exit-idle-time=-1", "--daemonize=no", "--use-pid-file=no",
         "-L", f"module-native-protocol-unix socket={socket} auth-anonymous=1",
         "-L", "module-null-sink sink_name=out rate=48000 channels=1"],
        env={key: value for key, value in environment.items() if key != "PULSE_SERVER"},
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    for _ in range(50):
        if subprocess.run(["pactl", "info"], env=environment, capture_output=True, check=False).returncode == 0:
            break
        time.sleep(0.1)
    else:
        process.kill()
        pytest.skip("a PulseAudio server does not start here")
    devices = "import sounddevice; sounddevice.query_devices(kind='output')"
    if subprocess.run([sys.executable, "-c", devices], env=environment, capture_output=True, check=False).returncode:
        process.kill()
        pytest.skip("PortAudio does not reach PulseAudio (Debian package libasound2-plugins)")
    yield process, environment
    process.kill()
    process.wait()


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
