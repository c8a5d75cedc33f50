"""The best path of motion nodes through a database, exactly (Deng and Neumann 2008, Algorithm 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.motion.node import NodeTable
from core.progress import SILENT, Progress
from core.search.compute import SearchKernels
from core.search.constraints import SearchRequest, blocked_nodes, check_feasible
from core.search.context import SILENCE, context_costs, duration_costs
from core.search.terms import emotion_mismatch_penalties, observation_costs
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights


@dataclass(frozen=True)
class MotionPath:
    """The answer of a search.

    nodes : int, shape (n_slots,), rows of the motion nodes
    observation, emotion : float64, shape (n_slots,), the slot's own costs
    transition : float64, shape (n_slots,), the cost of arriving in the slot; 0 in the first
    lower_bound : no path that satisfies the request costs less than this
    """

    nodes: np.ndarray
    observation: np.ndarray
    transition: np.ndarray
    emotion: np.ndarray
    lower_bound: float

    @property
    def cost(self) -> float:
        """COST of equation 4."""
        return float(self.observation.sum() + self.transition.sum() + self.emotion.sum())

    @property
    def gap(self) -> float:
        """How far the cost can be from the least possible, over the cost; 0 when it is proved optimal."""
        return 0.0 if self.is_optimal else (self.cost - self.lower_bound) / self.cost

    @property
    def is_optimal(self) -> bool:
        """Whether the bound proves that no path is better (up to the rounding of float64 sums)."""
        return self.lower_bound >= self.cost * (1.0 - 1e-12)


def find_path(
    request: SearchRequest,
    costs: TransitionCosts,
    kernels: SearchKernels,
    progress: Progress = SILENT,
) -> MotionPath:
    """Find the path of least COST (equation 4) that satisfies ``request``, looking at every node in every slot.

    kernels : prepared with ``costs.matrix``
    Equal costs go to the lowest row. Raises `UserFacingError` when the request cannot be satisfied.
    """
    nodes = costs.terms.nodes
    check_feasible(request, nodes)
    fronts = np.empty((request.n_slots, len(nodes)))
    for p in range(request.n_slots):
        fronts[p] = slot_costs(request, p, nodes, costs.weights)
        if p:
            fronts[p] += kernels.min_plus(fronts[p - 1])
        progress.step((p + 1) / request.n_slots, "searching motion nodes")
    path = np.empty(request.n_slots, int)
    path[-1] = fronts[-1].argmin()
    for p in range(request.n_slots - 2, -1, -1):
        # the arguments of the minima are found only here, where they are needed
        path[p] = (fronts[p] + costs.matrix[path[p + 1]]).argmin()
    return priced(path, request, costs)


def observed(request: SearchRequest, slot: int, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """OC of one slot for every node, float64, shape (n_nodes,): table 2 and `core.search.context`."""
    cost = observation_costs(request.phonemes[slot : slot + 1], nodes, weights)[0]
    if weights.context_before or weights.context_after:
        cost += context_costs(request.phonemes, slot, nodes, weights)
    if weights.duration and request.lengths is not None and request.phonemes[slot] != SILENCE:
        cost += duration_costs(request.lengths[slot], nodes, weights)
    return cost


def slot_costs(request: SearchRequest, slot: int, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """OC + EMP + B of one slot for every node; float64, shape (n_nodes,); inf where blocked."""
    cost = observed(request, slot, nodes, weights)
    cost += emotion_mismatch_penalties(request.emotions[slot : slot + 1], nodes, weights)[0]
    cost[blocked_nodes(request, slot, len(nodes))] = np.inf
    return cost


def priced(
    path: np.ndarray, request: SearchRequest, costs: TransitionCosts, lower_bound: float | None = None
) -> MotionPath:
    """Break the cost of ``path`` down by slot and term. Without a ``lower_bound`` the path is known to be optimal."""
    nodes, weights = costs.terms.nodes, costs.weights
    slots = np.arange(request.n_slots)
    observation = np.array([observed(request, p, nodes, weights)[path[p]] for p in slots])
    emotion = weights.alpha6 * weights.pnt * (1.0 - request.emotions[slots, nodes.emotion[path]])
    arriving = np.zeros(request.n_slots)
    for p in slots[1:]:
        arriving[p] = costs.block(path[p : p + 1], path[p - 1 : p])[0, 0]
    answer = MotionPath(path, observation, arriving, emotion, 0.0)
    bound = answer.cost if lower_bound is None else min(lower_bound, answer.cost)
    return MotionPath(path, observation, arriving, emotion, bound)
