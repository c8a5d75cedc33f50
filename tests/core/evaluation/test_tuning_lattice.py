"""The tuning's quick paths against the exhaustive search."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.evaluation.tuning_lattice import TuningLattice
from core.search.best_path import find_path, priced
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts, TransitionParts
from core.speech.phoneme import PHONEME_INDEX


def asked(rng: np.random.Generator, phones: str, n_slots: int) -> SearchRequest:
    spoken = [PHONEME_INDEX[p] for p in rng.choice(phones.split(), n_slots)]
    silent = PHONEME_INDEX["pau"]
    spoken = [silent, *spoken, silent] if rng.random() < 0.7 else spoken
    emotions = np.eye(4)[np.full(len(spoken), rng.integers(4))]
    return SearchRequest(np.array(spoken), emotions)


@pytest.mark.parametrize("seed", range(12))
def test_exact_paths_cost_what_the_exhaustive_search_finds(random_motion, seed):
    frames, nodes = random_motion(seed, n_sentences=8)
    rng = np.random.default_rng(seed)
    terms = TransitionTerms(frames, nodes, 60.0)
    requests = [asked(rng, "aa b k iy pau zh", int(rng.integers(1, 8))) for _ in range(6)]
    computed = TransitionParts.of(terms)
    parts = np.stack([computed.position_gap, computed.velocity_gap, computed.smoothing])
    lattices = [TuningLattice(terms, requests), TuningLattice(terms, requests, parts)]
    lattices.append(TuningLattice(terms, requests, parts, expected=lattices[1].expected))
    untuned = default_weights(frames, nodes, 60.0)
    for _ in range(5):
        factor = lambda: float(np.exp(rng.uniform(-2, 2)))  # noqa: E731
        weights = replace(untuned, pnt=untuned.pnt * factor(), alpha1=factor(), alpha3=untuned.alpha3 * factor(),
                          alpha5=50 * factor(), alpha6=factor(), context_before=rng.integers(2) * factor())  # fmt: skip
        costs = TransitionCosts(terms, weights)
        kernels = NumpyKernels()
        kernels.prepare(costs.matrix)
        for i, request in enumerate(requests):
            least = find_path(request, costs, kernels).cost
            for lattice in lattices:
                path, is_proved = lattice.best_path(i, request, weights, exact=True)
                assert is_proved
                assert priced(path, request, costs).cost == pytest.approx(least, rel=1e-5)


def test_most_paths_are_proved_at_once_where_phonemes_matter(random_motion):
    frames, nodes = random_motion(1, n_sentences=20)
    rng = np.random.default_rng(1)
    terms = TransitionTerms(frames, nodes, 60.0)
    requests = [asked(rng, "aa b k iy", 6) for _ in range(20)]
    lattice = TuningLattice(terms, requests)
    weights = replace(default_weights(frames, nodes, 60.0), alpha4=0.9, alpha5=100.0)
    proved = [
        lattice._expected_path(slots, request, weights) is not None for slots, request in zip(lattice._slots, requests)
    ]
    assert np.mean(proved) > 0.5


def test_the_walk_keeps_to_nodes_that_say_the_phonemes(random_motion):
    frames, nodes = random_motion(5, n_sentences=10)
    rng = np.random.default_rng(5)
    terms = TransitionTerms(frames, nodes, 60.0)
    requests = [asked(rng, "aa b k iy", 6) for _ in range(4)]
    lattice = TuningLattice(terms, requests)
    # a wrong phoneme for nothing: the exact answer would be full of them
    weights = replace(default_weights(frames, nodes, 60.0), alpha5=0.0, alpha6=0.0)
    costs = TransitionCosts(terms, weights)
    for i, request in enumerate(requests):
        path, is_proved = lattice.best_path(i, request, weights, exact=False)
        assert not is_proved
        spoken = request.phonemes != PHONEME_INDEX["pau"]
        assert np.array_equal(nodes.phoneme[path[spoken]], request.phonemes[spoken])
        exact, _ = lattice.best_path(i, request, weights, exact=True)
        assert priced(exact, request, costs).cost <= priced(path, request, costs).cost * (1 + 1e-6)
