"""What every compute backend has to show."""

import numpy as np
import pytest

from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts


def _steps_equal_the_reference(kernels, n_nodes):
    """Both products equal the reference and a one-line computation, bit by bit: all sums are double."""
    rng = np.random.default_rng(n_nodes)
    matrix = rng.exponential(size=(n_nodes, n_nodes)).astype(np.float32)
    front = np.where(rng.random(n_nodes) < 0.3, np.inf, rng.exponential(size=n_nodes))
    behind = rng.exponential(size=n_nodes) * 3
    reference = NumpyKernels()
    for each in (reference, kernels):
        each.prepare(matrix)
        arrived, left = each.min_plus_both(front, behind)
        assert np.array_equal(arrived, (matrix.astype(float) + front).min(axis=1))
        assert np.array_equal(left, (matrix.astype(float) + behind[:, None]).min(axis=0))
        assert np.array_equal(each.min_plus(front), arrived)


def _utterances_equal_the_reference(kernels, frames, nodes, count):
    """Random utterances with pins, removed nodes and mixed emotions: the same path at the same cost."""
    weights = default_weights(frames, nodes, 120.0)
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), weights)
    reference = NumpyKernels()
    for each in (reference, kernels):
        each.prepare(costs.matrix)
    rng = np.random.default_rng(count)
    for _ in range(count):
        n_slots = int(rng.integers(1, 40))
        rows = rng.permutation(len(nodes))
        pins = {int(s): int(r) for s, r in zip(rng.choice(n_slots, min(n_slots, 3), replace=False), rows)}
        request = SearchRequest(
            rng.integers(0, 44, n_slots), rng.dirichlet(np.ones(4), n_slots), pins, frozenset(rows[5:40].tolist())
        )
        ours, theirs = find_path(request, costs, kernels), find_path(request, costs, reference)
        assert ours.nodes.tolist() == theirs.nodes.tolist()
        assert ours.cost == theirs.cost
        assert all(ours.nodes[slot] == row for slot, row in pins.items())


@pytest.fixture
def steps_equal_the_reference():
    return _steps_equal_the_reference


@pytest.fixture
def utterances_equal_the_reference(random_motion):
    motion = random_motion(50, n_sentences=40, phones_each=12, phones="aa b k iy s m ow t pau")
    return lambda kernels, count: _utterances_equal_the_reference(kernels, *motion, count)
