"""A session outlives what it listens to, tells what it heard, and what it recorded is a project."""

from __future__ import annotations

import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from app import speech
from app.live.session import LiveSession
from app.live.source import Block, FileSource, SourceLost
from app.live.take import Recorder, save_take
from core.document.project_file import ProjectFile, read_project
from core.errors import UserFacingError
from core.iface.expression_ease import eased_strengths
from core.iface.speech_features import speech_features
from core.media.audio import Audio
from core.motion.database import open_database
from core.speech.emotion import EmotionModifier
from core.synthesis.registry import ENGINES
from tests.core.iface.linear_face import LinearFace

RATE_HZ = 48_000
REST = np.random.default_rng(3).normal(size=(6, 3)) * 20
WAIT_S = 10.0


class Given:
    """A source of blocks that were made before, as quick as they are taken; it may end in a loss, or wait."""

    def __init__(self, samples, rate_hz=RATE_HZ, block=480, lost=None, between=None):
        self.name, self.rate_hz, self.closed = "a test", rate_hz, threading.Event()
        self._samples, self._block, self._lost, self._between = samples, block, lost, between

    def blocks(self):
        for n, first in enumerate(range(0, len(self._samples), self._block)):
            if self._between is not None:
                self._between(n)
            if self.closed.is_set():
                return
            now_s = time.perf_counter()
            yield Block(self._samples[first : first + self._block], now_s, now_s - 0.004)
        if self._lost is not None:
            raise self._lost

    def close(self):
        self.closed.set()


def noise(duration_s=1.2, seed=4):
    rng, n = np.random.default_rng(seed), round(duration_s * RATE_HZ)
    return (0.08 * rng.normal(size=n) * (1 + np.sin(np.arange(n) / RATE_HZ * 9))).astype(np.float32)


class Heard:
    """A session and all that it said."""

    def __init__(self, face=None):
        self.frames, self.ends, self.ended = [], [], threading.Event()
        self.session = LiveSession(face or LinearFace(REST), self.frames.append, self._on_ended)

    def _on_ended(self, failure):
        self.ends.append(failure)
        self.ended.set()

    def run(self, source, **how):
        self.ended.clear()
        self.session.start(source, **how)
        assert self.ended.wait(WAIT_S)
        return self


def test_all_of_a_file_is_spoken_and_counted():
    samples = noise()
    samples[5000:5003] = 1.5
    heard = Heard().run(Given(samples))
    whole = LinearFace(REST).motion(speech_features(Audio(np.clip(samples, -1, 1), RATE_HZ)), {})
    assert heard.ends == [None] and len(heard.frames) in (36, 37)
    np.testing.assert_allclose([f.live.positions for f in heard.frames[:32]], whole[:32], atol=1e-4)
    figures = heard.session.figures()
    assert (figures["frames"], figures["dropouts"], figures["overflows"]) == (len(heard.frames), 0, 0)
    assert figures["clipped_samples"] >= 3 and figures["faulty_samples"] == 0
    frame = heard.frames[20]
    assert 0.0 <= frame.look_ahead_s <= 0.1 and frame.capture_s >= -1e-9
    parts_s = frame.capture_s + frame.look_ahead_s + frame.live.compute_s
    assert frame.made_s - frame.said_s == pytest.approx(parts_s)


def test_a_file_comes_at_the_pace_of_real_time():
    samples, began_s = noise(0.6), time.perf_counter()
    heard = Heard().run(FileSource(Audio(samples, RATE_HZ)))
    took_s = time.perf_counter() - began_s
    assert 0.58 < took_s < 1.5
    waits = [f.made_s - f.said_s for f in heard.frames[:-4]]
    assert min(waits) > 0.1 - 0.010  # the last window of a frame ends up to 10 ms before it
    assert np.median(waits) < 0.1 + 0.05 + (took_s - 0.6)


def test_a_file_that_repeats_ends_when_it_is_told_to():
    heard = Heard()
    heard.session.start(FileSource(Audio(noise(0.1), RATE_HZ), repeats=True))
    end_s = time.monotonic() + WAIT_S
    while heard.session.n_frames < 9 and time.monotonic() < end_s:
        time.sleep(0.01)
    heard.session.stop()
    assert heard.session.n_frames >= 9 and not heard.session.is_running
    assert heard.ends == []  # who stops it knows


def test_a_device_that_goes_away_is_one_sentence_and_the_session_goes_on_with_another():
    heard = Heard().run(Given(noise(0.5), lost=SourceLost("the microphone is gone.", "Plug it in again.")))
    (failure,) = heard.ends
    assert failure.message == "the microphone is gone." and not heard.session.is_running
    before = len(heard.frames)
    heard.session.ask("anger", 0.5)
    heard.run(Given(noise(0.5), rate_hz=44_100, block=441))
    assert heard.ends[1] is None and len(heard.frames) > before + 10
    assert heard.frames[before].live.frame == 0 and heard.frames[before].live.strengths["anger"] == pytest.approx(0.5)


