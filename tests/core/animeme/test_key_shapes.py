"""Affinity propagation finds the shapes that lips go back to."""

from __future__ import annotations

import numpy as np
import pytest

from core.animeme.key_shapes import key_lip_shapes
from core.errors import UserFacingError


def test_each_of_five_shapes_has_one_exemplar():
    rng = np.random.default_rng(2)
    shapes = rng.normal(size=(5, 6, 3)) * 10
    which = rng.integers(5, size=200)
    lips = shapes[which] + 0.1 * rng.normal(size=(200, 6, 3))
    assert sorted(which[key_lip_shapes(lips, 5)]) == [0, 1, 2, 3, 4]


def test_the_same_seed_chooses_the_same_frames_in_order():
    lips = np.random.default_rng(3).normal(size=(900, 4, 3))
    frames = key_lip_shapes(lips, 6)
    assert (np.diff(frames) > 0).all()
    np.testing.assert_array_equal(frames, key_lip_shapes(lips, 6))


def test_lips_that_do_not_move_are_told():
    with pytest.raises(UserFacingError, match="do not move enough"):
        key_lip_shapes(np.zeros((50, 4, 3)), 5)


def test_lips_that_move_along_a_line_give_a_few_shapes_too():
    times_s = np.arange(84) / 60.0
    along = np.concatenate([4 + 3 * np.sin(2 * np.pi * 3 * times_s + s) + s % 4 for s in range(8)])
    along -= along.min()
    lips = np.zeros((len(along), 2, 3))
    lips[:, 1, 1] = -along
    frames = key_lip_shapes(lips, 3)
    assert 2 <= len(frames) <= 6
    assert np.ptp(along[frames]) > 3
