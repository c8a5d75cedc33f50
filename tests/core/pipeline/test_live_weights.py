"""Frame by frame, warm from the last, the controls are the optimum of the whole-take solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from core.animeme.cross_mapping import RIDGE_MM2, solve_controls
from core.pipeline import live_weights
from core.pipeline.live_weights import LiveWeights


@pytest.fixture
def units(monkeypatch):
    """Twelve units of nine markers, one of which moves none."""
    rng = np.random.default_rng(8)
    shapes = rng.normal(size=(12, 9, 3)) * rng.uniform(0.5, 8, (12, 1, 1))
    shapes[5] = 0.0
    names = tuple(f"unit{u}" for u in range(12))
    monkeypatch.setattr(live_weights, "units_at_markers", lambda face, markers: (names, shapes))
    return shapes


def test_each_frame_is_the_optimum_within_bounds(units):
    rng = np.random.default_rng(9)
    weights = LiveWeights(None, None)
    wanted = np.cumsum(rng.normal(size=(120, 12)) * 0.15, axis=0)  # wanders far out of 0..1
    moved = np.einsum("fu,ukx->fkx", wanted, units) + 0.2 * rng.normal(size=(120, 9, 3))
    got = np.array([weights.solve(frame) for frame in moved])
    assert got.min() >= 0.0 and got.max() <= 1.0 and not got[:, 5].any()
    assert (got == 0.0).any() and (got == 1.0).any()
    others = np.arange(12) != 5
    np.testing.assert_allclose(got[:, others], solve_controls(moved, units)[:, others], atol=1e-6)
    root = np.sqrt(RIDGE_MM2 * 9)
    for f in (0, 50, 119):
        tall = np.vstack([units.reshape(12, -1).T, root * np.eye(12)])
        found = lsq_linear(tall, np.r_[moved[f].ravel(), np.zeros(12)], (0, 1), tol=1e-12)
        np.testing.assert_allclose(got[f, others], found.x[others], atol=1e-4)
