"""The blend: shares by cost, and only where a marker belongs to speech."""

import numpy as np
import pytest

from core.motion.marker_set import MarkerSet
from core.synthesis.blend import blend_shares, blended, spoken_share


def test_shares_fall_by_e_with_each_temperature():
    shares = blend_shares([5.0, 7.0, 9.0], 2.0)
    assert shares.sum() == pytest.approx(1.0)
    assert shares[1:] / shares[:-1] == pytest.approx([np.exp(-1), np.exp(-1)])
    assert blend_shares([1e9, 1e9 + 1], 1e-3) == pytest.approx([1.0, 0.0])
    assert blend_shares([3.0, 3.0, 4.0], 0.0) == pytest.approx([0.5, 0.5, 0.0])


def test_markers_of_speech_are_averaged_and_the_others_stay():
    motions = np.random.default_rng(1).normal(size=(3, 10, 4, 3))
    shares = np.array([0.5, 0.3, 0.2])
    made = blended(motions, shares, np.array([1.0, 0.0, 0.5, 1.0]))
    mean = np.average(motions, axis=0, weights=shares)
    assert made[:, [0, 3]] == pytest.approx(mean[:, [0, 3]])
    assert np.array_equal(made[:, 1], motions[0][:, 1])
    assert made[:, 2] == pytest.approx((mean[:, 2] + motions[0][:, 2]) / 2)


def test_the_mean_of_captures_with_chance_of_their_own_is_nearer_to_the_truth():
    rng = np.random.default_rng(2)
    truth = rng.normal(size=(200, 5, 3))
    motions = truth + rng.normal(size=(8, 200, 5, 3))
    error = [((m - truth) ** 2).mean() for m in (motions[0], blended(motions, np.full(8, 1 / 8), np.ones(5)))]
    assert error[1] == pytest.approx(error[0] / 8, rel=0.15)


def test_speech_ends_at_the_eyes():
    rest = np.array([[0, 0, 0], [40, 30, 0], [-40, 30, 0], [0, -40, 0], [0, 60, 0], [20, 15, 0]], float)
    landmarks = {"nose_tip": "tip", "inner_eye_left": "l", "inner_eye_right": "r"}
    markers = MarkerSet(("tip", "l", "r", "lip", "brow", "cheek"), rest, {}, landmarks)
    assert spoken_share(markers) == pytest.approx([1, 0, 0, 1, 0, 0.5])
    assert spoken_share(MarkerSet(markers.names, rest)).all()
