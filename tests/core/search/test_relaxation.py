"""The relaxation against the exhaustive search: same path, same cost, and bounds that hold."""

import numpy as np
import pytest

from core.search import relaxation
from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights
from core.speech.phoneme import PAU, PHONEME_INDEX


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


def costly(seed):
    """Weights from worthless penalties, where everything has to become active, to overwhelming ones; some zero."""
    scale = [0.0, 0.05, 1.0, 20.0][seed % 4]
    change = {"alpha5": 5.0 * scale, "alpha6": 2.0 * scale}
    if seed % 3 == 0:
        change[["alpha1", "alpha2", "alpha3", "alpha4"][seed % 4]] = 0.0
    return change


@pytest.mark.parametrize(("seed", "held"), [(seed, True) for seed in range(40)] + [(seed, False) for seed in range(12)])
def test_equals_the_exhaustive_search(random_motion, monkeypatch, seed, held):
    rng = np.random.default_rng(seed)
    frames, nodes = random_motion(seed, n_sentences=25, phones_each=10, phones="aa b k iy s m ow t pau")
    costs, kernels = prepared(frames, nodes, **costly(seed))
    request = request_of(rng, len(nodes), int(rng.choice([1, 2, 7, 30] if held else [1, 2, 7])))
    theirs = find_path(request, costs, kernels)
    monkeypatch.setattr(relaxation, "_PAIRS_A_ROUND", [300, 30_000, 3e7][seed % 3])
    if not held:
        costs = TransitionCosts(costs.terms, costs.weights, budget_bytes=0)
    for most_at_first in (1, 20, 5000):
        rounds = []
        ours = relaxation.find_path_by_relaxation(request, costs, on_round=rounds.append, most_at_first=most_at_first)
        assert ours.nodes.tolist() == theirs.nodes.tolist()
        assert ours.cost == pytest.approx(theirs.cost, rel=0.0 if held else 1e-6)
        assert ours.is_optimal and ours.gap == 0.0
        # a bound over transitions that are computed on the spot holds to their rounding
        rounding = 1e-12 if held else 1e-6
        for found in rounds:
            assert found.lower_bound <= theirs.cost * (1 + rounding)
            assert found.upper_bound >= theirs.cost * (1 - rounding)
        assert [r.lower_bound for r in rounds] == sorted(r.lower_bound for r in rounds)


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


def test_few_phonemes_that_are_never_joined_are_settled_class_by_class(random_motion):
    frames, nodes = random_motion(9, n_sentences=40, phones_each=10, phones="aa b k iy s m ow t pau")
    costs, kernels = prepared(frames, nodes)
    silence = PHONEME_INDEX[PAU]
    for said in ([silence] * 5, [silence, 3, silence, silence, 9, silence], [1, 1, 1, silence]):
        request = SearchRequest(np.array(said), np.eye(4)[[1] * len(said)])
        tiled = TransitionCosts(costs.terms, costs.weights, budget_bytes=0)
        theirs = find_path(request, costs, kernels)
        for most_at_first in (2, 5000):
            ours = find_path_by_relaxation(request, tiled, most_at_first=most_at_first)
            assert ours.cost == pytest.approx(theirs.cost, rel=1e-6) and ours.is_optimal


def test_an_answer_stopped_in_any_round_holds_what_it_says(random_motion):
    frames, nodes = random_motion(10, n_sentences=40, phones_each=10)
    costs, kernels = prepared(frames, nodes, alpha6=0.3)
    request = SearchRequest(np.random.default_rng(10).integers(1, 44, 25), np.eye(4)[[3] * 25])
    least = find_path(request, costs, kernels).cost
    tiled = TransitionCosts(costs.terms, costs.weights, budget_bytes=0)
    rounds = []
    proved = find_path_by_relaxation(request, tiled, on_round=rounds.append)
    hurried = find_path_by_relaxation(request, tiled, limit_s=0.0)
    assert len(rounds) > 2 and rounds[0].lower_bound < rounds[-1].lower_bound
    assert proved.is_optimal and proved.cost == pytest.approx(least, rel=1e-6)
    assert hurried.gap > 0.0
    assert hurried.lower_bound == pytest.approx(rounds[0].lower_bound, rel=2e-6)
    assert hurried.lower_bound <= least and hurried.cost >= least * (1 - 1e-6)


def test_it_can_be_cancelled_between_two_slots(random_motion):
    class Cancelled(Exception):
        pass

    class Impatient:
        def __init__(self):
            self.steps = 0

        def step(self, fraction, message=""):
            assert 0.0 <= fraction <= 1.0
            self.steps += 1
            if self.steps == 3:
                raise Cancelled

    frames, nodes = random_motion(11)
    costs, _ = prepared(frames, nodes)
    request = SearchRequest(np.arange(1, 9), np.eye(4)[[0] * 8])
    with pytest.raises(Cancelled):
        find_path_by_relaxation(request, costs, Impatient())


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
