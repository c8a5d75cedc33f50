"""Jumps are found where they were put, and nowhere else."""

from __future__ import annotations

import numpy as np
import pytest

from core.suspicion.jumps import Jumps, jump_residuals

N_FRAMES, N_DIMS = 600, 4


@pytest.fixture
def smooth():
    """Slow waves with measurement noise of a hundredth."""
    rng = np.random.default_rng(3)
    times = np.arange(N_FRAMES)[:, None]
    waves = np.sin(2 * np.pi * times / np.array([90.0, 70.0, 130.0, 110.0]))
    return waves + rng.normal(0, 0.01, (N_FRAMES, N_DIMS))


def test_a_motion_of_constant_acceleration_leaves_no_residual():
    times = np.arange(50.0)[:, None]
    residuals = jump_residuals(3 + 2 * times + 0.1 * times**2, [(0, 50)])
    assert np.abs(residuals[3:48]).max() < 1e-9


@pytest.mark.parametrize("at", [40, 300, 555])
def test_a_lone_jump_is_found_where_it_is_with_its_size(smooth, at):
    smooth[at:] += np.array([0.5, 0.0, -0.3, 0.0])
    jumps = Jumps.find(smooth, [(0, N_FRAMES)])
    largest = jumps.size.argmax()
    assert jumps.at[largest] == at
    assert jumps.step[largest] == pytest.approx([0.5, 0.0, -0.3, 0.0], abs=0.05)
    # its neighbours carry no shadow of it
    near = np.abs(jumps.at - at) <= 2
    assert jumps.size[near & (jumps.at != at)].max(initial=0.0) < 0.1 * jumps.size[largest]


def test_a_break_between_two_pieces_is_no_jump(smooth):
    smooth[300:] += 2.0
    apart = Jumps.find(smooth, [(0, 300), (300, N_FRAMES)])
    assert 300 not in apart.at


@pytest.mark.parametrize("n_frames", [0, 1, 5, 8])
def test_pieces_too_short_to_tell_are_left_alone(n_frames):
    jumps = Jumps.find(np.ones((n_frames, N_DIMS)), [(0, n_frames)])
    assert len(jumps.at) == 0
    assert len(jumps.left) == n_frames + 1


def test_a_still_track_has_no_jumps():
    assert len(Jumps.find(np.zeros((200, 3)), [(0, 200)]).at) == 0
