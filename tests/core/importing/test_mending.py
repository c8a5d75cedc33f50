"""Planted faults are found, named and undone; what is sound stays as it was, to the bit."""

from __future__ import annotations

import numpy as np
import pytest

from core.importing.mending import GAP, LONG_GAP, SPIKE, SWAP, mend
from core.importing.plan import MendLimits
from core.motion.motion_files import read_motion

RATE_HZ = 60.0
NAMES = tuple(f"m{k}" for k in range(24))
RIGID = range(6)


def _told(mended, kind):
    return [(row.marker, row.other, row.start, row.stop) for row in mended.rows if row.kind == kind]


def test_sound_motion_is_left_alone(capture):
    take = capture()
    mended = mend(take, NAMES, RATE_HZ, rigid=RIGID)
    assert mended.rows == ()
    assert np.array_equal(mended.positions, take)


def test_a_spike_is_cut_and_filled(capture):
    take = capture()
    hurt = take.copy()
    hurt[200:202, 9] += [6.0, -5.0, 3.0]
    mended = mend(hurt, NAMES, RATE_HZ, rigid=RIGID)
    assert _told(mended, SPIKE) == [("m9", "", 200, 202)]
    assert mended.rows[0].size_mm == pytest.approx(np.sqrt(70.0), abs=0.5)
    assert np.linalg.norm(mended.positions - take, axis=2).max() < 0.5


@pytest.mark.parametrize("length", [1, 5, 40, 200])
def test_a_swap_is_undone_to_the_bit(capture, length):
    take = capture()
    hurt = take.copy()
    hurt[100 : 100 + length, [8, 15]] = take[100 : 100 + length, [15, 8]]
    mended = mend(hurt, NAMES, RATE_HZ, rigid=RIGID)
    assert _told(mended, SWAP) == [("m8", "m15", 100, 100 + length)]
    assert np.array_equal(mended.positions, take)


def test_a_swap_that_never_ends_is_told_by_the_longer_part(capture):
    take = capture()
    hurt = take.copy()
    hurt[450:, [8, 15]] = take[450:, [15, 8]]
    assert np.array_equal(mend(hurt, NAMES, RATE_HZ, rigid=RIGID).positions, take)


def test_three_markers_that_change_names_in_turn_are_put_right(capture):
    take = capture()
    hurt = take.copy()
    hurt[100:160, [8, 15]] = take[100:160, [15, 8]]
    hurt[220:300, [15, 20]] = take[220:300, [20, 15]]
    mended = mend(hurt, NAMES, RATE_HZ, rigid=RIGID)
    assert mended.count(SWAP) == 2
    assert np.array_equal(mended.positions, take)


def test_markers_that_vanish_and_come_back_swapped_are_put_right(capture):
    take = capture()
    hurt = take.copy()
    hurt[150:400, [8, 15]] = take[150:400, [15, 8]]
    hurt[146:152, 8] = hurt[147:151, 15] = hurt[398:402, [8, 15]] = np.nan
    mended = mend(hurt, NAMES, RATE_HZ, rigid=RIGID)
    known = np.isfinite(hurt[:, 8]).all(axis=1) & np.isfinite(hurt[:, 15]).all(axis=1)
    assert np.array_equal(mended.positions[known], take[known])


def test_gaps_are_filled_up_to_the_limit(capture):
    take = capture()
    hurt = take.copy()
    hurt[50:60, 9] = hurt[300:340, 10] = np.nan
    mended = mend(hurt, NAMES, RATE_HZ, MendLimits(longest_gap_s=0.5), RIGID)
    assert _told(mended, GAP) == [("m9", "", 50, 60)]
    assert _told(mended, LONG_GAP) == [("m10", "", 300, 340)]
    assert mended.samples(GAP) == 10
    assert np.isnan(mended.positions[300:340, 10]).all()


def test_faults_can_be_left_alone(capture):
    hurt = capture()
    hurt[200, 9] += 20.0
    mended = mend(hurt, NAMES, RATE_HZ, MendLimits(faults=False), RIGID)
    assert mended.rows == ()
    assert np.array_equal(mended.positions, hurt)


def test_a_take_of_nothing_is_no_trouble():
    for n_frames in (1, 3, 8):
        mended = mend(np.full((n_frames, 24, 3), np.nan), NAMES, RATE_HZ, rigid=RIGID)
        assert mended.count(LONG_GAP) == 24


def test_faults_put_into_a_real_take_are_found(shared_data):
    """Cheek exercises: 16 spikes of 3 to 25 mm and 6 swaps of neighbours, all found, none made up."""
    take, names, rate_hz = read_motion(shared_data("animface-mocap") / "Cheeks.c3d")
    take = take.astype(float)
    rng = np.random.default_rng(21)
    hurt, middle = take.copy(), take.mean(axis=0)
    starts = 30 + 60 * np.arange(22)
    rng.shuffle(starts)
    for start in starts[:16]:
        push = rng.normal(size=3)
        hurt[start : start + rng.integers(1, 3), rng.integers(len(names))] += (
            rng.uniform(3, 25) * push / np.linalg.norm(push)
        )
    for start in starts[16:]:
        a = rng.integers(len(names))
        b = np.argsort(np.linalg.norm(middle - middle[a], axis=1))[1]
        stop = start + rng.integers(4, 50)
        hurt[start:stop, [a, b]] = hurt[start:stop, [b, a]]
    mended = mend(hurt, names, rate_hz)
    assert (mended.count(SPIKE), mended.count(SWAP)) == (16, 6)
    assert np.linalg.norm(mended.positions - take, axis=2).max() < 1.5
