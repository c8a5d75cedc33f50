"""Equation 7, its derivatives, and the shape that holds."""

from __future__ import annotations

import numpy as np
import pytest

from core.animeme.dominance import EPSILON_S, dominance, dominance_slopes, held


@pytest.fixture
def cases():
    rng = np.random.default_rng(3)
    n = 400
    return rng.uniform(-0.5, 0.5, n), rng.uniform(0.02, 0.6, n), rng.uniform(0.1, 3, n), rng.uniform(0.1, 3, n)


def test_inside_and_outside_are_what_the_paper_prints():
    d, keep, reach = 0.2, 0.8, 1.5
    inside = np.exp(-((0.05 / (d * keep + EPSILON_S)) ** 2))
    outside = np.exp(-((0.07 / (d * reach + EPSILON_S) + 0.1 / (d * keep + EPSILON_S)) ** 2))
    found = dominance(np.array([0.0, 0.05, -0.05, 0.17, -0.17]), d, keep, reach)
    np.testing.assert_allclose(found, [1.0, inside, inside, outside, outside], rtol=1e-12)


@pytest.mark.parametrize("spread", ["duration", "time"])
def test_derivatives_agree_with_finite_differences(cases, spread):
    offset_s, duration_s, keep, reach = cases
    slopes, h = dominance_slopes(offset_s, duration_s, keep, reach, spread), 1e-6
    np.testing.assert_array_equal(slopes.value, dominance(offset_s, duration_s, keep, reach, spread))
    for found, dk, dr in ((slopes.by_keep, h, 0.0), (slopes.by_reach, 0.0, h)):
        up = dominance(offset_s, duration_s, keep + dk, reach + dr, spread)
        down = dominance(offset_s, duration_s, keep - dk, reach - dr, spread)
        np.testing.assert_allclose(found, (up - down) / (2 * h), atol=1e-8)


@pytest.mark.parametrize("spread", ["duration", "time"])
def test_it_is_continuous_at_the_boundary_and_falls_away_from_the_centre(cases, spread):
    _, duration_s, keep, reach = cases
    sides = [dominance(duration_s / 2 + shift, duration_s, keep, reach, spread) for shift in (-1e-9, 1e-9)]
    np.testing.assert_allclose(*sides, atol=1e-6)
    away_s = np.linspace(0, 0.5, 200)[:, None]
    assert (np.diff(dominance(away_s, duration_s, keep, reach, spread), axis=0) <= 0).all()


def test_only_the_spread_in_durations_reaches_further_from_a_longer_phoneme():
    short, long = (
        [dominance(d / 2 + 0.1, d, 1.0, 1.0, spread) / dominance(d / 2, d, 1.0, 1.0, spread) for d in (0.05, 1.0)]
        for spread in ("time", "duration")
    )
    assert short[0] == pytest.approx(short[1], rel=0.05)
    assert long[1] > 10 * long[0]


def test_a_held_phoneme_stands_still_in_its_middle_and_keeps_its_edges():
    offset_s = np.linspace(-1.2, 1.2, 241)
    moved_s, kept_s = held(offset_s, np.full(241, 2.0), np.full(241, 0.4))
    np.testing.assert_allclose(kept_s, 0.4)
    middle = np.abs(offset_s) <= 0.8
    np.testing.assert_allclose(moved_s[middle], 0.0, atol=1e-12)
    np.testing.assert_allclose(moved_s[~middle], np.sign(offset_s[~middle]) * (np.abs(offset_s[~middle]) - 0.8))
    assert (dominance(moved_s, kept_s, 1.0, 1.0)[middle] == 1.0).all()


def test_a_phoneme_of_usual_length_is_not_held():
    offset_s = np.linspace(-0.5, 0.5, 11)
    moved_s, kept_s = held(offset_s, np.full(11, 0.3), np.full(11, 0.4))
    np.testing.assert_array_equal(moved_s, offset_s)
    np.testing.assert_array_equal(kept_s, 0.3)
