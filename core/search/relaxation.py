"""The best path without looking at most of the database, and the proof that nothing better was left out.

In every slot a few motion nodes are *active*; all others stand behind imaginary nodes, one for each class of
`core.search.entry_classes`, which have the least local cost of their class and are reached and left for the least
that a transition between the classes can cost. So every real path costs at least as much as its image in this relaxed
lattice, and:

- the best path over active nodes alone is an upper bound;
- the best path through the relaxed lattice is a lower bound;
- a node n of slot p lies on no path cheaper than ``F(p, n) + local(p, n) + B(p, n)``, F and B being the least cost of
  reaching and of leaving it, or its imaginary node, in the relaxed lattice.

Imaginary nodes that may lie on a best path are settled: nodes that the last bound does not exclude become active, the
others can lie on no best path, and the imaginary node goes. The lattice is solved again until none is left to settle:
then every optimal path runs through active nodes, and the answer is exact, ties included.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, priced, slot_costs
from core.search.constraints import SearchRequest, check_feasible
from core.search.entry_classes import EntryClasses
from core.search.lattice import Slot, Solution, best_real_path, solve_lattice
from core.search.transitions import TransitionCosts
from core.speech.phoneme import PAU, PHONEME_INDEX, VISEME_OF_PHONEME

_ROUNDING = 1e-12  # relative; sums of a few hundred float64 costs differ by less when their order changes
_RECOMPUTED = 1e-6  # relative; a float32 transition cost that is computed again in another block differs by less
_FINITE = np.finfo(float).max

# In PNT above the least cost of a slot. Within a held matrix: the phone itself in any emotion, under default weights;
# where transitions are computed, less than one join of visemes that do not fit.
_FIRST_REACH, _FIRST_REACH_COMPUTED = 2.1, 0.9
_MOST_AT_FIRST = 5000  # nodes of a slot
_WORTH_A_LOOK = 50  # inactive nodes of a slot for which a tighter bound costs less than their activation
_WORTH_A_LOOK_HELD = 10_000
_PAIRS_AT_A_LOOK = 1 << 23
_PAIRS_A_ROUND = 3e7  # transitions that a round adds, more only where a single slot needs more


@dataclass(frozen=True)
class Round:
    """One solution of the relaxed lattice: seconds since the start, bounds, and active nodes over all slots."""

    seconds: float
    lower_bound: float
    upper_bound: float
    n_active: int


def find_path_by_relaxation(
    request: SearchRequest,
    costs: TransitionCosts,
    progress: Progress = SILENT,
    limit_s: float = np.inf,
    on_round: Callable[[Round], None] = lambda _: None,
    most_pairs: float = np.inf,
    most_at_first: int = _MOST_AT_FIRST,
) -> MotionPath | None:
    """Find the path of least COST (equation 4 of Deng and Neumann 2008) that satisfies ``request``.

    The answer equals that of `core.search.best_path.find_path`, ties included, and carries the bound that proves it.
    After ``limit_s`` seconds, or when the lattice would come to hold more than ``most_pairs`` transitions, the best
    path so far is returned with the bound reached so far; None when already the first lattice would, as when a sentence
    is full of phonemes that the database lacks. Fewer nodes of a slot ``most_at_first`` answer sooner and prove later.
    Raises `UserFacingError` when the request cannot be satisfied.
    """
    nodes = costs.terms.nodes
    check_feasible(request, nodes)
    began = time.perf_counter()
    classes = EntryClasses(nodes, costs.weights)
    slots = _first_lattice(request, costs, classes, most_at_first)
    rounding = _ROUNDING if costs.is_held else _RECOMPUTED
    best, upper, lower_bound = None, np.inf, 0.0
    at_a_glance = not costs.is_held  # a first answer from joins without DSC, a fifth of the work
    while True:
        if sum(len(b.active) * len(a.active) for b, a in itertools.pairwise(slots)) > most_pairs:
            return _unproved(best, request, costs, lower_bound)
        for p, slot in enumerate(slots):
            progress.step(0.9 * lower_bound / upper if 0.0 < upper < np.inf else 0.0, "searching motion nodes")
            if best is not None and time.perf_counter() - began > limit_s:
                return _unproved(best, request, costs, lower_bound)
            if p and slot.arriving is None:
                price = costs.least if at_a_glance else costs.block
                slot.arriving = price(slot.active, slots[p - 1].active)
        solved = solve_lattice(slots, classes)
        best = best_real_path(slots, solved.real)
        upper = priced(best, request, costs).cost if at_a_glance else float(solved.real[-1].min())
        lower_bound = max(lower_bound, min(solved.lower_bound, upper))
        on_round(Round(time.perf_counter() - began, lower_bound, upper, sum(len(slot.active) for slot in slots)))
        limit = upper * (1.0 + rounding)
        if at_a_glance:
            at_a_glance = False
            _drop(slots, solved, limit)
            for slot in slots:
                slot.arriving = None
                slot.update_rest(classes)
            continue
        optimal = solved.lower_bound >= upper * (1.0 - rounding)
        worst = limit if optimal else solved.lower_bound * (1.0 + rounding)
        if not _settle(slots, solved, limit, worst, costs, classes, progress):
            return priced(best, request, costs)


def _unproved(
    best: np.ndarray | None, request: SearchRequest, costs: TransitionCosts, lower_bound: float
) -> MotionPath | None:
    if best is None:
        return None
    return priced(best, request, costs, lower_bound * (1.0 - (0.0 if costs.is_held else _RECOMPUTED)))


def _first_lattice(
    request: SearchRequest, costs: TransitionCosts, classes: EntryClasses, most_at_first: int
) -> list[Slot]:
    """Start each slot with the nodes that its phoneme, its emotion and the phoneme before it make likely."""
    nodes, weights = costs.terms.nodes, costs.weights
    reach = (_FIRST_REACH if costs.is_held else _FIRST_REACH_COMPUTED) * weights.pnt
    slots, crowded = [], []
    for p in range(request.n_slots):
        local = slot_costs(request, p, nodes, weights)
        likely = local
        if p:
            joins = classes.least_transition
            said_before = request.phonemes[p - 1]
            entry = joins.min(axis=1) if said_before == PHONEME_INDEX[PAU] else joins[:, VISEME_OF_PHONEME[said_before]]
            likely = local + entry[classes.follows]
        active = np.flatnonzero(likely <= min(likely.min() + reach, _FINITE))
        if len(active) > most_at_first:
            last = np.partition(likely[active], most_at_first)[most_at_first]
            better = active[likely[active] < last]
            active = better if len(better) else active
            if len(active) > most_at_first:
                crowded.append(p)
        slots.append(Slot(local, active))
    _thin_out(slots, crowded, costs, most_at_first)
    for slot in slots:
        slot.update_rest(classes)
    return slots


def _thin_out(slots: list[Slot], crowded: list[int], costs: TransitionCosts, most: int) -> None:
    """Let slots in which everything fits, silences, start with what was captured next to their neighbours' nodes."""
    nodes = costs.terms.nodes
    for p in crowded:
        beside = [nodes.suc[slots[p - 1].active]] if p and p - 1 not in crowded else []
        if p + 1 < len(slots) and p + 1 not in crowded:
            beside.append(nodes.pre[slots[p + 1].active])
        captured = np.intersect1d(np.concatenate(beside), slots[p].active) if beside else np.empty(0, int)
        slots[p].active = captured if len(captured) else slots[p].active[:most]


