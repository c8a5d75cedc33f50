"""The classifier names what it should, and its interval is the textbook's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest

from core.evaluation.comparison import CapturedTruth
from core.evaluation.emotion_check import EmotionClassifier, tells_emotions, wilson_interval, windows


@pytest.mark.parametrize(("right", "n"), [(0, 5), (5, 5), (33, 33), (7, 20), (90, 108)])
def test_the_interval_is_wilsons(right, n):
    expected = binomtest(right, n).proportion_ci(0.95, "wilson")
    assert wilson_interval(right, n) == pytest.approx((expected.low, expected.high), abs=1e-12)


def test_windows_are_mean_and_spread_of_whole_seconds():
    track = np.random.default_rng(0).normal(size=(65, 2))
    found = windows(track, 30.0)
    assert len(found) == 2
    second = track[30:60]
    assert found[1] == pytest.approx([*second.mean(axis=0), *second.std(axis=0)])
    (short,) = windows(track[:12], 30.0)
    assert short[:2] == pytest.approx(track[:12].mean(axis=0))


def test_an_emotion_that_shows_is_recognised_and_one_that_does_not_is_not(mouth_database):
    """In a database whose anger lies 50 mm off along the first component, anger is what lies there."""
    off = np.zeros(mouth_database.pca.n_dims, np.float32)
    off[0] = 50.0
    frames = mouth_database.frames.copy()
    for sentence in mouth_database.sentences:
        if sentence.emotion == "anger":
            frames[sentence.start_frame : sentence.stop_frame] += off
    classifier = EmotionClassifier(replace(mouth_database, frames=frames))
    truths = [CapturedTruth.of(r, mouth_database) for r in mouth_database.held_out_recordings("test")]
    shift = (mouth_database.pca.basis @ off).reshape(-1, 3)
    shown = [(t, t.positions + (shift if t.recording.emotion == "anger" else 0)) for t in truths]
    assert classifier.recognition(shown)[:2] == (2, 1.0)
    assert classifier.recognition([(t, t.positions) for t in truths]).share == 0.5


def test_one_emotion_cannot_be_told_apart(mouth_database):
    assert tells_emotions(mouth_database)
    assert not tells_emotions(replace(mouth_database, sentences=mouth_database.sentences[:1]))
