"""A face that talks, captured by a program whose faults are known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

RATE_HZ = 60.0
N_MARKERS, N_RIGID = 24, 6


@pytest.fixture
def capture() -> Callable[..., np.ndarray]:
    """Return a function that makes a take, shape (n_frames, 24, 3), mm.

    The first six markers are rigid, the others move together in four ways; the head turns and shifts slowly.
    """

    def make(seed: int = 1, n_frames: int = 600, jitter_mm: float = 0.02) -> np.ndarray:
        rng = np.random.default_rng(seed)
        shape = np.random.default_rng(0)
        rest = shape.uniform(-60, 60, (N_MARKERS, 3)) * [1.0, 1.2, 0.4]
        ways = shape.normal(0, 1.5, (4, N_MARKERS, 3))
        ways[:, :N_RIGID] = 0.0
        strength = gaussian_filter1d(rng.normal(size=(n_frames, 4)), 5.0, axis=0)
        strength /= strength.std(axis=0)
        face = rest + np.einsum("fw,wkc->fkc", strength, ways) + rng.normal(0, jitter_mm, (n_frames, N_MARKERS, 3))
        turn = gaussian_filter1d(rng.normal(size=(n_frames, 3)), 30.0, axis=0)
        turn *= 0.1 / np.abs(turn).max()
        shift = gaussian_filter1d(rng.normal(size=(n_frames, 3)), 30.0, axis=0) * 60.0
        turns = Rotation.from_rotvec(turn).as_matrix()
        return np.einsum("fij,fkj->fki", turns, face) + shift[:, None]

    return make
