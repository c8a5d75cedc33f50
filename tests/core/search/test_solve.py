"""Whichever way is taken, the answer is the exhaustive one."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.search import solve as module
from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts


@pytest.fixture
def prepared(random_motion):
    frames, nodes = random_motion(4, n_sentences=20, phones_each=10)
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), default_weights(frames, nodes, 120.0))
    kernels = NumpyKernels()
    kernels.prepare(costs.matrix)
    return costs, kernels


@pytest.mark.parametrize("narrow", [False, True])
def test_both_ways_give_the_same_path(prepared, monkeypatch, narrow):
    costs, kernels = prepared
    if narrow:
        monkeypatch.setattr(module, "find_path_by_relaxation", lambda *_, **__: None)
    asked = []
    for seed in range(5):
        rng = np.random.default_rng(seed)
        request = SearchRequest(rng.integers(0, 44, 15), np.eye(4)[rng.integers(4, size=15)])
        answer = module.solve(request, costs, lambda: asked.append(1) or kernels)
        assert answer.nodes.tolist() == find_path(request, costs, kernels).nodes.tolist()
        assert answer.is_optimal
    assert bool(asked) == narrow


def test_a_wide_lattice_is_declined(prepared):
    costs, _ = prepared
    request = SearchRequest(np.zeros(6, int), np.eye(4)[[0] * 6])
    assert find_path_by_relaxation(request, costs, most_pairs=10) is None


def test_beyond_the_budget_the_best_so_far_carries_its_bound(prepared, monkeypatch):
    costs, kernels = prepared
    request = SearchRequest(np.random.default_rng(1).integers(1, 44, 12), np.eye(4)[[2] * 12])
    least = find_path(request, costs, kernels).cost
    tiled = TransitionCosts(costs.terms, costs.weights, budget_bytes=0)
    rounds = []
    find_path_by_relaxation(request, tiled, on_round=lambda found: rounds.append(found))
    monkeypatch.setattr(module, "_MOST_PAIRS", 10)
    with pytest.raises(UserFacingError, match="too large"):
        module.solve(request, tiled, lambda: kernels)
    gaps = set()
    for most in (200, 2_000, 20_000, 200_000, 2**29):
        monkeypatch.setattr(module, "_MOST_PAIRS", most)
        try:
            answer = module.solve(request, tiled, lambda: kernels)
        except UserFacingError:
            continue
        assert answer.lower_bound <= least * (1 + 1e-6) and answer.cost >= least * (1 - 1e-6)
        gaps.add(answer.is_optimal)
    assert True in gaps and len(rounds) >= 1
