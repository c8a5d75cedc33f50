"""Near-optimal paths against enumeration."""

import itertools
from collections import Counter

import numpy as np
import pytest

from core.search.best_path import priced, slot_costs
from core.search.constraints import SearchRequest
from core.search.near_optimal import near_optimal_paths
from core.search.relaxation import find_path_by_relaxation
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.speech.phoneme import PHONEMES


def prepared(frames, nodes):
    return TransitionCosts(TransitionTerms(frames, nodes, 120.0), default_weights(frames, nodes, 120.0))


def question(phones, **more):
    return SearchRequest(np.array([PHONEMES.index(p) for p in phones.split()]), np.eye(4)[[0] * len(phones.split())],
                         **more)  # fmt: skip


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("surcharge", [0.3, 3.0])
def test_each_path_is_the_cheapest_under_the_surcharges_so_far(random_motion, seed, surcharge):
    frames, nodes = random_motion(seed, n_sentences=2, phones_each=6, phones="aa b k")
    costs = prepared(frames, nodes)
    request = question("aa b k aa", pins={2: 4} if seed % 2 else {}, removed=frozenset({1}))
    found = near_optimal_paths(request, find_path_by_relaxation(request, costs), costs, 4, surcharge)
    local = np.stack([slot_costs(request, p, nodes, costs.weights) for p in range(4)])
    uses = Counter(found[0].nodes.tolist())
    for path in found[1:]:
        least = min(
            sum(local[p, n] + surcharge * costs.weights.pnt * uses[n] for p, n in enumerate(rows))
            + sum(float(costs.matrix[m, n]) for n, m in itertools.pairwise(rows))
            for rows in itertools.product(range(len(nodes)), repeat=4)
        )
        charged = path.cost + surcharge * costs.weights.pnt * sum(uses[n] for n in path.nodes.tolist())
        assert charged == pytest.approx(least)
        assert path.cost == pytest.approx(priced(path.nodes, request, costs).cost)
        uses.update(path.nodes.tolist())


def test_the_best_comes_first_and_constraints_hold_in_all(random_motion):
    frames, nodes = random_motion(9, n_sentences=30, phones_each=10, phones="aa b k iy pau")
    costs = prepared(frames, nodes)
    request = question("pau aa b k iy pau aa pau", pins={3: 17, 5: 20}, removed=frozenset(range(40, 60)))
    best = find_path_by_relaxation(request, costs)
    paths = near_optimal_paths(request, best, costs, 6, 2.0)
    assert len(paths) == 6 and paths[0].nodes is best.nodes
    assert all(path.cost >= best.cost for path in paths)
    assert all(path.nodes[3] == 17 and path.nodes[5] == 20 for path in paths)
    assert not any(set(path.nodes.tolist()) & request.removed for path in paths)
    assert len({tuple(path.nodes.tolist()) for path in paths}) == 6
