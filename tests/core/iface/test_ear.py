"""What ears hear of which frames, and that they learn phones from sound."""

from __future__ import annotations

import dataclasses

import numpy as np

from core.iface.descent import DescentSettings
from core.iface.ear import ear_windows, fine_rows, phone_shares, shares
from core.iface.heard_takes import HeardTake
from core.iface.modern_face import n_told, told
from core.iface.modern_training import train_modern_face
from core.iface.perceptrons import Perceptron
from core.motion.marker_set import MarkerSet
from core.speech.phoneme import PHONEME_INDEX
from core.speech.transcript import PhonemeUtterance, Transcript
from tests.core.iface.quick_training import QUICK_MODERN


def _features(n_frames, seed=0):
    return np.random.default_rng(seed).normal(size=(n_frames, 70)).astype(np.float32)


def test_windows_are_laid_side_by_side_frame_by_frame():
    features = _features(9)
    fine, heard = fine_rows(features), ear_windows(fine_rows(features), 3)
    assert len(heard) == 5
    for f, row in enumerate(heard):
        last = 3 * (f + 2) + 2  # of the windows of frame f + 2
        np.testing.assert_array_equal(row.reshape(13, 20), fine[last - 6 : last + 7])
    np.testing.assert_array_equal(ear_windows(fine)[2::3], heard)


def test_shares_sum_to_one_and_are_averaged_over_ears():
    rng, features = np.random.default_rng(1), _features(11)
    ears = [
        Perceptron.of_layers([rng.normal(size=(260, 7))], [rng.normal(size=7)], "relu") for _ in range(2)
    ]  # fmt: skip
    found = phone_shares(ears, features)
    np.testing.assert_allclose(found.sum(axis=1), 1.0, atol=1e-5)
    outputs = ear_windows(fine_rows(features), 3)[3] @ ears[0].weights[0] + ears[0].offsets[0]
    alone = np.exp(outputs.astype(float)) / np.exp(outputs.astype(float)).sum()
    np.testing.assert_allclose(phone_shares(ears[:1], features)[3], alone, atol=1e-4)
    np.testing.assert_allclose(found, (phone_shares(ears[:1], features) + phone_shares(ears[1:], features)) / 2)
    np.testing.assert_allclose(shares(np.array([[1e4, 1e4, -1e4]])), [[0.5, 0.5, 0.0]])
    assert told(ears, features, 2).shape == (2, n_told(10, 7))


def test_phones_are_told_by_their_sound():
    """Two phones in turn, each with a spectrum of its own, a fifth to three fifths of a second each."""
    rng, takes = np.random.default_rng(2), []
    for t in range(6):
        bounds_s = np.cumsum(np.r_[0.0, rng.uniform(0.2, 0.6, 9)])
        names = [("aa", "m")[(i + t) % 2] for i in range(9)]
        said = [PhonemeUtterance(n, a, b) for n, a, b in zip(names, bounds_s, bounds_s[1:])]
        n_frames = int(bounds_s[-1] * 30)
        times_s = (np.arange(3 * n_frames) - 2) / 90
        which = np.array([names[min(8, max(0, int(np.searchsorted(bounds_s, s, "right")) - 1))] for s in times_s])
        fine = rng.normal(size=(3 * n_frames, 20)) + np.where(which == "m", 2.0, -2.0)[:, None]
        features = np.concatenate([rng.normal(size=(n_frames, 10)), fine.reshape(n_frames, 60)], axis=1)
        moved = np.where(which[2::3] == "m", 0.0, 5.0)[:, None, None] * np.array([[[0, 1, 0], [0, -1, 0]]])
        transcript = Transcript(tuple(said), (), float(bounds_s[-1]))
        features, moved, used = features.astype(np.float32), moved.astype(np.float32), np.ones(n_frames, bool)
        takes.append(HeardTake(str(t), "neutral", transcript, features, moved, used))
    markers = MarkerSet(("up", "low"), np.array([[0.0, 2, 0], [0, -2, 0]]), {}, {})
    settings = dataclasses.replace(QUICK_MODERN, loudness=0.0, ear=DescentSettings(20, batch=64))
    face = train_modern_face(takes[:5], markers, settings=settings)
    heard = takes[5].features
    found = phone_shares(face.ears, heard).argmax(axis=1)
    spoken = np.where(takes[5].displacements[2:-2, 0, 1] > 0, PHONEME_INDEX["aa"], PHONEME_INDEX["m"])
    assert (found == spoken).mean() > 0.9
    opening = face.motion(heard, {})[:, 0, 1] - 2
    assert np.abs(opening - takes[5].displacements[:, 0, 1]).mean() < 1.0
