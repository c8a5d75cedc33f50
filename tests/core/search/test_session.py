"""Edits against a cold search of the same request."""

from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule, run_state_machine_as_test

from core.errors import UserFacingError
from core.motion.node import NodeTableBuilder
from core.search.best_path import find_path
from core.search.compute import NumpyKernels
from core.search.constraints import SearchRequest
from core.search.session import SearchSession
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights
from core.speech.phoneme import PHONEMES

N_SLOTS = 9
PHONES = [PHONEMES.index(p) for p in ("aa", "b", "k", "iy", "pau")]


def small_costs(seed, **further):
    rng = np.random.default_rng(seed)
    builder, frames, first = NodeTableBuilder(), [], 0
    for s in range(8):
        lengths = rng.integers(1, 8, 7)
        stops = lengths.cumsum()
        frames.append(rng.normal(size=(stops[-1], 4)).cumsum(axis=0))
        phones = rng.choice(PHONES[:4], 7).tolist()
        builder.add_sentence(f"s{s}", s % 4, phones, stops - lengths, stops, np.zeros(stops[-1], bool), first)
        first += int(stops[-1])
    frames, nodes = np.concatenate(frames), builder.table()
    weights = SearchWeights.from_dict({**default_weights(frames, nodes, 120.0).as_dict(), **further})
    return TransitionCosts(TransitionTerms(frames, nodes, 120.0), weights)


def with_kernels(costs):
    kernels = NumpyKernels()
    kernels.prepare(costs.matrix)
    return kernels


def plain(n_slots=N_SLOTS, seed=0):
    phonemes = np.random.default_rng(seed).choice(PHONES, n_slots)
    return SearchRequest(phonemes, np.eye(4)[[0] * n_slots], lengths=np.arange(n_slots) + 1)


class Editing(RuleBasedStateMachine):
    """Random edits; after each, path and cost equal a cold exhaustive search, and so do prices when they are read."""

    further: ClassVar = {}

    def __init__(self):
        super().__init__()
        self.costs = small_costs(1, **self.further)
        self.kernels = with_kernels(self.costs)
        self.n_nodes = len(self.costs.terms.nodes)
        self.session = SearchSession(plain(), self.costs, self.kernels)

    def edit(self, **changes):
        now = self.session.request
        before = self.session.path
        request = replace(now, **changes)
        try:
            self.session.update(request)
        except UserFacingError:
            assert self.session.request is now and self.session.path is before

    @rule(slot=st.integers(0, N_SLOTS - 1), node=st.integers(0, 55))
    def pin(self, slot, node):
        self.edit(pins={**self.session.request.pins, slot: node % self.n_nodes})

    @rule(slot=st.integers(0, N_SLOTS - 1))
    def unpin(self, slot):
        self.edit(pins={s: n for s, n in self.session.request.pins.items() if s != slot})

    @rule(first=st.integers(0, N_SLOTS - 1), length=st.integers(1, 4))
    def lock(self, first, length):
        span = range(first, min(first + length, N_SLOTS))
        self.edit(pins={**self.session.request.pins, **{p: int(self.session.path.nodes[p]) for p in span}})

    @rule(first=st.integers(0, N_SLOTS - 1), length=st.integers(1, 8), emotion=st.integers(0, 3), share=st.floats(0, 1))
    def paint(self, first, length, emotion, share):
        emotions = self.session.request.emotions.copy()
        emotions[first : first + length] = (1 - share) * np.eye(4)[0] + share * np.eye(4)[emotion]
        self.edit(emotions=emotions)

    @rule(slot=st.integers(0, N_SLOTS - 1), phone=st.sampled_from(PHONES))
    def rename(self, slot, phone):
        phonemes = self.session.request.phonemes.copy()
        phonemes[slot] = phone
        self.edit(phonemes=phonemes)

    @rule(nodes=st.sets(st.integers(0, 55), max_size=5))
    def remove(self, nodes):
        self.edit(removed=self.session.request.removed | {n % self.n_nodes for n in nodes})

    @rule(slot=st.integers(0, N_SLOTS - 1))
    def remove_the_one_in_use(self, slot):
        self.edit(removed=self.session.request.removed | {int(self.session.path.nodes[slot])})

    @rule()
    def restore_all(self):
        self.edit(removed=frozenset())

    @rule(slot=st.integers(0, N_SLOTS - 1))
    def split(self, slot):
        now = self.session.request
        if now.n_slots <= N_SLOTS and not now.pins:
            again = np.insert(np.arange(now.n_slots), slot, slot)
            columns = {"phonemes": now.phonemes, "emotions": now.emotions, "lengths": now.lengths}
            self.edit(**{name: column[again][:N_SLOTS] for name, column in columns.items()})

    @rule(slot=st.integers(0, N_SLOTS - 2), by=st.integers(1, 6))
    def drag_a_boundary(self, slot, by):
        lengths = self.session.request.lengths.copy()
        lengths[slot] += by
        lengths[slot + 1] = max(1, lengths[slot + 1] - by)
        self.edit(lengths=lengths)

    @rule()
    def refresh(self):
        self.session.refresh()
        assert self.session.has_prices

    @rule(slot=st.integers(0, N_SLOTS - 1), node=st.integers(0, 55))
    def read_a_price(self, slot, node):
        node = node % self.n_nodes
        price = self.session.prices(slot)[node]
        now = self.session.request
        if node in now.removed or now.pins.get(slot, node) != node:
            assert price == np.inf
            return
        forced = replace(now, pins={**now.pins, slot: node})
        cost = find_path(forced, self.costs, self.kernels).cost
        assert price == pytest.approx(cost - self.session.path.cost, rel=1e-9, abs=1e-9 * max(cost, 1.0))

    @invariant()
    def equals_a_cold_search(self):
        cold = find_path(self.session.request, self.costs, self.kernels)
        assert self.session.path.nodes.tolist() == cold.nodes.tolist()
        assert self.session.path.cost == cold.cost
        assert self.session.path.is_optimal


