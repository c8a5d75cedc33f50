"""A real stream through PulseAudio, its loss, and what is said where there is nothing to hear with."""

from __future__ import annotations

import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from app.live import microphone
from app.live.microphone import InputDevice, Microphone, input_devices
from app.live.null_sink import null_sink
from app.live.session import LiveSession
from app.live.source import SourceLost
from core.errors import UserFacingError
from tests.core.iface.linear_face import LinearFace

WAIT_S = 20.0


@pytest.fixture
def server():
    """A sound server of our own, whose only input hears what is played."""
    try:
        with null_sink() as process:
            if not input_devices():
                pytest.skip("PortAudio does not reach PulseAudio (Debian package libasound2-plugins)")
            yield process
    except UserFacingError as error:
        pytest.skip(error.message)


def until(true, limit_s=WAIT_S):
    end_s = time.monotonic() + limit_s
    while not true():
        assert time.monotonic() < end_s
        time.sleep(0.02)


def test_a_device_that_vanishes_is_said_in_one_sentence_and_another_start_is_tried(server):
    frames, ends = [], []
    session = LiveSession(LinearFace(np.zeros((4, 3))), frames.append, ends.append)
    known = input_devices()
    default = next(device for device in known if device.is_default)
    session.start(Microphone(default))
    until(lambda: len(frames) > 15 or ends)
    assert not ends and session._source.rate_hz == 48_000
    assert session.level.rms_db == -90.0 and session.level.silent_s > 0.3  # nothing plays
    server.kill()
    until(lambda: ends)
    assert ends[0].message == f"{default.name} is gone." and "listen again" in ends[0].remedy
    assert not session.is_running
    session.start(Microphone(default))  # the server is still away: a sentence again, no hang
    until(lambda: len(ends) == 2)
    assert default.name in ends[1].message
    session.stop()


def test_a_microphone_that_is_closed_ends_at_once_and_says_nothing(server):
    frames, ends = [], []
    session = LiveSession(LinearFace(np.zeros((4, 3))), frames.append, ends.append)
    session.start(Microphone())
    until(lambda: frames or ends)
    began_s = time.monotonic()
    session.stop()
    assert time.monotonic() - began_s < 3.0 and ends == [] and not session.is_running


def test_a_device_that_is_not_there_is_one_sentence():
    with pytest.raises(SourceLost, match="No such microphone cannot be opened"):
        next(Microphone(InputDevice("No such microphone", "ALSA")).blocks())


def test_a_child_that_dies_is_a_device_that_is_gone(monkeypatch):
    monkeypatch.setattr(microphone, "_CHILD", [sys.executable, "-c", "import sys; sys.exit(1)"])
    with pytest.raises(SourceLost, match="default microphone is gone"):
        next(Microphone().blocks())
    with pytest.raises(SourceLost, match="sound system"):
        input_devices()


def test_a_child_that_is_silent_can_be_closed(monkeypatch):
    monkeypatch.setattr(microphone, "_CHILD", [sys.executable, "-c", "import time; time.sleep(60)"])
    source, blocks = Microphone(), []
    thread = threading.Thread(target=lambda: blocks.extend(source.blocks()))
    thread.start()
    until(lambda: isinstance(source._process, subprocess.Popen))
    source.close()
    thread.join(WAIT_S)
    assert not thread.is_alive() and blocks == []
