"""The engine with its options: what the paper does, and what is added to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.search.compute import NumpyKernels
from core.search.engine import SearchEngine
from core.speech.emotion import EmotionModifier
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.concatenate import concatenate
from core.synthesis.engine import SpeechInput
from core.synthesis.options import PAPER, SynthesisOptions
from core.synthesis.silence import regenerate_silence
from core.synthesis.smoothing import smooth_joins

PHONES = ("pau", "k", "aa", "b", "iy", "s", "pau")


def speech(*modifiers, pins=None):
    spoken = tuple(PhonemeUtterance(p, 0.15 * i, 0.15 * i + 0.15) for i, p in enumerate(PHONES))
    return SpeechInput(Transcript(spoken, (), 0.15 * len(PHONES)), modifiers, pins or {})


def engine(database, **options):
    return SearchEngine(database, NumpyKernels(), options=SynthesisOptions(**options))


def test_the_papers_setting_is_the_papers_pipeline(talking_database):
    database = talking_database()
    answer = SearchEngine(database, NumpyKernels(), options=PAPER).synthesise(speech())
    path, slots = answer.path.nodes, answer.slots
    phonemes = np.array([0 if p == "pau" else database.nodes.phoneme[n] for p, n in zip(PHONES, path)])
    motion = concatenate(path, slots, database.frames, database.nodes)
    motion = smooth_joins(motion, path, phonemes, slots, database.nodes)
    motion = regenerate_silence(motion, phonemes, slots, database.rest_coefficients, database.rate_hz)
    assert answer.motion.positions == pytest.approx(database.pca.positions(motion), abs=1e-4)


@pytest.mark.parametrize(
    "options", [{}, {"n_paths": 1, "silence": "cosine"}, {"jitter_window_s": 0.1, "lip_weight": 4}]
)
def test_strength_goes_straight_from_neutral_to_the_emotion(talking_database, options):
    database = talking_database(2, emotions=("neutral", "anger"))
    made = engine(database, **options)

    def positions(strength):
        return made.synthesise(speech(EmotionModifier(0.3, 0.75, "anger", strength))).motion.positions.astype(float)

    neutral, full = made.synthesise(speech()).motion.positions, positions(1.0)
    assert np.array_equal(positions(0.0), neutral)
    way = full - neutral
    assert np.abs(way).max() > 1.0
    strengths = [0.0, 0.1, 0.35, 0.6, 0.999]
    gone = [((positions(s) - neutral) * way).sum() / (way**2).sum() for s in strengths]
    assert gone == pytest.approx(strengths, abs=1e-3)
    for s in strengths:
        assert positions(s) == pytest.approx(neutral + s * way, abs=1e-3)


def test_strength_can_be_left_to_the_search(talking_database):
    database = talking_database(3, emotions=("neutral", "anger"))
    weak = speech(EmotionModifier(0.0, 2.0, "anger", 0.4))
    by_search = engine(database, emotion_strength=False, n_paths=1).synthesise(weak)
    by_blend = engine(database, n_paths=1).synthesise(weak)
    assert np.array_equal(by_search.path.nodes, by_blend.path.nodes)
    assert not np.allclose(by_search.motion.positions, by_blend.motion.positions, atol=0.1)


def test_a_blend_holds_to_its_pins(talking_database):
    database = talking_database(4)
    node = database.nodes.name(int(np.flatnonzero(database.nodes.phoneme == database.nodes.phoneme[3])[-1]))
    row = database.nodes.row(node)
    blend = engine(database, n_paths=5, silence="linear")
    answer = blend.synthesise(speech(pins={3: node}))
    assert answer.path.nodes[3] == row
    alone = engine(database, n_paths=1, silence="linear").synthesise(speech(pins={3: node}))
    middle = slice(answer.slots.start[3] + 4, answer.slots.stop[3] - 4)
    assert answer.motion.positions[middle] == pytest.approx(alone.motion.positions[middle], abs=1e-4)
    elsewhere = slice(answer.slots.start[1] + 3, answer.slots.stop[1] - 3)
    assert np.abs(answer.motion.positions[elsewhere] - alone.motion.positions[elsewhere]).max() > 0.05


def test_the_database_is_left_as_it_was_captured(talking_database):
    database = talking_database(5)
    before = database.frames.copy()
    made = engine(database, jitter_window_s=0.2, steady_sentences=True)
    made.synthesise(speech())
    assert np.array_equal(database.frames, before)
    assert not np.array_equal(made.frames, before)


def test_the_same_question_has_the_same_answer(talking_database):
    database = talking_database(6)
    one, other = (engine(database).synthesise(speech()).motion.positions for _ in range(2))
    assert np.array_equal(one, other)


@pytest.mark.parametrize(
    ("options", "said"), [({"silence": "none"}, "Silence is made"), ({"n_paths": 0}, "n_paths is 0"),
                          ({"temperature": float("nan")}, "temperature is nan"), ({"lip_weight": 0.0}, "lip_weight")],
)  # fmt: skip
def test_senseless_options_are_refused(options, said):
    with pytest.raises(UserFacingError, match=said):
        replace(PAPER, **options)
