"""The search against enumeration of every path."""

import itertools
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.node import NIL
from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest, missing_phonemes
from core.search.terms import TransitionTerms, default_weights, emotion_mismatch_penalties, observation_costs
from core.search.transitions import TransitionCosts
from core.speech.phoneme import PHONEMES


def prepared(frames, nodes):
    weights = default_weights(frames, nodes, 120.0)
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), weights)
    kernels = NumpyKernels()
    kernels.prepare(costs.matrix)
    return costs, kernels


def random_request(rng, nodes, n_slots, n_pins=0, n_removed=0):
    rows = rng.permutation(len(nodes))
    slots = rng.choice(n_slots, n_pins, replace=False)
    return SearchRequest(
        phonemes=np.array([PHONEMES.index(p) for p in rng.choice(["aa", "b", "k", "pau", "s"], n_slots)]),
        emotions=rng.dirichlet(np.ones(4), n_slots),
        pins={int(slot): int(row) for slot, row in zip(slots, rows)},
        removed=frozenset(rows[n_pins : n_pins + n_removed].tolist()),
    )


def enumerated(request, nodes, matrix, weights):
    """Least cost over all paths, one by one."""
    local = observation_costs(request.phonemes, nodes, weights)
    local = local + emotion_mismatch_penalties(request.emotions, nodes, weights)
    candidates = [
        [request.pins[p]] if p in request.pins else [n for n in range(len(nodes)) if n not in request.removed]
        for p in range(request.n_slots)
    ]
    costs = {
        path: sum(local[p, n] for p, n in enumerate(path))
        + sum(float(matrix[m, n]) for n, m in itertools.pairwise(path))
        for path in itertools.product(*candidates)
    }
    return min(costs.values()), costs


@pytest.mark.parametrize("seed", range(12))
def test_equals_enumeration(random_motion, seed):
    rng = np.random.default_rng(seed)
    frames, nodes = random_motion(seed, n_sentences=2, phones_each=5)
    costs, kernels = prepared(frames, nodes)
    request = random_request(rng, nodes, n_slots=4, n_pins=seed % 3, n_removed=seed % 2)
    answer = find_path(request, costs, kernels)
    least, costs = enumerated(request, nodes, costs.matrix, costs.weights)
    assert answer.cost == pytest.approx(least, rel=1e-12)
    assert costs[tuple(answer.nodes.tolist())] == pytest.approx(least, rel=1e-12)


def test_a_captured_sentence_is_found_again_for_free(random_motion):
    frames, nodes = random_motion(7, phones="aa b k iy s")
    costs, kernels = prepared(frames, nodes)
    rows = np.flatnonzero(nodes.sentence == 2)
    emotions = np.zeros((len(rows), 4))
    emotions[:, nodes.emotion[rows[0]]] = 1.0
    answer = find_path(SearchRequest(nodes.phoneme[rows], emotions), costs, kernels)
    assert answer.cost == 0.0
    assert answer.nodes.tolist() == rows.tolist()


def test_pins_hold_everywhere_the_first_slot_included(random_motion):
    frames, nodes = random_motion(8)
    costs, kernels = prepared(frames, nodes)
    for slot in range(5):
        request = SearchRequest(np.zeros(5, int), np.eye(4)[[0] * 5], {slot: 3})
        assert find_path(request, costs, kernels).nodes[slot] == 3


def test_removed_nodes_are_never_used(random_motion):
    frames, nodes = random_motion(9)
    costs, kernels = prepared(frames, nodes)
    removed: set[int] = set()
    request = random_request(np.random.default_rng(9), nodes, 6)
    while len(removed) < len(nodes) - 1:
        now = SearchRequest(request.phonemes, request.emotions, {}, frozenset(removed))
        answer = find_path(now, costs, kernels)
        assert not removed & set(answer.nodes.tolist())
        removed.add(int(answer.nodes[0]))


def test_equal_costs_go_to_the_lowest_row(random_motion):
    frames, nodes = random_motion(10, n_sentences=2, phones_each=5)
    frames[:] = 0.0  # joins are free or a flat penalty
    costs, kernels = prepared(frames, nodes)
    silence = SearchRequest(np.full(3, PHONEMES.index("pau")), np.full((3, 4), 0.25))
    least, every = enumerated(silence, nodes, costs.matrix, costs.weights)
    tied = [path for path, cost in every.items() if cost == pytest.approx(least, rel=1e-12)]
    assert len(tied) > 1
    # decided from the last slot backward, as the search walks back
    assert tuple(find_path(silence, costs, kernels).nodes.tolist()) == min(tied, key=lambda path: path[::-1])


def test_infeasible_requests_name_the_slot_and_what_mends_it(random_motion):
    frames, nodes = random_motion(11)
    costs, kernels = prepared(frames, nodes)
    phonemes, emotions = np.array([PHONEMES.index(p) for p in ("pau", "b", "s")]), np.eye(4)[[0] * 3]
    everyone = frozenset(range(len(nodes)))
    asked = partial(SearchRequest, phonemes, emotions, start_s=(0.0, 0.25, 0.5))
    cases = [
        (asked(pins={1: 4}, removed={4}), f"{nodes.name(4)}, pinned to slot 1 (/b/ at 0.25 s), was removed", "unpin"),
        (asked(pins={2: 4}, removed=everyone), "slot 2 (/s/ at 0.50 s)", "Restore the node"),
        (asked(removed=everyone), "slot 0 (/pau/ at 0.00 s): every motion node", "Restore some"),
        (SearchRequest(phonemes, emotions, removed=everyone), "slot 0 (/pau/): every motion node", "Restore some"),
        (asked(pins={7: 4}), "pinned to slot 7, but the sentence has slots 0 to 2", ""),
        (asked(pins={1: len(nodes)}), "slot 1 (/b/ at 0.25 s) is not in the database", "Unpin"),
        (SearchRequest(phonemes[:0], emotions[:0]), "no phoneme", ""),
    ]
    for request, message, remedy in cases:
        with pytest.raises(UserFacingError) as refused:
            find_path(request, costs, kernels)
        assert message in refused.value.message
        assert remedy in refused.value.remedy


def test_a_phone_without_nodes_is_answered_and_said(random_motion):
    frames, nodes = random_motion(13, phones="aa b k pau")
    costs, kernels = prepared(frames, nodes)
    phonemes = np.array([PHONEMES.index(p) for p in ("b", "aa", "zh", "b", "pau")])
    of_b = frozenset(np.flatnonzero(nodes.phoneme == PHONEMES.index("b")).tolist())
    request = SearchRequest(phonemes, np.eye(4)[[0] * 5], removed=of_b)
    answer = find_path(request, costs, kernels)
    assert len(of_b) > 1 and not of_b & set(answer.nodes.tolist())
    removed, absent = missing_phonemes(request, nodes)
    assert removed.startswith("Every motion node of /b/ was removed") and "slot 0 (/b/) and 1 more." in removed
    assert absent.startswith("The database has no motion of /zh/") and "slot 2 (/zh/)." in absent
    assert missing_phonemes(replace(request, removed=frozenset(list(of_b)[1:])), nodes) == (absent,)
    pinned = replace(request, pins={0: 0, 2: 0, 3: 0}, removed=of_b - {0})
    assert missing_phonemes(pinned, nodes) == ()


def test_a_chain_needs_a_predecessor(random_motion):
    _, nodes = random_motion(12)
    for n in range(len(nodes)):
        if nodes.pre[n] != NIL:
            assert nodes.suc[nodes.pre[n]] == n
            assert nodes.stop[nodes.pre[n]] == nodes.start[n]
