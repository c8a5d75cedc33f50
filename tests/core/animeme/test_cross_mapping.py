"""Bounded least squares beside scipy's, and captured markers on a rig that is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear, nnls

from core.animeme.cross_mapping import bounded_least_squares, solve_controls, solve_shares


@pytest.mark.parametrize(("n_basis", "n_dims"), [(3, 20), (12, 30), (30, 40)])
def test_non_negative_shares_are_those_of_scipy(n_basis, n_dims):
    rng = np.random.default_rng(n_basis)
    shapes, frames = rng.normal(size=(n_basis, n_dims // 2, 3)), rng.normal(size=(60, n_dims // 2, 3))
    found = solve_shares(frames, shapes)
    for share, frame in zip(found, frames):
        np.testing.assert_allclose(share, nnls(shapes.reshape(n_basis, -1).T, frame.ravel())[0], atol=1e-7)


@pytest.mark.parametrize("ridge", [0.0, 0.3])
@pytest.mark.parametrize("n_basis", [2, 8, 40])
def test_bounded_controls_are_those_of_scipy(n_basis, ridge):
    rng = np.random.default_rng(7)
    basis = rng.normal(size=(n_basis, 60)) * rng.uniform(0.1, 10, (n_basis, 1))
    targets = rng.normal(size=(50, 60)) * 5
    found = bounded_least_squares(basis, targets, ridge)
    matrix = np.vstack([basis.T, np.sqrt(ridge) * np.eye(n_basis)])
    for x, target in zip(found, targets):
        wanted = lsq_linear(matrix, np.r_[target, np.zeros(n_basis)], (0, 1), method="bvls", tol=1e-14).x
        np.testing.assert_allclose(x, wanted, atol=1e-6)


def test_nearly_equal_units_share_and_never_leave_the_bounds():
    rng = np.random.default_rng(1)
    unit = rng.normal(size=(10, 3))
    units = np.stack([unit, unit + 1e-6 * rng.normal(size=(10, 3))])
    found = solve_controls(np.stack([0.8 * unit, 5.0 * unit, -unit]), units)
    np.testing.assert_allclose(found, [[0.4, 0.4], [1.0, 1.0], [0.0, 0.0]], atol=0.02)
    assert found.min() >= 0.0 and found.max() <= 1.0


def test_controls_that_were_set_are_found_again():
    rng = np.random.default_rng(4)
    units = rng.normal(size=(20, 40, 3))
    controls = np.clip(rng.uniform(-0.5, 1.5, (300, 20)), 0, 1)
    moved = np.einsum("fu,ukd->fkd", controls, units)
    np.testing.assert_allclose(solve_controls(moved, units, 0.0), controls, atol=1e-8)


def test_a_unit_that_moves_no_marker_stays_at_rest():
    rng = np.random.default_rng(5)
    units = rng.normal(size=(4, 10, 3))
    units[2] = 0.0
    assert not solve_controls(rng.normal(size=(20, 10, 3)), units)[:, 2].any()


def test_no_frame_and_no_moving_unit_are_no_trouble():
    assert solve_controls(np.zeros((0, 5, 3)), np.ones((2, 5, 3))).shape == (0, 2)
    assert not solve_controls(np.ones((3, 5, 3)), np.zeros((2, 5, 3))).any()
