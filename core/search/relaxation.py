"""The best path without looking at most of the database, and the proof that nothing better was left out.

In every slot a few motion nodes are *active*; all others of that slot stand behind one imaginary node that has the
least local cost among them and is reached and left for free. Transition costs are never negative, so every real path
costs at least as much as its image in this relaxed lattice, and:

- the best path over active nodes alone is an upper bound;
- the best path through the relaxed lattice is a lower bound;
- an inactive node n of slot p lies on no path cheaper than ``F(p) + local(p, n) + B(p)``, F and B being the least cost
  of reaching and of leaving the imaginary node of p in the relaxed lattice.

Nodes for which the last bound does not exceed the upper bound become active and the lattice is solved again. When none
is left, every optimal path runs through active nodes only: the answer is exact, ties included. With phoneme and emotion
penalties that are worth more than the smoothest join, as in any useful setting of the weights, the first rounds settle
it.
"""

from __future__ import annotations

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
    rest : least local cost of the inactive nodes, inf when there is none
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
) -> MotionPath:
    """Find the path of least COST (equation 4 of Deng and Neumann 2008) that satisfies ``request``.

    The answer equals that of `core.search.best_path.find_path`, ties included, and carries the bound that proves it.
    After ``limit_s`` seconds the best path so far is returned with the bound reached so far.
    Raises `UserFacingError` when the request cannot be satisfied.
    """
    nodes, weights = costs.terms.nodes, costs.weights
    check_feasible(request, nodes)
    began = time.perf_counter()
    slots = [_first_active(slot_costs(request, p, nodes, weights), weights.pnt) for p in range(request.n_slots)]
    while True:
        for p, slot in enumerate(slots):
            if p and slot.arriving is None:
                slot.arriving = costs.block(slot.active, slots[p - 1].active)
            progress.step(min(0.9, (time.perf_counter() - began) / max(limit_s, 1.0)), "searching motion nodes")
        solved = _solve(slots)
        upper, lower = float(solved.real[-1].min()), solved.lower_bound
        seconds = time.perf_counter() - began
        on_round(Round(seconds, lower, upper, sum(len(slot.active) for slot in slots)))
        complete = not _activate(slots, solved, upper)
        if complete or seconds > limit_s:
            path = _trace_back(slots, solved.real)
            return priced(path, request, costs, None if complete else lower)


def _first_active(local: np.ndarray, pnt: float) -> _Slot:
    active = np.flatnonzero(local <= local.min() + FIRST_REACH * pnt)
    if len(active) > MOST_AT_FIRST:  # in a silence every node does; the bounds will tell which others matter
        active = np.flatnonzero(local <= local.min())
    return _slot_with(local, active)


def _slot_with(local: np.ndarray, active: np.ndarray) -> _Slot:
    inactive = local.copy()
    inactive[active] = np.inf
    return _Slot(local, active, float(inactive.min()))


@dataclass(frozen=True)
class _Solution:
    """Least costs in the lattice, a list entry a slot.

    real : over active nodes alone, each float64, shape (n_active,), the node's own cost included
    reach : of reaching the imaginary node, its own cost left out; leave : of what follows it
    """

    real: list[np.ndarray]
    reach: list[float]
    leave: list[float]
    lower_bound: float


def _solve(slots: list[_Slot]) -> _Solution:
    own = [slot.local[slot.active] for slot in slots]
    real, relaxed, reach = [own[0]], own[0], [0.0]
    for p in range(1, len(slots)):
        before, slot = slots[p - 1], slots[p]
        imaginary = reach[-1] + before.rest
        real.append(own[p] + (slot.arriving + real[-1]).min(axis=1))
        reach.append(min(float(relaxed.min()), imaginary))
        relaxed = own[p] + np.minimum((slot.arriving + relaxed).min(axis=1), imaginary)
    lower_bound = min(float(relaxed.min()), reach[-1] + slots[-1].rest)

    leaving, leave = np.zeros(len(slots[-1].active)), [0.0]
    for p in range(len(slots) - 2, -1, -1):
        following = own[p + 1] + leaving
        imaginary = slots[p + 1].rest + leave[-1]
        leaving = np.minimum((slots[p + 1].arriving + following[:, None]).min(axis=0), imaginary)
        leave.append(min(float(following.min()), imaginary))
    return _Solution(real, reach, leave[::-1], lower_bound)


def _activate(slots: list[_Slot], solved: _Solution, upper: float) -> int:
    """Make every node active that may lie on a path no dearer than ``upper``; return how many that were."""
    count = 0
    for p, slot in enumerate(slots):
        around = solved.reach[p] + solved.leave[p]
        possible = slot.local <= upper * (1.0 + _ROUNDING) - around
        possible[slot.active] = True
        if possible.sum() == len(slot.active):
            continue
        count += int(possible.sum()) - len(slot.active)
        slots[p] = _slot_with(slot.local, np.flatnonzero(possible))
        if p + 1 < len(slots):
            slots[p + 1].arriving = None
    return count


def _trace_back(slots: list[_Slot], real: list[np.ndarray]) -> np.ndarray:
    """Walk back along the best path over active nodes; equal costs go to the lowest row."""
    place = int(real[-1].argmin())
    path = [slots[-1].active[place]]
    for p in range(len(slots) - 1, 0, -1):
        place = int((slots[p].arriving[place] + real[p - 1]).argmin())
        path.append(slots[p - 1].active[place])
    return np.array(path[::-1])
