"""Neighbour preservation, against scikit-learn and by hand."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.manifold import trustworthiness
from sklearn.neighbors import NearestNeighbors

from core.manifold.preservation import NeighbourPreservation


@pytest.fixture
def roll():
    """A rolled-up sheet and two maps of it: unrolled, and seen from above."""
    rng = np.random.default_rng(5)
    along, across = rng.uniform(4, 12, 400), rng.uniform(0, 6, 400)
    rolled = np.column_stack([along * np.cos(along), across, along * np.sin(along)])
    return rolled, np.column_stack([along**2 / 2, across]), rolled[:, :2]


@pytest.mark.parametrize("k", [5, 12])
def test_figures_are_those_of_scikit_learn(roll, k):
    rolled, _, above = roll
    found = NeighbourPreservation.of(rolled, above, k)
    assert found.trustworthiness == pytest.approx(trustworthiness(rolled, above, n_neighbors=k), abs=1e-9)
    # continuity is trustworthiness seen from the other side
    assert found.continuity == pytest.approx(trustworthiness(above, rolled, n_neighbors=k), abs=1e-9)
    true, shown = (NearestNeighbors(n_neighbors=k).fit(x).kneighbors(return_distance=False) for x in (rolled, above))
    shared = np.mean([len(set(a) & set(b)) / k for a, b in zip(true, shown)])
    assert found.shared == pytest.approx(shared)


def test_a_map_that_is_the_truth_is_perfect(roll):
    flat = roll[1]
    assert NeighbourPreservation.of(flat, 3 * flat[:, ::-1]) == NeighbourPreservation(1.0, 1.0, 1.0)


def test_unrolling_keeps_neighbours_better_than_a_view_from_above(roll):
    rolled, unrolled, above = roll
    good, bad = NeighbourPreservation.of(rolled, unrolled), NeighbourPreservation.of(rolled, above)
    assert good.trustworthiness > bad.trustworthiness
    assert good.shared > bad.shared


@pytest.mark.parametrize("n", [0, 1, 2, 3, 7])
def test_tiny_maps_have_figures(n):
    points = np.random.default_rng(1).normal(size=(n, 3))
    found = NeighbourPreservation.of(points, points[:, :2])
    assert 0 <= found.trustworthiness <= 1
    assert 0 <= found.shared <= 1


def test_a_large_map_is_judged_by_a_part_of_its_frames():
    rng = np.random.default_rng(11)
    frames = rng.normal(size=(1500, 4))
    embedding = frames[:, :2] + 0.3 * rng.normal(size=(1500, 2))
    whole = NeighbourPreservation.of(frames, embedding)
    part = NeighbourPreservation.of(frames, embedding, most_rows=500)
    assert part != whole
    assert part.trustworthiness == pytest.approx(whole.trustworthiness, abs=0.01)
    assert part.continuity == pytest.approx(whole.continuity, abs=0.01)
    assert part.shared == pytest.approx(whole.shared, abs=0.02)
