"""Animemes as an engine: learnt once, kept, and read again."""

# ruff: noqa: F811  pytest hands over fixtures by the names under which they are imported

from __future__ import annotations

import numpy as np
import pytest

from core.animeme import engine as engines
from core.animeme.dragging import dragged
from core.animeme.engine import AnimemeEngine, component_animemes
from core.animeme.form import COHEN_MASSARO
from core.animeme.material import face_controls, key_shape_controls, mouth_measures
from core.animeme.rival_engines import MmmEngine
from core.errors import UserFacingError
from core.evaluation.engines.static_face import StaticFace
from core.evaluation.evaluate import evaluate
from core.face.face import Face
from core.speech.emotion import EmotionModifier
from core.synthesis.engine import SpeechInput
from tests.core.evaluation.conftest import mouth_corpus, mouth_database  # noqa: F401


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache" / "animemes"


def test_it_is_nearer_to_unheard_captures_than_a_still_face_and_shuts_the_lips(mouth_database):
    recordings = mouth_database.held_out_recordings("test")
    kinds = {"animeme": AnimemeEngine, "mmm": MmmEngine, "still": StaticFace}
    found = evaluate(mouth_database, recordings, {name: kind(mouth_database) for name, kind in kinds.items()}).engines
    assert found["animeme"].scores.lip_gap_r > 0.9
    assert found["animeme"].scores.closure_rate == 1.0
    assert found["animeme"].scores.error_mm2 < 0.5 * found["still"].scores.error_mm2
    assert found["mmm"].scores.error_mm2 < found["still"].scores.error_mm2


def test_the_model_is_learnt_once_and_read_from_the_cache_after(mouth_database, cache, monkeypatch):
    first = component_animemes(mouth_database)
    monkeypatch.setattr(engines, "train_animemes", lambda *a, **k: pytest.fail("it was learnt twice"))
    again = component_animemes(mouth_database)
    np.testing.assert_array_equal(again.widths, first.widths)
    assert len(list(cache.iterdir())) == 1


def test_a_damaged_cache_and_one_that_cannot_be_written_only_cost_time(mouth_database, cache, monkeypatch):
    first = component_animemes(mouth_database)
    (kept,) = cache.iterdir()
    kept.write_bytes(b"no archive")
    np.testing.assert_array_equal(component_animemes(mouth_database).widths, first.widths)
    kept.unlink()
    cache.rmdir()
    cache.write_text("in the way")
    np.testing.assert_array_equal(component_animemes(mouth_database).widths, first.widths)


def test_forms_are_cached_apart(mouth_database, cache):
    component_animemes(mouth_database)
    assert component_animemes(mouth_database, COHEN_MASSARO).form.degree == 0
    assert len(list(cache.iterdir())) == 2


def test_anger_opens_wider_the_stronger_it_is(mouth_database):
    engine = AnimemeEngine(mouth_database)
    transcript = mouth_database.sentences[0].transcript
    gaps = []
    for strength in (0.0, 0.5, 1.0):
        felt = [EmotionModifier(0.0, transcript.duration_s, "anger", strength)]
        motion = engine.synthesise(SpeechInput(transcript, felt)).motion
        gaps.append(np.ptp(motion.positions[:, 3, 1] - motion.positions[:, 4, 1]))
    assert gaps[0] < gaps[1] < gaps[2]
    assert gaps[2] > 1.2 * gaps[0]


def test_a_dragged_sound_keeps_its_shape_where_the_question_says_so(mouth_database):
    engine = AnimemeEngine(mouth_database)
    sung = dragged(mouth_database.sentences[0].transcript, slot=2, duration_s=2.0)
    start_s, wander = sung.phonemes[2].start_s, {}
    for holds in (False, True):
        answer = engine.synthesise(SpeechInput(sung, holds=holds))
        middle = slice(*(round((start_s + t_s) * answer.motion.rate_hz) for t_s in (0.5, 1.5)))
        wander[holds] = np.ptp(answer.motion.positions[middle], axis=0).max()
        assert answer.holds == holds
    assert wander[True] < 0.1 * wander[False]


def test_animemes_of_other_controls_are_refused(mouth_database, known_model):
    from core.animeme.form import BEST

    with pytest.raises(UserFacingError, match="jawOpen"):
        AnimemeEngine(mouth_database, model=known_model(BEST))


def test_controls_of_captures_are_those_of_the_mouth(mouth_database):
    names, mapping = mouth_measures_or_none(mouth_database)
    assert names is None and mapping is None  # these markers show no corners
    names, mapping = key_shape_controls(mouth_database, 2)
    positions = mouth_database.pca.positions(mouth_database.frames[:200].astype(float))
    gap = positions[:, 3, 1] - positions[:, 4, 1]
    assert np.corrcoef(mapping(positions).sum(axis=1), gap)[0, 1] > 0.9


def mouth_measures_or_none(database):
    try:
        return mouth_measures(database)
    except UserFacingError:
        return None, None


def test_a_face_without_shapes_is_told(mouth_database):
    blank = Face("blank", np.zeros((3, 3), np.float32), np.array([[0, 1, 2]]), np.zeros(3, np.uint8))
    with pytest.raises(UserFacingError, match="no shapes"):
        face_controls(mouth_database, blank)
