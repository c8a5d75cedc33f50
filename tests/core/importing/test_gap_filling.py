"""A filled gap meets what was seen on both sides, follows what the other markers say, and is never too long."""

from __future__ import annotations

import numpy as np
import pytest

from core.importing.gap_filling import Gap, fill_gaps_by_pose, find_gaps, jitter_mm
from core.importing.pose_model import PoseModel
from core.motion.motion_files import read_motion

RATE_HZ = 60.0
RIGID = np.arange(6)


def test_gaps_are_found_as_they_were_cut(capture):
    take = capture(n_frames=40)
    take[0:3, 2] = take[10:11, 5] = take[35:, 5] = np.nan
    assert find_gaps(take) == [Gap(2, 0, 3), Gap(5, 10, 11), Gap(5, 35, 40)]


def test_the_expectation_is_the_conditional_mean_written_out(capture):
    """Of a head that is at rest: brute force by inverting the joint covariance (precision matrix form)."""
    rng = np.random.default_rng(2)
    mean, factor = rng.uniform(-50, 50, (5, 3)), rng.normal(size=(15, 15))
    covariance = factor @ factor.T
    covariance[:9] = covariance[:, :9] = 0.0
    covariance[:9, :9] = 1e-9 * np.eye(9)
    rigid = np.arange(3)
    model = PoseModel(mean, covariance, rigid, noise_mm2=0.0)
    frames = mean[None] + np.concatenate([np.zeros((7, 3, 3)), rng.normal(size=(7, 2, 3))], axis=1)
    expected = model.expected(frames, np.arange(4), 4)
    precision = np.linalg.inv(covariance)
    seen, gone = np.arange(12), np.arange(12, 15)
    off = (frames - mean).reshape(7, 15)[:, seen]
    brute = mean[4] - off @ (np.linalg.inv(precision[np.ix_(gone, gone)]) @ precision[np.ix_(gone, seen)]).T
    assert np.allclose(expected, brute, atol=1e-6)


@pytest.mark.parametrize("length", [1, 4, 20])
def test_both_ends_are_met(capture, length):
    """The step into and out of the gap is no larger than the steps that the marker really took there."""
    take = capture(jitter_mm=0.0)
    cut = take.copy()
    cut[100 : 100 + length, 12] = np.nan
    filled, done, left = fill_gaps_by_pose(cut, RATE_HZ, 0.5, PoseModel.fit([(cut, RATE_HZ)], RIGID))
    assert len(done) == 1
    assert not left
    untouched = np.isfinite(cut).all(axis=2)
    assert np.array_equal(filled[untouched], take[untouched])
    steps = np.linalg.norm(np.diff(filled[90 : 115 + length, 12], axis=0), axis=1)
    real = np.linalg.norm(np.diff(take[90 : 115 + length, 12], axis=0), axis=1)
    assert np.abs(steps - real).max() < 0.3


def test_markers_that_move_with_the_rest_are_known_from_it(capture):
    """Four ways of moving, twenty-three markers seen: a gap of a third of a second is filled to the jitter."""
    take = capture()
    cut = take.copy()
    for k, start in ((8, 50), (12, 200), (20, 333)):
        cut[start : start + 20, k] = np.nan
    filled, _, _ = fill_gaps_by_pose(cut, RATE_HZ, 0.5, PoseModel.fit([(cut, RATE_HZ)], RIGID))
    missing = np.isnan(cut).any(axis=2)
    assert np.linalg.norm((filled - take)[missing], axis=1).max() < 0.5
    alone, _, _ = fill_gaps_by_pose(cut, RATE_HZ, 0.5, None)
    assert np.linalg.norm((alone - take)[missing], axis=1).max() > 2.0


def test_long_gaps_and_those_without_an_end_stay_open(capture):
    take = capture(n_frames=100)
    take[10:31, 8] = take[50:70, 9] = take[95:, 10] = np.nan
    filled, done, left = fill_gaps_by_pose(take, RATE_HZ, 20 / RATE_HZ, None)
    assert done == [Gap(9, 50, 70)]
    assert left == [Gap(8, 10, 31), Gap(10, 95, 100)]
    assert np.isnan(filled[10:31, 8]).all()


def test_islands_between_gaps_are_no_hindrance(capture):
    take = capture(n_frames=60)
    cut = take.copy()
    cut[20:24, 8] = cut[25:30, 8] = cut[31:35, 8] = np.nan
    filled, done, _ = fill_gaps_by_pose(cut, RATE_HZ, 0.5, None)
    assert len(done) == 3
    assert np.linalg.norm(filled - take, axis=2).max() < 5.0


def test_jitter_is_measured_as_it_was_made():
    rng = np.random.default_rng(5)
    smooth = np.sin(np.arange(2000)[:, None] / 30.0) * [10.0, 5.0, 2.0]
    assert jitter_mm(smooth + rng.normal(0, 0.2, smooth.shape)) == pytest.approx(0.2, rel=0.1)
    assert jitter_mm(np.full((2, 3), np.nan)) == 0.0


def test_long_gaps_of_a_real_face_are_filled_better_than_by_a_line(shared_data):
    """Jaw exercises, 30 gaps of half a second: the error is well below linear interpolation's."""
    take, names, rate_hz = read_motion(shared_data("animface-mocap") / "Jaw.c3d")
    take = take.astype(float)
    rng = np.random.default_rng(11)
    cut = take.copy()
    for _ in range(30):
        k, start = rng.integers(len(names)), rng.integers(20, len(take) - 60)
        if np.isfinite(cut[start - 10 : start + 40, k]).all():
            cut[start : start + 30, k] = np.nan
    rigid = np.array(
        [names.index(n) for n in ("NoseTop", "Leye_Inside", "Reye_Inside", "Leye_Outside", "Reye_Outside")]
    )
    filled, _, left = fill_gaps_by_pose(cut, rate_hz, 0.5, PoseModel.fit([(cut, rate_hz)], rigid))
    assert not left
    missing = np.isnan(cut).any(axis=2)
    line, frames = take.copy(), np.arange(len(take))
    for k in np.flatnonzero(missing.any(axis=0)):
        seen = ~missing[:, k]
        line[~seen, k] = np.stack([np.interp(frames[~seen], frames[seen], take[seen, k, d]) for d in range(3)], axis=1)
    error, of_line = (np.sqrt((np.linalg.norm((t - take)[missing], axis=1) ** 2).mean()) for t in (filled, line))
    assert error < 0.7 * of_line