def _settle(
    slots: list[Slot],
    solved: Solution,
    limit: float,
    worst: float,
    costs: TransitionCosts,
    classes: EntryClasses,
    progress: Progress,
) -> bool:
    """Settle imaginary nodes with paths no dearer than ``worst``; False when there are none.

    Nodes without a path within ``limit``, the upper bound, are excluded, active ones too. As long as the bounds differ,
    ``worst`` is the lower one, so that only imaginary nodes on a best relaxed path are settled, those that add the
    fewest transitions first: raising the lower bound there, and lowering the upper one, spares the others.
    """
    possible: dict[int, np.ndarray] = {}
    for p, slot in enumerate(slots):
        around = solved.reach[p][:, None] + solved.leave[p]
        on_best = around + slot.rest <= min(worst, _FINITE)
        if on_best.any():
            inside = on_best.ravel()[classes.of_node] & np.isfinite(slot.local)
            inside[slot.active] = False
            rows = np.flatnonzero(inside)
            fits = slot.local[rows] + around.ravel()[classes.of_node[rows]] <= limit
            slot.local[rows[~fits]] = np.inf
            possible[p] = rows[fits]
    if not possible:
        return False
    added = _tightest(possible, slots, solved, limit, costs, classes, progress)
    _drop(slots, solved, limit)
    for p, rows in added.items():
        if len(rows):
            slots[p].active = np.union1d(slots[p].active, rows)
            slots[p].arriving = None
            if p + 1 < len(slots):
                slots[p + 1].arriving = None
    for slot in slots:
        slot.update_rest(classes)
    return True