class EditingInContext(Editing):
    """The same with the phones around a slot, and its length, in its cost: an edit reaches its neighbours."""

    further: ClassVar = {"context_before": 1.0, "context_after": 0.7, "duration": 0.5}


def explore(machine, examples, steps):
    checks = [HealthCheck.too_slow, HealthCheck.data_too_large]
    run_state_machine_as_test(
        machine,
        settings=settings(
            max_examples=examples,
            stateful_step_count=steps,
            deadline=None,
            derandomize=True,
            suppress_health_check=checks,
        ),
    )


@pytest.mark.parametrize("machine", [Editing, EditingInContext])
def test_edits_equal_cold_searches(machine):
    explore(machine, examples=15, steps=20)


@pytest.mark.prove
@pytest.mark.parametrize("machine", [Editing, EditingInContext])
def test_thousands_of_edit_sequences_equal_cold_searches(machine):
    explore(machine, examples=1000, steps=30)


def test_remove_then_pin_uses_no_stale_table():
    costs = small_costs(2)
    kernels = with_kernels(costs)
    for seed in range(30):
        request = plain(seed=seed)
        session = SearchSession(request, costs, kernels)
        session.refresh()
        off_path = sorted(set(range(len(costs.terms.nodes))) - set(session.path.nodes.tolist()))
        removed = frozenset(off_path[::2])
        before = session.path
        assert session.update(replace(request, removed=removed)) is before
        assert not session.has_prices
        pinned = replace(request, pins={4: off_path[1]}, removed=removed)
        cold = find_path(pinned, costs, kernels)
        assert session.update(pinned).nodes.tolist() == cold.nodes.tolist()
        assert not removed & set(session.path.nodes.tolist())


def test_a_second_pin_before_the_refresh():
    costs = small_costs(3)
    kernels = with_kernels(costs)
    request = plain(seed=3)
    session = SearchSession(request, costs, kernels)
    session.refresh()
    for pins in ({2: 11}, {2: 11, 6: 30}, {6: 30}):
        now = replace(request, pins=pins)
        assert session.update(now).nodes.tolist() == find_path(now, costs, kernels).nodes.tolist()


def test_alternatives_are_ranked_and_start_with_the_node_in_use():
    costs = small_costs(4)
    session = SearchSession(plain(seed=4), costs, with_kernels(costs))
    ranked = session.alternatives(3, 6)
    assert ranked[0].node == session.path.nodes[3] and ranked[0].price == 0.0
    assert [a.price for a in ranked] == sorted(a.price for a in ranked)
    prices = session.prices(3)
    assert sorted(prices)[:6] == pytest.approx([a.price for a in ranked])
    with pytest.raises(UserFacingError, match="slot 99"):
        session.prices(99)


def test_the_breakdown_sums_to_the_cost():
    costs = small_costs(5)
    session = SearchSession(plain(seed=5), costs, with_kernels(costs))
    rows = session.breakdown()
    assert sum(sum(row.values()) for row in rows) == pytest.approx(session.path.cost, rel=1e-6)
    for p, row in enumerate(rows):
        arriving = sum(row[k] for k in ("position", "velocity", "smoothing", "viseme", "no_predecessor"))
        assert arriving == pytest.approx(session.path.transition[p], rel=1e-5, abs=1e-6)


def test_new_weights_are_answered_anew():
    costs = small_costs(6)
    kernels = with_kernels(costs)
    session = SearchSession(plain(seed=6), costs, kernels)
    session.refresh()
    weights = costs.weights
    costs.reweight(type(weights).from_dict({**weights.as_dict(), "alpha3": weights.alpha3 * 9, "alpha6": 0.1}))
    kernels.prepare(costs.matrix)
    assert session.reweight().nodes.tolist() == find_path(session.request, costs, kernels).nodes.tolist()
    assert not session.has_prices
