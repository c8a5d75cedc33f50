"""`efase live` from a terminal: what it prints, keeps and refuses."""

from __future__ import annotations

import json
import socket
import struct
from itertools import pairwise

import numpy as np
import pytest
import soundfile

from app import speech
from app.live import command
from app.live.microphone import InputDevice
from app.live.source import FileSource, SourceLost
from core.document.project_file import read_project
from core.errors import UserFacingError
from core.media.audio import Audio
from core.motion.database import open_database
from core.pipeline import live_weights
from tests.core.iface.linear_face import LinearFace


@pytest.fixture
def sound_path(tmp_path):
    n = 9600
    noise = 0.1 * np.random.default_rng(1).normal(size=n) * (1 + np.sin(np.arange(n) / 1000))
    soundfile.write(tmp_path / "said.wav", noise, 16_000)
    return tmp_path / "said.wav"


@pytest.fixture(autouse=True)
def stand_in(monkeypatch, settings_folder, database_path):
    """A face for the tiny database without training, a mesh with two units, and no recogniser."""

    def open_face(path, _progress):
        database = open_database(path or database_path)
        return database, LinearFace(database.markers.rest, expressions=("anger",))

    def nothing_heard(*_args, **_how):
        raise UserFacingError("Nobody speaks.")

    def units(_face, markers):
        return ("jawOpen", "mouthSmileLeft"), np.random.default_rng(2).normal(size=(2, len(markers), 3))

    monkeypatch.setattr(command, "open_speaking_face", open_face)
    monkeypatch.setattr(live_weights, "units_at_markers", units)
    monkeypatch.setattr("core.face.default_face.character_face", lambda _name: None)
    monkeypatch.setattr(speech, "load_speech", nothing_heard)


def test_a_file_is_spoken_sent_and_kept(efase, sound_path, tmp_path):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(5)
        address = f"udp://127.0.0.1:{receiver.getsockname()[1]}"
        code, out, err = efase("live", "--file", sound_path, "--emotion", "anger", "--intensity", 0.5, "--stream",
                               address, "--record", tmp_path / "kept.efase", "--json")  # fmt: skip
        packets = [receiver.recv(2000) for _ in range(18)]
    answer = json.loads(out)
    assert code == 0 and answer["frames"] == answer["sent"] >= 18 and answer["rate_hz"] == 16_000
    assert answer["waits_ms"]["look_ahead"]["median"] == pytest.approx(100.0, abs=10.0)
    assert answer["outputs"] == [str(tmp_path / "kept.efase")] and "Nobody speaks" in err
    at = 45 + struct.unpack("!i", packets[0][41:45])[0]
    frames = [struct.unpack("!i", packet[at : at + 4])[0] for packet in packets]
    assert all(earlier <= later for earlier, later in pairwise(frames))  # by the clock, whatever else the machine does
    content, audio = read_project(tmp_path / "kept.efase")
    (span,) = content.modifiers
    assert (span.start_s, span.emotion, span.intensity) == (0.0, "anger", 0.5) and span.end_s == pytest.approx(0.6)
    assert audio.rate_hz == 16_000 and len(audio.samples) == 9600 and content.engine == "iface"


def test_a_polite_kill_keeps_what_was_recorded(efase, sound_path, tmp_path, monkeypatch):
    def killed(session):
        if session.n_frames > 5:
            raise SystemExit(143)

    monkeypatch.setattr(command, "_tell", killed)
    code, out, err = efase("live", "--file", sound_path, "--record", tmp_path / "kept.efase", "--json")
    assert (code, out) == (143, ""), err
    assert read_project(tmp_path / "kept.efase")[1].duration_s > 0.1


def test_it_ends_when_the_time_is_up_and_says_so_in_words(efase, sound_path):
    code, out, _ = efase("live", "--file", sound_path, "--seconds", 0.3)
    assert code == 0 and "frames from" in out and "look-ahead" in out and "drop-outs 0" in out


def refusals(tmp_path, sound_path):
    """Words, and what is said of them."""
    yield ["--file", sound_path, "--device", "x"], "A file and a device"
    yield ["--file", tmp_path / "none.wav"], "none.wav"
    yield ["--file", sound_path, "--stream", "tcp://h:1"], "'tcp://h:1' is no address"
    yield ["--file", sound_path, "--record", tmp_path / "kept.wav"], "kept.wav' is no name of a project"
    yield ["--file", sound_path, "--record", tmp_path / "no" / "kept.efase"], "kept.efase"
    yield ["--file", sound_path, "--emotion", "boredom"], "'boredom' is not an emotion"
    yield ["--file", sound_path, "--emotion", "sadness"], "taught the face no 'sadness'"
    yield ["--device", "Mic"], "'Mic' names 2 devices"
    yield ["--device", "Mic three"], "names no devices"


def test_what_cannot_be_is_one_sentence_and_leaves_nothing(efase, tmp_path, sound_path, monkeypatch):
    known = InputDevice("Mic one", "ALSA"), InputDevice("Mic two", "ALSA")
    monkeypatch.setattr(command, "input_devices", lambda: known)
    for words, said in refusals(tmp_path, sound_path):
        code, out, err = efase("live", *words)
        assert (code, out) == (2, "") and said in err and err.startswith("efase: ") and err.count("\n") == 1
    assert command.named_device("two") == known[1] and command.named_device(None) is None
    assert not list(tmp_path.rglob("kept*"))


def test_a_device_that_goes_away_is_tried_again_and_without_any_it_ends(efase, monkeypatch):
    opened = []

    class Fleeting(FileSource):
        """A microphone that is gone after 0.25 s."""

        def __init__(self, _device):
            super().__init__(Audio(0.1 * np.ones(4000 if len(opened) < 2 else 16_000), 16_000))
            opened.append(self)

        def blocks(self):
            yield from super().blocks()
            raise SourceLost("Mic is gone.", "Plug it in again.")

    monkeypatch.setattr(command, "Microphone", Fleeting)
    monkeypatch.setattr(command, "_RETRY_S", 0.05)
    code, out, err = efase("live", "--seconds", 1.0, "--json")
    assert code == 0 and len(opened) == 3 and err.count("Mic is gone. Plug it in again.") == 2
    assert json.loads(out)["warnings"] == ["Mic is gone."] * 2

    class Absent(FileSource):
        """A microphone that cannot be opened."""

        def __init__(self, _device):
            super().__init__(Audio(np.zeros(4000), 16_000))

        def blocks(self):
            raise SourceLost("Mic cannot be opened: busy.")
            yield

    monkeypatch.setattr(command, "Microphone", Absent)
    code, out, err = efase("live", "--seconds", 5.0)
    assert (code, out, err) == (2, "", "efase: Mic cannot be opened: busy.\n")


def test_microphones_are_listed(efase, monkeypatch):
    from app.live import microphone

    monkeypatch.setattr(microphone, "input_devices", lambda: (InputDevice("Mic", "ALSA", True),))
    assert efase("live", "--devices")[1] == "Mic  (ALSA, default)\n"
    assert json.loads(efase("live", "--devices", "--json")[1])["devices"][0]["name"] == "Mic"
