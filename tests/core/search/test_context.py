"""Context and length in the observation cost, against a walk along the captured sentences."""

import numpy as np
import pytest

from core.motion.node import CONTEXT_REACH
from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.context import context_around, context_costs, duration_costs
from core.search.relaxation import find_path_by_relaxation
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights
from core.speech.phoneme import PHONEMES, viseme_of

WEIGHTS = SearchWeights(pnt=10.0, alpha4=0.3, context_before=2.0, context_after=3.0, context_decay=0.5, duration=1.5)


def spoken_around(phones, place, step):
    """The next phones of a sentence in one direction; silence from the first silence on."""
    around = []
    for d in range(1, CONTEXT_REACH + 1):
        at = place + step * d
        silent = (around and around[-1] == "pau") or not 0 <= at < len(phones)
        around.append("pau" if silent else phones[at])
    return around


def sentences_of(nodes):
    """Rows of the nodes in their sub-sentences, in order."""
    rows = np.flatnonzero(nodes.pre < 0)
    for row in rows:
        chain = [int(row)]
        while nodes.suc[chain[-1]] >= 0:
            chain.append(int(nodes.suc[chain[-1]]))
        yield chain


def test_a_node_knows_the_phones_of_its_sentence(random_motion):
    _, nodes = random_motion(1, n_sentences=8, phones_each=12)
    seen = 0
    for chain in sentences_of(nodes):
        phones = [nodes[row].phone for row in chain]
        for place, row in enumerate(chain):
            for side, step in enumerate((-1, 1)):
                known = [PHONEMES[p] for p in nodes.context[side, :, row]]
                assert known == spoken_around(phones, place, step)
            seen += 1
    assert seen == len(nodes)


def test_a_captured_sentence_asked_for_again_fits_its_own_nodes_for_nothing(random_motion):
    _, nodes = random_motion(2, phones_each=12)
    for chain in sentences_of(nodes):
        phonemes = np.concatenate([[0], nodes.phoneme[chain], [0]]).astype(int)
        for slot, row in enumerate(chain, start=1):
            assert context_costs(phonemes, slot, nodes, WEIGHTS)[row] == 0.0
            assert np.array_equal(context_around(phonemes, slot), nodes.context[:, :, row])


def test_mismatches_are_weighed_by_side_distance_and_viseme(random_motion):
    _, nodes = random_motion(3, phones_each=10, phones="aa ah b p k pau")
    wanted = ["pau", "b", "aa", "k", "p", "pau", "k", "ah", "b", "pau"]
    phonemes = np.array([PHONEMES.index(p) for p in wanted])
    for slot, phone in enumerate(wanted):
        costs = context_costs(phonemes, slot, nodes, WEIGHTS)
        for row in range(len(nodes)):
            expected = 0.0
            for step, side, strength in ((-1, 0, 2.0), (1, 1, 3.0)):
                pairs = zip(spoken_around(wanted, slot, step), nodes.context[side, :, row])
                for d, (here, there) in enumerate(pairs):
                    there = PHONEMES[there]
                    off = 0.0 if here == there else 0.3 if viseme_of(here) == viseme_of(there) else 1.0
                    expected += 10.0 * strength * 0.5**d * off
            assert costs[row] == pytest.approx(0.0 if phone == "pau" else expected)


def test_a_node_fits_its_own_length_best_and_half_as_well_as_double(random_motion):
    _, nodes = random_motion(4)
    for row in range(0, len(nodes), 5):
        n = int(nodes.n_frames[row])
        assert duration_costs(n, nodes, WEIGHTS)[row] == 0.0
        assert duration_costs(4 * n, nodes, WEIGHTS)[row] == pytest.approx(15.0 * np.log(4) ** 2)
        assert duration_costs(n / 4, nodes, WEIGHTS)[row] == pytest.approx(15.0 * np.log(max(n / 4, 1) / n) ** 2)


def test_weights_of_older_databases_leave_it_out(random_motion):
    old = {"pnt": 3.0, "alpha1": 1.0, "alpha2": 1.0, "alpha3": 1.0, "alpha4": 0.2, "alpha5": 4.0, "alpha6": 1.0}
    weights = SearchWeights.from_dict(old)
    assert weights == weights.as_printed
    assert WEIGHTS.as_printed == SearchWeights(pnt=10.0, alpha4=0.3, context_decay=0.5)
    _, nodes = random_motion(5)
    assert not context_costs(np.array([1, 2, 3]), 1, nodes, WEIGHTS.as_printed).any()


@pytest.mark.parametrize("seed", range(12))
def test_the_search_stays_exact(random_motion, seed):
    rng = np.random.default_rng(seed)
    frames, nodes = random_motion(seed, n_sentences=25, phones_each=10, phones="aa b k iy s m ow t pau")
    strength = float(rng.choice([0.2, 1.0, 5.0]))
    untuned = default_weights(frames, nodes, 120.0).as_dict()
    further = {"context_before": strength, "context_after": 2 * strength, "duration": strength}
    weights = SearchWeights.from_dict({**untuned, **further})
    costs = TransitionCosts(TransitionTerms(frames, nodes, 120.0), weights)
    kernels = NumpyKernels()
    kernels.prepare(costs.matrix)
    request = SearchRequest(
        rng.choice([PHONEMES.index(p) for p in ("aa", "b", "k", "iy", "s", "m", "ow", "t", "pau", "zh")], 14),
        rng.dirichlet(np.ones(4), 14), {int(rng.integers(14)): 7}, lengths=rng.integers(1, 30, 14),
    )  # fmt: skip
    ours, theirs = find_path_by_relaxation(request, costs), find_path(request, costs, kernels)
    assert ours.nodes.tolist() == theirs.nodes.tolist()
    assert ours.cost == theirs.cost and ours.is_optimal
    plain = TransitionCosts(costs.terms, weights.as_printed)
    assert find_path_by_relaxation(request, plain).cost < ours.cost


def test_the_context_is_one_switch_away(random_motion):
    frames, nodes = random_motion(6)
    untuned = default_weights(frames, nodes, 120.0)
    assert untuned == untuned.as_printed
    assert untuned.in_context.context_before > 0 and untuned.in_context.duration > 0
    values = {**untuned.in_context.as_dict(), "context_decay": untuned.context_decay}
    assert SearchWeights.from_dict(values).as_printed == untuned
