"""Distances that favour the lips, against marker positions."""

import numpy as np
import pytest

from core.motion.marker_set import MarkerSet
from core.motion.pca import MotionPca
from core.search.lip_weight import pose_metric


@pytest.mark.parametrize("lip_weight", [0.2, 1.0, 7.0])
def test_lengths_are_weighted_marker_distances(lip_weight):
    rng = np.random.default_rng(4)
    markers = MarkerSet(tuple("abcdef"), rng.normal(size=(6, 3)), {"lips": ("b", "e")})
    pca = MotionPca.fit([rng.normal(size=(50, 6, 3))], 7)
    one, other = rng.normal(size=(2, 7))
    metric = pose_metric(pca, markers, lip_weight)
    weights = np.array([1, lip_weight, 1, 1, lip_weight, 1])
    apart = ((pca.positions(one) - pca.positions(other)) ** 2).sum(axis=1)
    expected = (weights / weights.mean() * apart).sum()
    assert (((one - other) @ metric) ** 2).sum() == pytest.approx(expected)
    if lip_weight == 1.0:
        assert metric == pytest.approx(np.eye(7), abs=1e-12)


def test_lips_cannot_weigh_nothing():
    with pytest.raises(ValueError, match="cannot weigh"):
        pose_metric(None, None, 0.0)
