import numpy as np
import pytest

from core.motion.node import NIL
from core.search.entry_classes import N_FOLLOWS, N_VISEMES, EntryClasses
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights


@pytest.fixture(params=[{}, {"alpha1": 0.0}, {"alpha3": 0.0, "alpha2": 0.0}, {"pnt": 0.0}])
def costs(request, random_motion):
    frames, nodes = random_motion(2, n_sentences=20)
    weights = default_weights(frames, nodes, 120.0).as_dict() | request.param
    return TransitionCosts(TransitionTerms(frames, nodes, 120.0), SearchWeights.from_dict(weights))


@pytest.mark.parametrize("held", [True, False])
def test_no_transition_costs_less_than_its_classes_allow(costs, held):
    if not held:
        costs = TransitionCosts(costs.terms, costs.weights, budget_bytes=0)
    classes = EntryClasses(costs.terms.nodes, costs.weights)
    everyone = np.arange(len(costs.terms.nodes))
    real = costs.block(everyone, everyone)
    bound = classes.least_transition[classes.follows[:, None], classes.viseme[None]]
    assert (bound <= real).all()
    assert (costs.least(everyone, everyone) <= real).all()


def test_captured_neighbours_are_of_classes_that_join_for_free(costs):
    nodes = costs.terms.nodes
    classes = EntryClasses(nodes, costs.weights)
    m = np.flatnonzero(nodes.pre != NIL)
    assert (classes.least_transition[classes.follows[m], classes.viseme[nodes.pre[m]]] == 0.0).all()


def test_least_of_each_class_equals_a_loop_over_nodes(costs):
    nodes = costs.terms.nodes
    classes = EntryClasses(nodes, costs.weights)
    rng = np.random.default_rng(1)
    values = rng.random(len(nodes))
    rows = rng.permutation(len(nodes))[:17]
    expected = np.full((N_FOLLOWS, N_VISEMES), np.inf)
    by_viseme, by_follows = np.full(N_VISEMES, np.inf), np.full(N_FOLLOWS, np.inf)
    for n in range(len(nodes)):
        a = N_VISEMES if nodes.pre[n] == NIL else nodes.viseme[nodes.pre[n]]
        expected[a, nodes.viseme[n]] = min(expected[a, nodes.viseme[n]], values[n])
        if n in rows:
            by_viseme[nodes.viseme[n]] = min(by_viseme[nodes.viseme[n]], values[n])
            by_follows[a] = min(by_follows[a], values[n])
    assert np.array_equal(classes.least(values), expected)
    assert np.array_equal(classes.least_by_viseme(values[rows], rows), by_viseme)
    assert np.array_equal(classes.least_by_follows(values[rows], rows), by_follows)
