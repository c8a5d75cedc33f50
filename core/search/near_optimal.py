"""Several paths that are nearly as good as the best one, and differ from it and from each other."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from core.motion.node import NIL
from core.search.best_path import MotionPath, slot_costs
from core.search.constraints import SearchRequest
from core.search.context import SILENCE
from core.search.transitions import TransitionCosts

_BREADTH = 100  # motion nodes of a slot that are looked at


@dataclass(frozen=True)
class NearOptimalPath:
    """Rows of motion nodes, int, shape (n_slots,), and their COST (equation 4)."""

    nodes: np.ndarray
    cost: float


def near_optimal_paths(
    request: SearchRequest, best: MotionPath, costs: TransitionCosts, count: int, surcharge: float
) -> list[NearOptimalPath]:
    """Return ``count`` paths, the best one first; each is the cheapest when every earlier use of a node costs extra.

    Only the nodes that fit each slot best by themselves are looked at, so nothing is proved, and it takes little time
    beside the search for the best path. A surcharge, rather than taking used nodes away, leaves a phone that was
    captured once with its one node; pinned nodes stay.

    surcharge : of one earlier use of a node, in PNT
    """
    paths = [NearOptimalPath(best.nodes, best.cost)]
    if count == 1:
        return paths
    local = [slot_costs(request, p, costs.terms.nodes, costs.weights) for p in range(request.n_slots)]
    rows = _candidates(request, best, local, costs)
    local = [own[fitting] for own, fitting in zip(local, rows)]
    joins = [costs.block(after, before) for before, after in itertools.pairwise(rows)]
    uses = np.zeros(len(costs.terms.nodes))
    np.add.at(uses, best.nodes, 1.0)
    while len(paths) < count:
        charged = [own + surcharge * costs.weights.pnt * uses[fitting] for own, fitting in zip(local, rows)]
        places = _cheapest(charged, joins)
        cost = sum(own[place] for own, place in zip(local, places))
        cost += sum(float(join[after, before]) for join, before, after in zip(joins, places, places[1:]))
        found = np.array([fitting[place] for fitting, place in zip(rows, places)])
        paths.append(NearOptimalPath(found, float(cost)))
        np.add.at(uses, found, 1.0)
    return paths


def _candidates(
    request: SearchRequest, best: MotionPath, local: list[np.ndarray], costs: TransitionCosts
) -> list[np.ndarray]:
    """Rows that fit a slot by themselves; for a silence, which any node fits, those captured beside its neighbours."""
    nodes = costs.terms.nodes
    spoken = [p for p in range(request.n_slots) if request.phonemes[p] != SILENCE or p in request.pins]
    rows = [best.nodes[p : p + 1] for p in range(request.n_slots)]
    for p in spoken:
        n = min(_BREADTH, len(nodes))
        fitting = np.argpartition(local[p], n - 1)[:n]
        rows[p] = np.union1d(rows[p], fitting[np.isfinite(local[p][fitting])])
    for p in set(range(request.n_slots)).difference(spoken):
        beside = [rows[p]]
        if p + 1 in spoken:
            beside.append(nodes.pre[rows[p + 1]])
        if p - 1 in spoken:
            beside.append(nodes.suc[rows[p - 1]])
        captured = np.unique(np.concatenate(beside))
        captured = captured[captured != NIL]
        rows[p] = captured[np.isfinite(local[p][captured])]
    return rows


def _cheapest(local: list[np.ndarray], joins: list[np.ndarray]) -> list[int]:
    fronts = [local[0]]
    for own, join in zip(local[1:], joins):
        fronts.append(own + (join + fronts[-1]).min(axis=1))
    places = [int(fronts[-1].argmin())]
    for join, front in zip(joins[::-1], fronts[-2::-1]):
        places.append(int((join[places[-1]] + front).argmin()))
    return places[::-1]
