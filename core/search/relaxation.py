"""The best path without looking at most of the database, and the proof that nothing better was left out.

In every slot a few motion nodes are *active*; all others of that slot stand behind one imaginary node that has the
least local cost among them and is reached and left for free. Transition costs are never negative, so every real path
costs at least as much as its image in this relaxed lattice, and:

- the best path over active nodes alone is an upper bound;
- the best path through the relaxed lattice is a lower bound;
- an inactive node n of slot p lies on no path cheaper than ``F(p) + local(p, n) + B(p)``, F and B being the least cost
  of reaching and of leaving the imaginary node of p in the relaxed lattice.

Slots whose imaginary node may lie on a best path are settled: nodes that the last bound does not exclude become active,
the others can lie on no best path, and the imaginary node goes. The lattice is solved again until no slot is left to
settle: then every optimal path runs through active nodes, and the answer is exact, ties included. With phoneme and
emotion penalties that are worth more than the smoothest join, as in any useful setting of the weights, the first rounds
do it.
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
from core.search.transitions import TransitionCosts

_ROUNDING = 1e-12  # relative; sums of a few hundred float64 costs differ by less when their order changes
FIRST_REACH = 2.1  # in PNT above the least local cost: the phone itself in any emotion, under the default weights

MOST_AT_FIRST = 1000
_FINITE = np.finfo(float).max
_WORTH_A_LOOK = 500  # inactive nodes of a slot for which a tighter bound costs less than their activation


@dataclass(frozen=True)
class Round:
    """One solution of the relaxed lattice: seconds since the start, bounds, and active nodes over all slots."""

    seconds: float
    lower_bound: float
    upper_bound: float
    n_active: int


@dataclass
class _Slot:
    """The lattice of one slot.

    local : float64, shape (n_nodes,), OC + EMP + B
    active : int, ascending rows
    rest : least local cost of the inactive nodes, inf when there is none, or none that could lie on a best path
    arriving : float32, shape (n_active, n_active of the slot before), transition costs; None until asked for
    """

    local: np.ndarray
    active: np.ndarray
    rest: float = np.inf
    arriving: np.ndarray | None = None


def find_path_by_relaxation(
    request: SearchRequest,
    costs: TransitionCosts,
    progress: Progress = SILENT,
    limit_s: float = np.inf,
    on_round: Callable[[Round], None] = lambda _: None,
    most_pairs: float = np.inf,
) -> MotionPath | None:
    """Find the path of least COST (equation 4 of Deng and Neumann 2008) that satisfies ``request``.

    The answer equals that of `core.search.best_path.find_path`, ties included, and carries the bound that proves it.
    After ``limit_s`` seconds, or when the lattice would come to hold more than ``most_pairs`` transitions, the best
    path so far is returned with the bound reached so far; None when already the first lattice would, as when a sentence
    is full of phonemes that the database lacks.
    Raises `UserFacingError` when the request cannot be satisfied.
    """
    nodes, weights = costs.terms.nodes, costs.weights
    check_feasible(request, nodes)
    began = time.perf_counter()
    slots = [_first_active(slot_costs(request, p, nodes, weights), weights.pnt) for p in range(request.n_slots)]
    if not costs.is_held:
        _thin_out_silences(slots, costs)
    best, lower_bound = None, 0.0
    while True:
        if sum(len(b.active) * len(a.active) for b, a in itertools.pairwise(slots)) > most_pairs:
            return None if best is None else priced(best, request, costs, lower_bound)
        for p, slot in enumerate(slots):
            if p and slot.arriving is None:
                slot.arriving = costs.block(slot.active, slots[p - 1].active)
            progress.step(min(0.9, (time.perf_counter() - began) / max(limit_s, 1.0)), "searching motion nodes")
        solved = _solve(slots)
        best, upper = _trace_back(slots, solved.real), float(solved.real[-1].min())
        lower_bound = max(lower_bound, solved.lower_bound)
        seconds = time.perf_counter() - began
        on_round(Round(seconds, lower_bound, upper, sum(len(slot.active) for slot in slots)))
        complete = not _examine(slots, solved, upper, costs)
        if complete or seconds > limit_s:
            return priced(best, request, costs, None if complete else lower_bound)


def _first_active(local: np.ndarray, pnt: float) -> _Slot:
    active = np.flatnonzero(local <= local.min() + FIRST_REACH * pnt)
    if len(active) > MOST_AT_FIRST:  # in a silence every node does; the bounds will tell which others matter
        active = np.flatnonzero(local <= local.min())
    return _slot_with(local, active)


def _slot_with(local: np.ndarray, active: np.ndarray) -> _Slot:
    inactive = local.copy()
    inactive[active] = np.inf
    return _Slot(local, active, float(inactive.min()))


def _thin_out_silences(slots: list[_Slot], costs: TransitionCosts) -> None:
    """Let a slot in which nearly everything fits start with what was captured next to its neighbours' active nodes."""
    nodes = costs.terms.nodes
    crowded = [p for p, slot in enumerate(slots) if len(slot.active) > MOST_AT_FIRST]
    for p in crowded:
        beside = [nodes.suc[slots[p - 1].active]] if p and p - 1 not in crowded else []
        if p + 1 < len(slots) and p + 1 not in crowded:
            beside.append(nodes.pre[slots[p + 1].active])
        captured = np.intersect1d(np.concatenate(beside), slots[p].active) if beside else ()
        if len(captured):
            slots[p] = _slot_with(slots[p].local, captured)


