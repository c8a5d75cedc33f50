"""The plain rivals do what their names say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.evaluation.engines.phone_means import PhoneMeans
from core.evaluation.engines.random_nodes import RandomNodes
from core.evaluation.engines.static_face import StaticFace
from core.search.compute import NumpyKernels
from core.search.engine import SearchEngine
from core.speech.emotion import EMOTIONS, EmotionModifier
from core.speech.phoneme import PHONEME_INDEX, PHONEMES
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.engine import SpeechInput


def speech(*phones, emotion="neutral"):
    spoken = tuple(PhonemeUtterance(p, 0.25 * i, 0.25 * i + 0.25) for i, p in enumerate(phones))
    duration_s = 0.25 * len(phones)
    return SpeechInput(Transcript(spoken, (), duration_s), [EmotionModifier(0.0, duration_s, emotion)])


def test_the_static_face_is_the_mean_of_what_was_captured(mouth_database):
    motion = StaticFace(mouth_database).synthesise(speech("aa", "b")).motion
    captured = mouth_database.pca.positions(mouth_database.frames)
    assert motion.positions.shape == (60, 6, 3)
    assert motion.positions == pytest.approx(np.repeat(captured.mean(axis=0)[None], 60, axis=0), abs=0.02)


@pytest.mark.parametrize("emotion", ["neutral", "anger"])
def test_phone_means_pass_through_the_mean_of_their_phone_and_emotion_at_its_middle(mouth_database, emotion):
    motion = PhoneMeans(mouth_database).synthesise(speech("k", "aa", "iy", emotion=emotion)).motion
    nodes = mouth_database.nodes
    for middle, phone in ((15, "k"), (45, "aa"), (75, "iy")):
        frames = [
            mouth_database.frames[(nodes.start[n] + nodes.stop[n] - 1) // 2]
            for n in range(len(nodes))
            if nodes[n].phone == phone and nodes[n].emotion == emotion
        ]
        mean = mouth_database.pca.positions(np.mean(frames, axis=0, dtype=float))
        assert motion.positions[middle] == pytest.approx(mean, abs=0.01)
    between = (motion.positions[45] + motion.positions[75]) / 2
    assert motion.positions[60] == pytest.approx(between, abs=1e-3)
    assert np.array_equal(motion.positions[0], motion.positions[15])


def test_phone_means_stand_in_for_what_was_never_said(mouth_database):
    rest = mouth_database.markers.rest
    engine = PhoneMeans(mouth_database)
    # /ae/ looks like /aa/; nothing looks like /hh/; nobody was happy
    means = {phone: engine.synthesise(speech(phone)).motion.positions[0] for phone in ("aa", "ae", "hh")}
    assert np.array_equal(means["ae"], means["aa"])
    assert means["hh"] == pytest.approx(rest, abs=0.5)
    happy = engine.synthesise(speech("aa", emotion="happiness")).motion.positions[0]
    gaps = [face[3, 1] - face[4, 1] for face in (means["aa"], happy)]
    angry = engine.synthesise(speech("aa", emotion="anger")).motion.positions[0]
    assert gaps[0] < gaps[1] < angry[3, 1] - angry[4, 1]


def test_random_nodes_are_of_the_phone_and_the_emotion(mouth_database):
    search = SearchEngine(mouth_database, NumpyKernels())
    drawn = []
    search.motion_of = lambda path, phonemes, slots: drawn.append((path, phonemes))
    for _ in range(20):
        RandomNodes(search, seed=len(drawn)).synthesise(speech("aa", "b", "k", emotion="anger"))
    for path, phonemes in drawn:
        assert np.array_equal(mouth_database.nodes.phoneme[path], phonemes)
        assert set(mouth_database.nodes.emotion[path]) == {EMOTIONS.index("anger")}
    assert len({path[0] for path, _ in drawn}) > 5
    RandomNodes(search).synthesise(speech("ae", "hh", "pau", emotion="sadness"))
    path, phonemes = drawn[-1]
    assert PHONEMES[mouth_database.nodes.phoneme[path[0]]] == "aa"
    assert phonemes[1] == PHONEME_INDEX["hh"]


def test_random_nodes_move_and_the_seed_says_how(mouth_database):
    search = SearchEngine(mouth_database, NumpyKernels())
    motions = [RandomNodes(search, seed).synthesise(speech("aa", "k", "iy")).motion.positions for seed in (1, 1, 2)]
    assert np.array_equal(motions[0], motions[1]) and not np.array_equal(motions[0], motions[2])


def test_speech_shorter_than_a_frame_still_has_one(mouth_database):
    blink = replace(speech("aa"), transcript=Transcript((PhonemeUtterance("aa", 0.0, 0.003),), (), 0.003))
    engines = (StaticFace(mouth_database), PhoneMeans(mouth_database),
               RandomNodes(SearchEngine(mouth_database, NumpyKernels())))  # fmt: skip
    for engine in engines:
        assert engine.synthesise(blink).motion.positions.shape == (1, 6, 3)
