"""OpenCL against the numpy reference. The sums are double on both sides, so equality is exact."""

import numpy as np
import pytest

from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from gpu.opencl.min_plus import OpenClKernels


@pytest.fixture(scope="module")
def opencl():
    kernels = OpenClKernels()  # PoCL is a dependency on Linux: no skip when it is missing
    yield kernels
    kernels.release()


@pytest.mark.parametrize("n_nodes", [1, 15, 16, 17, 333])
def test_one_step_equals_the_reference(opencl, n_nodes):
    rng = np.random.default_rng(n_nodes)
    matrix = rng.exponential(size=(n_nodes, n_nodes)).astype(np.float32)
    front = np.where(rng.random(n_nodes) < 0.3, np.inf, rng.exponential(size=n_nodes))
    reference = NumpyKernels()
    for kernels in (reference, opencl):
        kernels.prepare(matrix)
    assert np.array_equal(opencl.min_plus(front), reference.min_plus(front))
    brute = (matrix.astype(float) + front).min(axis=1)
    assert np.array_equal(reference.min_plus(front), brute)


def test_fifty_random_utterances_with_pins_and_emotions(opencl, random_motion):
    frames, nodes = random_motion(50, n_sentences=40, phones_each=12, phones="aa b k iy s m ow t pau")
    weights = default_weights(frames, nodes, 120.0)
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), weights)
    reference = NumpyKernels()
    for kernels in (reference, opencl):
        kernels.prepare(costs.matrix)
    rng = np.random.default_rng(50)
    for _ in range(50):
        n_slots = int(rng.integers(1, 40))
        rows = rng.permutation(len(nodes))
        pins = {int(s): int(r) for s, r in zip(rng.choice(n_slots, min(n_slots, 3), replace=False), rows)}
        request = SearchRequest(
            rng.integers(0, 44, n_slots), rng.dirichlet(np.ones(4), n_slots), pins, frozenset(rows[5:40].tolist())
        )
        ours = find_path(request, costs, opencl)
        theirs = find_path(request, costs, reference)
        assert ours.nodes.tolist() == theirs.nodes.tolist()
        assert ours.cost == theirs.cost
        assert all(ours.nodes[slot] == row for slot, row in pins.items())