def test_a_source_at_an_impossible_rate_is_one_sentence():
    heard = Heard().run(Given(noise(0.1), rate_hz=100))
    assert "rate of 100 Hz" in heard.ends[0].message
    assert heard.run(Given(noise(0.3))).ends[1] is None


def test_keys_of_any_moment_change_the_expression_without_a_jump():
    heard = Heard()
    keys = {20: ("happiness", 1.0), 60: ("sadness", 0.6), 61: ("boredom", 1.0), 90: ("neutral", 1.0)}
    heard.run(Given(noise(1.5), between=lambda n: heard.session.ask(*keys[n]) if n in keys else None))
    strengths = np.array([list(frame.live.strengths.values()) for frame in heard.frames])
    assert strengths[:, 0].max() > 0.9 and strengths[:, 2].max() > 0.5 and strengths[-1].max() < 0.1
    assert np.abs(np.diff(strengths, axis=0)).max() < 0.2 and not strengths[:2].any()


def recorded(from_block=0, spans=()):
    """Record from a block on, with an emotion asked for at some; returns the session's frames and the take."""
    heard = Heard()

    def between(n):
        if n == from_block and n:
            heard.session.record()
        for at, wish in spans:
            if n == at:
                heard.session.ask(*wish)

    heard.run(Given(noise(2.0), between=between), records=from_block == 0)
    return heard, heard.session.end_recording()


def again(take):
    """The motion that the engine makes of the project."""
    face, n = LinearFace(REST), len(take.positions)
    return face.motion(speech_features(take.audio, n), eased_strengths(face.expressions, take.spans, n))


def test_what_was_recorded_gives_the_motion_that_was_seen():
    heard, take = recorded(spans=[(30, ("anger", 0.8)), (90, ("neutral", 1.0)), (120, ("happiness", 1.0))])
    assert [span.emotion for span in take.spans] == ["anger", "happiness"]
    assert take.audio.rate_hz == RATE_HZ and take.audio.duration_s == 2.0
    np.testing.assert_array_equal(take.positions, [frame.live.positions for frame in heard.frames])
    n = len(take.positions) - 5
    np.testing.assert_allclose(again(take)[:n], take.positions[:n], atol=1e-4)


def test_a_recording_from_mid_speech_begins_on_the_grid_of_frames_and_differs_only_at_once():
    heard, take = recorded(from_block=33, spans=[(80, ("sadness", 1.0))])  # at 0.33 s, so from 0.4 s on
    assert take.audio.duration_s == pytest.approx(1.6)
    np.testing.assert_array_equal(take.audio.samples, noise(2.0)[19_200:])
    np.testing.assert_array_equal(take.positions[0], heard.frames[12].live.positions)
    n = len(take.positions) - 5
    np.testing.assert_allclose(again(take)[3:n], take.positions[3:n], atol=1e-3)


def test_a_recording_ends_with_its_device_and_is_kept():
    heard = Heard().run(Given(noise(0.7), lost=SourceLost("gone.")), records=True)
    assert heard.session.recorded_s == pytest.approx(0.7)
    assert heard.session.end_recording().audio.duration_s == pytest.approx(0.7)
    assert heard.session.end_recording() is None


def test_next_to_nothing_is_no_recording():
    recorder = Recorder(RATE_HZ, 0)
    recorder.accept(np.zeros(100, np.float32), [])
    with pytest.raises(UserFacingError, match="Nothing was recorded"):
        recorder.take()


def test_an_hour_is_the_longest_recording():
    recorder, (frame,) = Recorder(10, 0), Heard().run(Given(noise(0.2))).frames[:1]
    for _ in range(400):
        recorder.accept(np.zeros(100, np.float32), [frame.live])
    assert recorder.is_full and 3599 < recorder.duration_s <= 3610


def test_a_take_becomes_a_project_with_its_sound_and_emotions(tmp_path, database_path, monkeypatch):
    def nothing_heard(*_args, **_how):
        raise UserFacingError("Nobody speaks.")

    monkeypatch.setattr(speech, "load_speech", nothing_heard)
    _, take = recorded(spans=[(30, ("anger", 0.8))])
    database, path = open_database(database_path), tmp_path / "live.efase"
    said = save_take(take, path, database)
    assert said == ("What is said was not recognised: Nobody speaks.",)
    content, audio = read_project(path)
    assert content.engine in ENGINES and content.transcript.phones == ("pau",)
    assert content.database.content_hash == database.content_hash
    (span,) = content.modifiers
    assert span == replace(take.spans[0], end_s=span.end_s)
    assert isinstance(span, EmotionModifier) and span.end_s == pytest.approx(2.0, abs=0.05)
    np.testing.assert_allclose(audio.samples, take.audio.samples, atol=1e-6)
    file = ProjectFile.open(path)  # nothing had to be mended
    assert file.said == ()
    file.close()
    kept = replace(take, audio=audio, spans=content.modifiers)
    n = len(take.positions) - 5
    np.testing.assert_allclose(again(kept)[:n], take.positions[:n], atol=1e-3)
