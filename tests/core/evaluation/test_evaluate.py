"""Engines over sentences that the database has not seen."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.evaluate import evaluate
from core.progress import Cancelled, Progress
from core.search.compute import NumpyKernels
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.registry import ENGINES, make_engines


class Recorder:
    """Answers with a face that the test chooses, and keeps what it was asked."""

    name = "recorder"

    def __init__(self, database):
        self.database, self.asked, self.motion = database, [], None

    def prepare(self, progress=None):
        pass

    def synthesise(self, speech, progress=None):
        self.asked.append(speech)
        n_frames = round(speech.transcript.duration_s * self.database.rate_hz)
        face = np.repeat(self.database.markers.rest[None].astype(np.float32), n_frames, axis=0)
        self.motion = MarkerMotion(face, self.database.rate_hz, self.database.markers)
        return self


@pytest.fixture(scope="module")
def evaluation(mouth_database):
    recordings = mouth_database.held_out_recordings("test")
    return evaluate(mouth_database, recordings, make_engines([], mouth_database, NumpyKernels))


def test_each_engine_is_asked_for_each_sentence_in_its_own_emotion(mouth_database):
    engine = Recorder(mouth_database)
    recordings = mouth_database.held_out_recordings("test")
    found = evaluate(mouth_database, recordings, {"rest": engine})
    assert [s.transcript for s in engine.asked] == [r.transcript for r in recordings]
    for speech, recording in zip(engine.asked, recordings):
        (span,) = speech.modifiers
        assert (span.start_s, span.end_s, span.emotion) == (0.0, recording.transcript.duration_s, recording.emotion)
    assert found.sentences == ("s14", "s15")
    assert found.engines["rest"].scores.gap_variance_ratio == 0.0


def test_the_answer_has_the_figures_and_is_json(evaluation):
    answer = json.loads(json.dumps(evaluation.as_dict(), allow_nan=False))
    assert answer["sentences"] == 2
    assert list(answer["engines"]) == [name for name, kind in ENGINES.items() if not kind.listens]  # it has no sound
    assert answer["floor"]["joins"]["acceleration_mm_s2"] > 0
    for figures in answer["engines"].values():
        assert figures.keys() >= {
            "error_mm2", "lip_error_mm", "lip_gap_r", "closure_rate", "gap_variance_ratio", "velocity_variance_ratio",
            "acceleration_variance_ratio", "seconds_per_sentence", "joins",
        }  # fmt: skip
        assert set(figures["per_emotion"]) == {"neutral", "anger"}
        assert set(figures["per_phoneme"]) == {"pau", "b", "aa", "iy", "k"}


def test_where_phones_make_the_motion_means_beat_stillness_and_the_search_beats_chance(evaluation):
    found = {name: result.scores for name, result in evaluation.engines.items()}
    assert found["phone-means"].error_mm2 < found["search"].error_mm2 < found["random"].error_mm2
    assert found["search"].error_mm2 < found["static"].error_mm2
    assert found["search"].lip_gap_r > 0.8 and found["static"].lip_gap_r == 0.0
    assert found["static"].velocity_variance_ratio == 0.0


def test_the_floor_is_the_noise_of_the_capture(evaluation):
    # 0.02 mm a coordinate: what smoothing five frames takes away of it, over three coordinates
    assert 0.01 < evaluation.floor.lip_error_mm < 0.1
    assert evaluation.floor.error_mm2 < 0.01
    assert evaluation.floor.velocity_variance_ratio > 1.0


def test_emotions_are_measured_apart_and_make_up_the_whole(evaluation):
    for result in evaluation.engines.values():
        parts = [part.error_mm2 for part in result.per_emotion.values()]
        assert result.scores.error_mm2 == pytest.approx(np.mean(parts))


def test_a_sentence_of_the_database_is_refused(mouth_database, mouth_corpus):
    with pytest.raises(UserFacingError, match="built of sentence 's00'"):
        evaluate(mouth_database, mouth_corpus.recordings[:1], {"rest": Recorder(mouth_database)})
    with pytest.raises(UserFacingError, match="no sentences"):
        evaluate(mouth_database, [], {"rest": Recorder(mouth_database)})


def test_it_stops_when_asked(mouth_database):
    class Impatient(Progress):
        def step(self, fraction, message=""):
            if fraction > 0.5:
                raise Cancelled

    engine = Recorder(mouth_database)
    with pytest.raises(Cancelled):
        evaluate(mouth_database, mouth_database.held_out_recordings("test"), {"rest": engine}, Impatient())
    assert len(engine.asked) == 1


def test_the_sound_that_is_kept_reaches_the_engine(mouth_corpus, tmp_path):
    import soundfile

    from core.motion.build import BuildSettings, build_database

    path = tmp_path / "hum.wav"
    soundfile.write(path, 0.3 * np.sin(np.arange(32_000) / 10), 16_000)
    heard = [replace(r, audio=path) if r.sentence == "s14" else r for r in mouth_corpus.recordings]
    database = build_database(replace(mouth_corpus, recordings=heard), tmp_path / "heard.h5", BuildSettings(n_dims=6))
    engine = Recorder(database)
    evaluate(database, database.held_out_recordings("test"), {"rest": engine})
    assert engine.asked[0].audio.duration_s == 2.0 and engine.asked[1].audio is None


def test_an_unknown_engine_is_refused_by_name(mouth_database):
    with pytest.raises(UserFacingError, match="no engine 'magic'"):
        make_engines(["static", "magic"], mouth_database, NumpyKernels)
