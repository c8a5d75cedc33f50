"""The relaxation against the exhaustive search: same path, same cost, and bounds that hold."""

import numpy as np
import pytest

from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights


def prepared(frames, nodes, **change):
    weights = default_weights(frames, nodes, 120.0)
    weights = SearchWeights.from_dict({**weights.as_dict(), **change})
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), weights)
    kernels = NumpyKernels()
    kernels.prepare(costs.matrix)
    return costs, kernels


def request_of(rng, n_nodes, n_slots):
    rows = rng.permutation(n_nodes)
    pins = {int(s): int(r) for s, r in zip(rng.choice(n_slots, min(n_slots, rng.integers(3)), replace=False), rows)}
    emotions = np.eye(4)[rng.integers(4, size=n_slots)] if rng.random() < 0.5 else rng.dirichlet(np.ones(4), n_slots)
    removed = frozenset(rows[3 : 3 + rng.integers(n_nodes // 3)].tolist())
    return SearchRequest(rng.integers(0, 44, n_slots), emotions, pins, removed)


@pytest.mark.parametrize("seed", range(40))
def test_equals_the_exhaustive_search(random_motion, seed):
    rng = np.random.default_rng(seed)
    frames, nodes = random_motion(seed, n_sentences=25, phones_each=10, phones="aa b k iy s m ow t pau")
    # penalties from worthless, where everything has to become active, to overwhelming
    scale = [0.0, 0.05, 1.0, 20.0][seed % 4]
    costs, kernels = prepared(frames, nodes, alpha5=5.0 * scale, alpha6=2.0 * scale)
    request = request_of(rng, len(nodes), int(rng.choice([1, 2, 7, 30])))
    rounds = []
    ours = find_path_by_relaxation(request, costs, on_round=rounds.append)
    theirs = find_path(request, costs, kernels)
    assert ours.nodes.tolist() == theirs.nodes.tolist()
    assert ours.cost == theirs.cost
    assert ours.is_optimal and ours.gap == 0.0
    for found in rounds:
        assert found.lower_bound <= theirs.cost * (1 + 1e-12)
        assert found.upper_bound >= theirs.cost * (1 - 1e-12)


def test_ties_go_to_the_lowest_row(random_motion):
    frames, nodes = random_motion(3, n_sentences=10)
    frames[:] = 0.0  # every join is free or a flat penalty: ties everywhere
    costs, kernels = prepared(frames, nodes)
    rng = np.random.default_rng(3)
    for _ in range(20):
        request = request_of(rng, len(nodes), 6)
        ours, theirs = find_path_by_relaxation(request, costs), find_path(request, costs, kernels)
        assert ours.nodes.tolist() == theirs.nodes.tolist()


def test_out_of_time_the_gap_is_honest(random_motion):
    frames, nodes = random_motion(5, n_sentences=30, phones_each=10)
    costs, kernels = prepared(frames, nodes, alpha5=0.3, alpha6=0.1)
    request = SearchRequest(np.random.default_rng(5).integers(1, 44, 20), np.eye(4)[[1] * 20])
    hurried = find_path_by_relaxation(request, costs, limit_s=0.0)
    best = find_path(request, costs, kernels).cost
    assert hurried.lower_bound <= best <= hurried.cost
    assert hurried.gap == pytest.approx((hurried.cost - hurried.lower_bound) / hurried.cost) or hurried.is_optimal


def test_beyond_the_budget_nothing_is_held_and_the_answer_is_the_same(random_motion):
    frames, nodes = random_motion(6, n_sentences=30, phones_each=10)
    costs, _ = prepared(frames, nodes)
    tiled = TransitionCosts(costs.terms, costs.weights, budget_bytes=1000)
    assert not tiled.is_held
    with pytest.raises(ValueError, match="budget"):
        _ = tiled.matrix
    rows = np.random.default_rng(6).permutation(len(nodes))
    assert tiled.block(rows[:50], rows[20:90]) == pytest.approx(costs.block(rows[:50], rows[20:90]), rel=1e-6, abs=1e-3)
    request = request_of(np.random.default_rng(7), len(nodes), 12)
    ours, theirs = find_path_by_relaxation(request, tiled), find_path_by_relaxation(request, costs)
    assert ours.nodes.tolist() == theirs.nodes.tolist()
    assert ours.cost == pytest.approx(theirs.cost, rel=1e-6)


def test_reweighting_equals_a_matrix_from_scratch(random_motion):
    frames, nodes = random_motion(8)
    costs, _ = prepared(frames, nodes)
    _ = costs.matrix
    other = SearchWeights(pnt=7.0, alpha1=1.5, alpha2=1e-4, alpha3=20.0)
    costs.reweight(other)
    assert np.array_equal(costs.matrix, TransitionCosts(costs.terms, other).matrix)
