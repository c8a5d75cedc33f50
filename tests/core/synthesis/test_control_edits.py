"""What is laid over control curves: smooth, local, and gone when it is taken away."""

from __future__ import annotations

import numpy as np
import pytest

from core.synthesis.control_edits import NO_CONTROL_EDITS, NO_CURVE_EDITS, ControlKey, CurveEdits

RATE_HZ = 100.0
WAVE = np.sin(np.arange(200) / 7.0) + 0.3 * np.random.default_rng(8).normal(size=200)


def test_a_key_adds_its_amount_at_its_time_half_at_half_its_reach_and_nothing_beyond():
    added = CurveEdits((ControlKey(1.0, 0.4, 0.2),)).applied(WAVE, RATE_HZ, 0.0) - WAVE
    assert added[100] == pytest.approx(0.4)
    assert added[[90, 110]] == pytest.approx(0.2)
    assert np.allclose(added[:80], 0) and np.allclose(added[121:], 0)
    # no corner anywhere: a raised cosine turns by at most amount (pi / reach)² / 2 a second squared
    assert np.abs(np.diff(added, 2)).max() <= 0.4 * (np.pi / 0.2) ** 2 / 2 / RATE_HZ**2 * 1.01


def test_a_smoothed_stretch_is_smoother_within_and_untouched_far_outside():
    smooth = CurveEdits(smoothed=((0.5, 1.0),)).applied(WAVE, RATE_HZ, 0.0)
    inside, outside = slice(50, 101), np.r_[0:44, 107:200]
    assert np.abs(np.diff(smooth[inside], 2)).mean() < 0.3 * np.abs(np.diff(WAVE[inside], 2)).mean()
    assert np.array_equal(smooth[outside], WAVE[outside])
    twice = CurveEdits(smoothed=((0.5, 1.0),) * 2).applied(WAVE, RATE_HZ, 0.0)
    assert np.abs(np.diff(twice[inside], 2)).mean() < np.abs(np.diff(smooth[inside], 2)).mean()


def test_a_muted_control_stays_at_rest_but_for_its_keys():
    assert np.all(CurveEdits(is_muted=True).applied(WAVE, RATE_HZ, 0.25) == 0.25)
    keyed = CurveEdits((ControlKey(1.0, 0.5, 0.1),), is_muted=True).applied(WAVE, RATE_HZ, 0.25)
    assert keyed[100] == pytest.approx(0.75) and keyed[0] == 0.25


def test_edits_that_are_taken_back_leave_no_trace():
    edits = NO_CONTROL_EDITS.with_keys("jawOpen", (ControlKey(1.0, 0.5, 0.1),)).muting("mouthClose", True)
    assert not edits.changes_nothing and edits.of("mouthClose").is_muted
    back = edits.with_keys("jawOpen", ()).with_control("mouthClose", NO_CURVE_EDITS)
    assert back.changes_nothing and back == NO_CONTROL_EDITS
