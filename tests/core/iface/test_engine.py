"""iFACE as an engine among the others."""

# ruff: noqa: F811  pytest hands over fixtures by the names under which they are imported

from __future__ import annotations

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.evaluate import evaluate
from core.iface import default_model as module
from core.iface.engine import IfaceEngine
from core.iface.model_file import FaceModel
from core.media.audio import audio_from_bytes
from core.search.compute import NumpyKernels
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript
from core.synthesis.engine import SpeechInput
from core.synthesis.registry import ENGINES, engine_kind, make_engine, make_engines
from tests.core.evaluation.conftest import mouth_corpus, mouth_database  # noqa: F401


@pytest.fixture
def sound(loud_database):
    return audio_from_bytes(loud_database.audio_bytes("s10"))


def _speech(sound, *modifiers, duration_s=None):
    return SpeechInput(Transcript.covering([], [], duration_s or sound.duration_s), modifiers, audio=sound)


@pytest.mark.parametrize("variant", ["modern", "paper"])
def test_it_needs_no_words_and_answers_at_the_rate_of_the_database(quick_faces, loud_database, sound, variant):
    engine = IfaceEngine(loud_database, variant, quick_faces[variant])
    for duration_s in (0.05, sound.duration_s, sound.duration_s + 1.0):
        motion = engine.synthesise(_speech(sound, duration_s=duration_s)).motion
        assert motion.rate_hz == loud_database.rate_hz and motion.markers is loud_database.markers
        assert len(motion.positions) == round(duration_s * loud_database.rate_hz)
        assert motion.positions.dtype == np.float32 and np.isfinite(motion.positions).all()
    silent = motion.positions[-int(0.5 * loud_database.rate_hz) : -int(0.2 * loud_database.rate_hz)]
    assert np.abs(np.diff(silent, axis=0)).max() < 0.05  # behind the sound there is silence, and the face is still


def test_painted_emotions_come_and_go_smoothly(quick_faces, loud_database, sound):
    engine = IfaceEngine(loud_database, face=quick_faces["modern"])
    calm = engine.synthesise(_speech(sound)).motion.positions
    angry = engine.synthesise(_speech(sound, EmotionModifier(0.0, 9.0, "anger"))).motion.positions
    part = engine.synthesise(_speech(sound, EmotionModifier(0.6, 9.0, "anger"))).motion.positions
    half = engine.synthesise(_speech(sound, EmotionModifier(0.0, 9.0, "anger", 0.5))).motion.positions
    rate_hz = int(loud_database.rate_hz)
    np.testing.assert_allclose(part[: rate_hz // 2], calm[: rate_hz // 2], atol=0.01)
    np.testing.assert_allclose(part[-10:], angry[-10:], atol=0.05)
    np.testing.assert_allclose(half, (calm + angry) / 2, atol=0.01)
    assert np.abs(angry - calm).max() > 0.5
    share = np.abs(part - calm).max(axis=(1, 2)) / np.maximum(np.abs(angry - calm).max(axis=(1, 2)), 1e-3)
    assert 0.05 < share[int(0.7 * rate_hz)] < 0.95  # on its way


def test_an_emotion_that_was_never_captured_is_left_out_and_told(quick_faces, loud_database, sound):
    engine = IfaceEngine(loud_database, face=quick_faces["modern"])
    spans = [EmotionModifier(0.0, 1.0, "sadness"), EmotionModifier(1.0, 2.0, "neutral")]
    answer = engine.synthesise(_speech(sound, *spans))
    assert answer.warnings == ("The database 'loud mouths' has no captures of sadness, so it is not shown.",)
    calm = engine.synthesise(_speech(sound))
    assert calm.warnings == () and (calm.motion.positions == answer.motion.positions).all()


def test_without_sound_it_says_so(quick_faces, loud_database):
    engine = IfaceEngine(loud_database, face=quick_faces["modern"])
    with pytest.raises(UserFacingError, match="There is no sound"):
        engine.synthesise(SpeechInput(Transcript.covering([], [], 1.0)))


def test_the_registry_makes_both_and_they_are_measured_with_the_rest(loud_database, quick_faces, monkeypatch, tmp_path):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(
        module, "train_face",
        lambda d, variant, progress: FaceModel(quick_faces[variant], variant, d.markers.names, d.name,
                                               d.content_hash, 0),
    )  # fmt: skip
    engines = {name: make_engine(name, loud_database, NumpyKernels()) for name in ("iface", "iface-paper")}
    assert {name: engine.name for name, engine in engines.items()} == {n: n for n in engines}
    found = evaluate(loud_database, loud_database.held_out_recordings("test"), engines)
    assert all(result.scores.lip_gap_r > 0.6 for result in found.engines.values())


def test_those_that_listen_are_not_measured_where_there_is_nothing_to_hear(mouth_database, loud_database):
    assert {name for name, kind in ENGINES.items() if kind.listens} == {"iface", "iface-paper"}
    assert not any(engine_kind(name).listens for name in make_engines([], mouth_database, NumpyKernels))
    assert set(make_engines([], loud_database, NumpyKernels)) == set(ENGINES)