def _tightest(
    possible: dict[int, np.ndarray],
    slots: list[Slot],
    solved: Solution,
    limit: float,
    costs: TransitionCosts,
    classes: EntryClasses,
    progress: Progress,
) -> dict[int, np.ndarray]:
    """Exclude what a tighter bound can, where that adds the fewest transitions; return what is to be activated."""

    def pairs(p: int) -> int:
        beside = sum(len(slots[q].active) for q in (p - 1, p + 1) if 0 <= q < len(slots))
        return len(possible[p]) * beside

    added: dict[int, np.ndarray] = {}
    budget = _PAIRS_A_ROUND
    for p in sorted(possible, key=pairs):
        if added and pairs(p) > budget:
            break
        progress.step(0.9 * solved.lower_bound / max(limit, solved.lower_bound, 1e-300), "searching motion nodes")
        budget -= pairs(p)
        rows = possible[p]
        if len(rows) > (_WORTH_A_LOOK_HELD if costs.is_held else _WORTH_A_LOOK):
            fits = _least_through(p, rows, slots, solved, costs, classes) <= limit
            slots[p].local[rows[~fits]] = np.inf
            rows = rows[fits]
        added[p] = rows
    return added


def _least_through(
    p: int, rows: np.ndarray, slots: list[Slot], solved: Solution, costs: TransitionCosts, classes: EntryClasses
) -> np.ndarray:
    """A tighter bound for inactive nodes: joins with active neighbours without DSC, those with imaginary ones least."""
    bound = slots[p].local[rows].copy()
    if len(slots) == 1:
        return bound
    step = max(1, _PAIRS_AT_A_LOOK // max(len(slots[q].active) for q in (p - 1, p + 1) if 0 <= q < len(slots)))
    for first in range(0, len(rows), step):
        part = rows[first : first + step]
        around = bound[first : first + step]
        if p:
            joins = costs.least(part, slots[p - 1].active) + solved.relaxed[p - 1]
            around += np.minimum(joins.min(axis=1), solved.reach_unseen[p][classes.follows[part]])
        if p + 1 < len(slots):
            joins = costs.least(slots[p + 1].active, part) + solved.following[p + 1][:, None]
            around += np.minimum(joins.min(axis=0), solved.leave_unseen[p][classes.viseme[part]])
    return bound


def _drop(slots: list[Slot], solved: Solution, limit: float) -> None:
    """Take active nodes out of the lattice that lie on no path within ``limit``."""
    kept = [solved.least_through(p, slot) <= limit for p, slot in enumerate(slots)]
    for p, (slot, keep) in enumerate(zip(slots, kept)):
        if keep.all():
            continue
        slot.local[slot.active[~keep]] = np.inf
        slot.active = slot.active[keep]
        if p:
            slot.arriving = slot.arriving[keep]
        if p + 1 < len(slots):
            slots[p + 1].arriving = slots[p + 1].arriving[:, keep]