@dataclass(frozen=True)
class _Solution:
    """Least costs in the lattice, a list entry a slot.

    real : over active nodes alone, each float64, shape (n_active,), the node's own cost included
    relaxed, following : the same in the relaxed lattice, of what ends and of what starts in each active node
    reach : of reaching the imaginary node, its own cost left out; leave : of what follows it
    """

    real: list[np.ndarray]
    relaxed: list[np.ndarray]
    following: list[np.ndarray]
    reach: list[float]
    leave: list[float]
    lower_bound: float


def _solve(slots: list[_Slot]) -> _Solution:
    own = [slot.local[slot.active] for slot in slots]
    real, relaxed, reach = [own[0]], [own[0]], [0.0]
    for p in range(1, len(slots)):
        before, slot = slots[p - 1], slots[p]
        imaginary = reach[-1] + before.rest
        real.append(own[p] + (slot.arriving + real[-1]).min(axis=1))
        reach.append(min(float(relaxed[-1].min()), imaginary))
        relaxed.append(own[p] + np.minimum((slot.arriving + relaxed[-1]).min(axis=1), imaginary))
    lower_bound = min(float(relaxed[-1].min()), reach[-1] + slots[-1].rest)

    following, leave = [own[-1]], [0.0]
    for p in range(len(slots) - 2, -1, -1):
        imaginary = slots[p + 1].rest + leave[-1]
        leave.append(min(float(following[-1].min()), imaginary))
        onward = (slots[p + 1].arriving + following[-1][:, None]).min(axis=0)
        following.append(own[p] + np.minimum(onward, imaginary))
    return _Solution(real, relaxed, following[::-1], reach, leave[::-1], lower_bound)


def _examine(slots: list[_Slot], solved: _Solution, upper: float, costs: TransitionCosts) -> int:
    """Settle the slots whose imaginary node may lie on a best path; return how many that were.

    In such a slot every inactive node either becomes active or is excluded for good, so the imaginary node goes. As
    long as the bounds differ, only slots on a best relaxed path are settled: raising the lower bound spares the others.
    """
    limit = upper * (1.0 + _ROUNDING)
    worst = limit if solved.lower_bound >= upper * (1.0 - _ROUNDING) else solved.lower_bound * (1.0 + _ROUNDING)
    activated: dict[int, np.ndarray] = {}
    for p, slot in enumerate(slots):
        around = solved.reach[p] + solved.leave[p]
        if not around + slot.rest <= min(worst, _FINITE):
            continue
        possible = slot.local <= limit - around
        possible[slot.active] = False
        rows = np.flatnonzero(possible)
        if len(rows) > _WORTH_A_LOOK and not costs.is_held:
            rows = rows[_least_through(p, rows, slots, solved, costs) <= limit]
        activated[p] = rows
    for p, rows in activated.items():
        slots[p].rest = np.inf
        if len(rows):
            slots[p] = _Slot(slots[p].local, np.union1d(slots[p].active, rows))
            if p + 1 < len(slots):
                slots[p + 1].arriving = None
    return len(activated)


def _least_through(
    p: int, rows: np.ndarray, slots: list[_Slot], solved: _Solution, costs: TransitionCosts
) -> np.ndarray:
    """A tighter bound for inactive nodes: joins with active neighbours at their least, with imaginary ones free."""
    bound = slots[p].local[rows].copy()
    for first in range(0, len(rows), 4000):
        part = slice(first, first + 4000)
        if p:
            joins = costs.terms.least_costs(rows[part], slots[p - 1].active, costs.weights) + solved.relaxed[p - 1]
            bound[part] += np.minimum(joins.min(axis=1), solved.reach[p - 1] + slots[p - 1].rest)
        if p + 1 < len(slots):
            joins = costs.terms.least_costs(slots[p + 1].active, rows[part], costs.weights)
            joins += solved.following[p + 1][:, None]
            bound[part] += np.minimum(joins.min(axis=0), slots[p + 1].rest + solved.leave[p + 1])
    return bound


def _trace_back(slots: list[_Slot], real: list[np.ndarray]) -> np.ndarray:
    """Walk back along the best path over active nodes; equal costs go to the lowest row."""
    place = int(real[-1].argmin())
    path = [slots[-1].active[place]]
    for p in range(len(slots) - 1, 0, -1):
        place = int((slots[p].arriving[place] + real[p - 1]).argmin())
        path.append(slots[p - 1].active[place])
    return np.array(path[::-1])
