"""Each measure beside the same figure worked out another way: loops, cases by hand, scipy, polynomials."""

from __future__ import annotations

import math
import statistics

import numpy as np
import pytest
from scipy.stats import pearsonr

from core.evaluation import measures
from core.speech.transcript import PhonemeUtterance, Transcript


@pytest.fixture
def pair():
    rng = np.random.default_rng(3)
    return rng.normal(size=(7, 4, 3)), rng.normal(size=(7, 4, 3))


def test_error_is_the_sum_of_equation_12(pair):
    synthesised, captured = pair
    total = 0.0
    for f in range(7):
        for k in range(4):
            total += math.dist(synthesised[f, k], captured[f, k]) ** 2
    assert measures.error_mm2(*pair) == pytest.approx(total / (7 * 4))
    assert measures.errors_per_frame_mm2(*pair).mean() == pytest.approx(total / (7 * 4))
    assert measures.errors_per_frame_mm2(*pair)[2] == pytest.approx(
        sum(math.dist(synthesised[2, k], captured[2, k]) ** 2 for k in range(4)) / 4
    )


def test_distance_is_the_mean_of_straight_lines(pair):
    synthesised, captured = pair
    lines = [math.dist(synthesised[f, k], captured[f, k]) for f in range(7) for k in range(4)]
    assert measures.distance_mm(*pair) == pytest.approx(statistics.mean(lines))
    shifted = captured + np.array([3.0, 4.0, 0.0])
    assert measures.distance_mm(shifted, captured) == pytest.approx(5.0)


def test_the_gap_is_vertical_and_opens_upwards():
    positions = np.zeros((2, 3, 3))
    positions[:, 1] = [[4, 10, 9], [-4, 12, 7]]
    positions[:, 2] = [[8, 3, 1], [0, 3, 0]]
    assert measures.lip_gap_mm(positions, 1, 2).tolist() == [7.0, 9.0]


def test_correlation_is_pearsons():
    rng = np.random.default_rng(4)
    a, b = rng.normal(size=50), rng.normal(size=50)
    assert measures.correlation(a, b) == pytest.approx(pearsonr(a, b).statistic)
    assert measures.correlation(3 * a + 1e3, a) == pytest.approx(1.0)
    assert measures.correlation(np.full(50, 7.1), a) == 0.0
    assert measures.correlation(np.full(50, 1e3) + 1e-13 * a, a) == 0.0


def test_light_smoothing_keeps_parabolas_and_fits_one_to_each_five_frames():
    t = np.arange(20.0)
    parabola = 2 - 3 * t + 0.25 * t**2
    assert measures.lightly_smoothed(parabola) == pytest.approx(parabola)
    noisy = parabola + np.random.default_rng(5).normal(size=20)
    fitted = np.polyval(np.polyfit(t[6:11], noisy[6:11], 2), t[8])
    assert measures.lightly_smoothed(noisy)[8] == pytest.approx(fitted)
    assert measures.lightly_smoothed(noisy[:3]).tolist() == noisy[:3].tolist()


def test_derivatives_of_a_parabola():
    t = np.arange(10) / 25.0
    track = 1 + 2 * t + 3 * t**2
    between = (t[1:] + t[:-1]) / 2
    assert measures.derivative(track, 25.0, 1) == pytest.approx(2 + 6 * between)
    assert measures.derivative(track, 25.0, 2) == pytest.approx(np.full(8, 6.0))
    assert measures.derivative(track, 25.0, 0).tolist() == track.tolist()


def test_variance_ratio_pools_the_variances_within_sentences():
    synthesised, captured = [[1.0, 3.0], [10.0, 10.0, 40.0]], [[5.0, 7.0], [0.0, 3.0, 0.0]]
    expected = (2 * statistics.pvariance([1, 3]) + 3 * statistics.pvariance([10, 10, 40])) / (
        2 * statistics.pvariance([5, 7]) + 3 * statistics.pvariance([0, 3, 0])
    )
    arrays = [[np.array(t) for t in tracks] for tracks in (synthesised, captured)]
    assert measures.variance_ratio(*arrays) == pytest.approx(expected)
    assert measures.variance_ratio(arrays[0], [np.zeros(2), np.ones(3)]) is None


def spoken(*phones):
    """Phones of 0.2 s each, at 10 frames a second: frames 2p to 2p + 2."""
    return Transcript(tuple(PhonemeUtterance(p, 0.2 * i, 0.2 * i + 0.2) for i, p in enumerate(phones)), (), 1.0)


def test_closures_by_hand():
    transcript = spoken("aa", "p", "aa", "b", "m")
    #                    aa        p         aa        b          m
    captured = np.array([9.0, 9.0, 9.0, 1.0, 9.0, 9.0, 9.0, 2.9, 9.0, 9.0, 9.0])
    synthesised = np.array([0.0, 9.0, 9.0, 2.5, 9.0, 9.0, 9.0, 3.5, 9.0, 0.0, 9.0])
    # the least is 1, so closed means up to 3: the capture closes p and b, but not m; the synthesis closes p, not b
    assert measures.closures(synthesised, captured, transcript, 10.0) == (2, 1)
    assert measures.closures(captured, captured, transcript, 10.0) == (2, 2)
    assert measures.closures(np.full(11, 5.0), captured, transcript, 10.0) == (2, 0)


def test_roughness_at_joins_by_hand():
    transcript = spoken("pau", "aa", "iy", "pau")  # one boundary between spoken phones, at frame 4
    still = np.zeros((9, 2, 3))
    assert measures.roughness_at_joins(still, transcript, 10.0) == (0.0, 0.0)
    jump = still.copy()
    jump[4:, :, 1] = 3.0  # 3 mm in one frame: no velocity on either side, +300 then -300 mm/s2
    assert measures.roughness_at_joins(jump, transcript, 10.0) == pytest.approx((0.0, 300.0))
    bend = still.copy()
    bend[4:, 0, 0] = np.arange(5)  # one of two markers sets off at 10 mm/s from frame 4
    assert measures.roughness_at_joins(bend, transcript, 10.0) == pytest.approx((5.0, 25.0))
    assert measures.roughness_at_joins(jump, spoken("pau", "aa", "pau", "iy"), 10.0) is None


def test_steady_motion_is_smooth_at_joins():
    t = np.arange(20)[:, None, None] * np.ones((1, 3, 3))
    assert measures.roughness_at_joins(5 * t, spoken("aa", "iy", "aa"), 10.0) == pytest.approx((0.0, 0.0))
