"""Equations 6 to 8, by hand and beside numpy's own correlation."""

from __future__ import annotations

import numpy as np
import pytest

from core.iface.measures import Nearness, largest_displacements, nearness


def of(*columns):
    """One point; a column an axis."""
    return np.array(columns, float).T[:, None, :]


def test_a_case_by_hand():
    # two points on one axis
    captured = np.array([[[1.0], [0.0]], [[-1.0], [2.0]]])
    estimated = np.array([[[1.0], [1.0]], [[-1.0], [1.0]]])
    found = nearness(captured, estimated, np.ones(2))
    # C_dd = diag (1, 1), C_d'd' = diag (1, 0), tr C_dd' = 1
    assert found.r == pytest.approx(1 / np.sqrt(2))
    assert (found.spread, found.spread_estimated) == (1.0, 0.5)
    assert found.mse == 0.5  # (0 + 1 + 0 + 1) / 4


def test_of_one_coordinate_r_is_pearsons_and_the_spread_its_standard_deviation():
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 50))
    found = nearness(of(a), of(b + 3.0), np.array([2.0]))
    assert found.r == pytest.approx(np.corrcoef(a, b)[0, 1])
    assert found.spread == pytest.approx(a.std() / 2) and found.spread_estimated == pytest.approx(b.std() / 2)
    assert found.mse == pytest.approx(((a - b - 3.0) ** 2).mean() / 4)


def test_it_is_the_covariances_of_the_equations():
    """Matrices as printed, whole, on three points in space."""
    rng = np.random.default_rng(2)
    captured = rng.normal(size=(40, 3, 3))
    estimated = 0.5 * captured + rng.normal(size=captured.shape) + 1.0
    largest = np.array([1.0, 2.0, 4.0])
    d, e = ((moved / largest[None, :, None]).reshape(40, 9) for moved in (captured, estimated))
    both = np.cov(np.hstack([d, e]), rowvar=False, bias=True)
    r = np.trace(both[:9, 9:]) / np.sqrt(np.trace(both[:9, :9]) * np.trace(both[9:, 9:]))
    wanted = Nearness(r, np.sqrt(np.diag(both)[:9]).mean(), np.sqrt(np.diag(both)[9:]).mean(),
                      (np.linalg.norm(d - e, axis=1) ** 2).mean() / 9)  # fmt: skip
    assert nearness(captured, estimated, largest) == pytest.approx(wanted)


def test_scale_and_offset_of_an_estimate_leave_r_but_not_the_error():
    rng = np.random.default_rng(3)
    captured = rng.normal(size=(30, 4, 3))
    largest = largest_displacements(captured)
    same, halved = nearness(captured, captured, largest), nearness(captured, captured / 2 + 1.0, largest)
    assert same.r == pytest.approx(1.0) and same.mse == 0.0
    assert halved.r == pytest.approx(1.0) and halved.mse > 0.0
    assert halved.spread_estimated == pytest.approx(same.spread / 2)


def test_a_face_that_holds_still_correlates_with_nothing():
    captured = np.random.default_rng(4).normal(size=(30, 4, 3))
    still = np.full_like(captured, 0.1)
    found = nearness(captured, still, largest_displacements(captured))
    assert found.r == 0.0 and found.spread_estimated == pytest.approx(0.0, abs=1e-12) and found.mse > 0.0


def test_points_are_divided_by_the_longest_way_they_go():
    moved = np.zeros((3, 2, 3))
    moved[1, 0] = 0.0, 3.0, 4.0
    moved[2, 0] = -1.0, 0.0, 0.0
    np.testing.assert_array_equal(largest_displacements(moved), [5.0, np.inf])


def test_rounding_of_a_point_at_rest_is_no_motion():
    captured = np.random.default_rng(5).normal(size=(30, 2, 3))
    captured[:, 1] *= 1e-13
    largest = largest_displacements(captured)
    estimated = captured.copy()
    estimated[:, 1] *= -1.0
    assert nearness(captured, estimated, largest).r == pytest.approx(1.0)


def test_what_does_not_match_is_refused():
    with pytest.raises(ValueError, match="compared"):
        nearness(np.zeros((3, 2, 3)), np.zeros((4, 2, 3)), np.ones(2))
    with pytest.raises(ValueError, match="compared"):
        nearness(np.zeros((0, 2, 3)), np.zeros((0, 2, 3)), np.ones(2))
