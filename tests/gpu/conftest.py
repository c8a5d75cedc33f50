"""What every compute backend has to show."""

from dataclasses import replace

import numpy as np
import pytest

from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.session import SearchSession
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.speech.phoneme import PAU, PHONEME_INDEX


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


def _prepared(kernels, frames, nodes):
    """Costs that both ``kernels`` and the reference, which is returned too, have been prepared with."""
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), default_weights(frames, nodes, 120.0))
    reference = NumpyKernels()
    for each in (reference, kernels):
        each.prepare(costs.matrix)
    return costs, reference


def _random_request(rng, n_slots, n_nodes, n_pins=3):
    """Silences, mixed and pure emotions of any strength, pins, and removed nodes."""
    rows = rng.permutation(n_nodes)
    phonemes = np.where(rng.random(n_slots) < 0.2, PHONEME_INDEX[PAU], rng.integers(0, 44, n_slots))
    emotions = rng.dirichlet(np.ones(4), n_slots)
    pure = rng.random(n_slots) < 0.3
    emotions[pure] = np.eye(4)[rng.integers(0, 4, pure.sum())]
    pins = {int(s): int(r) for s, r in zip(rng.choice(n_slots, min(n_slots, n_pins), replace=False), rows)}
    return SearchRequest(phonemes, emotions, pins, frozenset(rows[5:40].tolist()))


def _utterances_equal_the_reference(kernels, frames, nodes, count):
    """Random utterances, one of a single phoneme and one of 300 among them: the same path at the same cost."""
    costs, reference = _prepared(kernels, frames, nodes)
    rng = np.random.default_rng(count)
    for n_slots in (1, 300, *rng.integers(1, 40, count)):
        request = _random_request(rng, int(n_slots), len(nodes))
        ours, theirs = find_path(request, costs, kernels), find_path(request, costs, reference)
        assert ours.nodes.tolist() == theirs.nodes.tolist()
        assert ours.cost == theirs.cost
        assert all(ours.nodes[slot] == row for slot, row in request.pins.items())


def _edited(rng, request, n_nodes):
    """The request after one edit: a pin, no pins, an emotion over four slots, a phoneme, or other nodes removed."""
    slot = int(rng.integers(request.n_slots))
    other = _random_request(rng, request.n_slots, n_nodes)
    span = np.arange(request.n_slots)
    kind = rng.integers(5)
    if kind == 0:
        node = next(int(row) for row in rng.permutation(n_nodes) if row not in request.removed)
        return replace(request, pins={**request.pins, slot: node})
    if kind == 1:
        return replace(request, pins={})
    if kind == 2:
        painted = (span >= slot) & (span < slot + 4)
        return replace(request, emotions=np.where(painted[:, None], other.emotions, request.emotions))
    if kind == 3:
        return replace(request, phonemes=np.where(span == slot, other.phonemes, request.phonemes))
    return replace(request, removed=other.removed - set(request.pins.values()))


def _edits_equal_the_reference(kernels, frames, nodes, count):
    """After each of many edits the session has the path of a cold search, and the reference's prices."""
    costs, reference = _prepared(kernels, frames, nodes)
    rng = np.random.default_rng(count)
    request = _random_request(rng, 12, len(nodes), n_pins=0)
    session, plain = (SearchSession(request, costs, each) for each in (kernels, reference))
    for _ in range(count):
        request = _edited(rng, request, len(nodes))
        answers = [each.update(request) for each in (session, plain)]
        cold = find_path(request, costs, reference)
        assert all(answer.nodes.tolist() == cold.nodes.tolist() for answer in answers)
        assert answers[0].cost == cold.cost
        if rng.random() < 0.5:
            slot = int(rng.integers(request.n_slots))
            assert np.array_equal(session.prices(slot), plain.prices(slot))


@pytest.fixture
def steps_equal_the_reference():
    return _steps_equal_the_reference


@pytest.fixture
def utterances_equal_the_reference(random_motion):
    motion = random_motion(50, n_sentences=40, phones_each=12, phones="aa b k iy s m ow t pau")
    return lambda kernels, count: _utterances_equal_the_reference(kernels, *motion, count)


@pytest.fixture
def edits_equal_the_reference(random_motion):
    motion = random_motion(51, n_sentences=20, phones_each=12, phones="aa b k iy s m ow t pau")
    return lambda kernels, count: _edits_equal_the_reference(kernels, *motion, count)
