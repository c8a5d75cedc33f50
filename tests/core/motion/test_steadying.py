"""Jitter and offsets of sentences are taken out, speech is left."""

from __future__ import annotations

import numpy as np
import pytest

from core.motion.database import CapturedSentence
from core.motion.steadying import without_jitter, without_offsets
from core.speech.transcript import PhonemeUtterance, Transcript

RATE_HZ = 100.0
PHONES = ("pau", "aa", "b", "iy", "pau")


def sentences(*emotions, n_frames=100):
    """Sentences of five phones, each a fifth of the frames."""
    step_s = n_frames / RATE_HZ / 5
    spoken = tuple(PhonemeUtterance(p, i * step_s, (i + 1) * step_s) for i, p in enumerate(PHONES))
    transcript = Transcript(spoken, (), 5 * step_s)
    return [
        CapturedSentence(f"s{s}", emotion, "", s * n_frames, (s + 1) * n_frames, transcript)
        for s, emotion in enumerate(emotions)
    ]


def test_a_curve_of_order_2_is_kept_and_noise_is_not():
    rng = np.random.default_rng(1)
    t = np.arange(100)[:, None] / 50
    clean = np.concatenate([1 + 2 * t - t**2, 50 - t])
    noisy = clean + 0.1 * rng.normal(size=clean.shape)
    spoken = sentences("neutral", "neutral")
    assert without_jitter(clean, spoken, RATE_HZ, 0.2) == pytest.approx(clean)
    left = without_jitter(noisy, spoken, RATE_HZ, 0.2) - clean
    assert left.var() < 0.3 * 0.1**2
    # a window of 5 frames leaves 17/35 of the variance of white noise (Savitzky and Golay 1964, order 2)
    narrow = without_jitter(rng.normal(size=(100_000, 1)), sentences("neutral", n_frames=100_000), RATE_HZ, 0.04)
    assert narrow.var() == pytest.approx(17 / 35, rel=0.03)


def test_sentences_do_not_leak_into_each_other():
    frames = np.concatenate([np.zeros((100, 2)), np.ones((100, 2))])
    assert without_jitter(frames, sentences("neutral", "neutral"), RATE_HZ, 0.3) == pytest.approx(frames)


def test_a_sentence_shorter_than_the_window_is_left():
    frames = np.random.default_rng(2).normal(size=(10, 3)).astype(np.float32)
    steady = without_jitter(frames, sentences("neutral", n_frames=10), RATE_HZ, 0.2)
    assert np.array_equal(steady, frames) and steady.dtype == np.float32


def test_offsets_of_sentences_are_found_and_speech_stays():
    rng = np.random.default_rng(3)
    speech = rng.normal(size=(5, 4))[np.repeat(np.arange(5), 20)]
    offsets = rng.normal(size=(6, 4))
    frames = np.concatenate([speech + offset for offset in offsets])
    steady = without_offsets(frames, sentences(*["neutral"] * 6), RATE_HZ)
    for s in range(6):
        assert steady[100 * s : 100 * (s + 1)] == pytest.approx(speech + offsets.mean(axis=0))


def test_what_an_emotion_does_to_the_face_is_no_offset():
    rng = np.random.default_rng(4)
    speech = rng.normal(size=(5, 2))[np.repeat(np.arange(5), 20)]
    smile = np.array([3.0, -1.0])
    frames = np.concatenate([speech, speech + smile, speech, speech + smile])
    steady = without_offsets(frames, sentences("neutral", "happiness", "neutral", "happiness"), RATE_HZ)
    assert steady == pytest.approx(frames)
