"""The best path of motion nodes through a database, exactly (Deng and Neumann 2008, Algorithm 1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.motion.node import NodeTable
from core.progress import SILENT, Progress
from core.search.compute import SearchKernels
from core.search.constraints import SearchRequest, blocked_nodes, check_feasible
from core.search.terms import emotion_mismatch_penalties, observation_costs
from core.search.weights import SearchWeights


@dataclass(frozen=True)
class MotionPath:
    """The answer of a search.

    nodes : int, shape (n_slots,), rows of the motion nodes
    observation, emotion : float64, shape (n_slots,), the slot's own costs
    transition : float64, shape (n_slots,), the cost of arriving in the slot; 0 in the first
    """

    nodes: np.ndarray
    observation: np.ndarray
    transition: np.ndarray
    emotion: np.ndarray

    @property
    def cost(self) -> float:
        """COST of equation 4."""
        return float(self.observation.sum() + self.transition.sum() + self.emotion.sum())


def find_path(
    request: SearchRequest,
    nodes: NodeTable,
    transition: np.ndarray,
    weights: SearchWeights,
    kernels: SearchKernels,
    progress: Progress = SILENT,
) -> MotionPath:
    """Find the path of least COST (equation 4) that satisfies ``request``.

    transition : from `core.search.compute.transition_matrix`; ``kernels`` were prepared with it
    Equal costs go to the lowest row. Raises `UserFacingError` when the request cannot be satisfied.
    """
    check_feasible(request, nodes)
    n_nodes = len(nodes)
    fronts = np.empty((request.n_slots, n_nodes))
    for p in range(request.n_slots):
        fronts[p] = slot_costs(request, p, nodes, weights)
        if p:
            fronts[p] += kernels.min_plus(fronts[p - 1])
        progress.step((p + 1) / request.n_slots, "searching motion nodes")
    path = _trace_back(fronts, transition)
    return priced(path, request, nodes, transition, weights)


def slot_costs(request: SearchRequest, slot: int, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """OC + EMP + B of one slot for every node; float64, shape (n_nodes,); inf where blocked."""
    cost = observation_costs(request.phonemes[slot : slot + 1], nodes, weights)[0]
    cost += emotion_mismatch_penalties(request.emotions[slot : slot + 1], nodes, weights)[0]
    cost[blocked_nodes(request, slot, len(nodes))] = np.inf
    return cost


def _trace_back(fronts: np.ndarray, transition: np.ndarray) -> np.ndarray:
    """Walk back along the best path; the arguments of the minima are found only here, where they are needed."""
    path = np.empty(len(fronts), int)
    path[-1] = fronts[-1].argmin()
    for p in range(len(fronts) - 2, -1, -1):
        path[p] = (fronts[p] + transition[path[p + 1]]).argmin()
    return path


def priced(
    path: np.ndarray, request: SearchRequest, nodes: NodeTable, transition: np.ndarray, weights: SearchWeights
) -> MotionPath:
    """Break the cost of ``path`` down by slot and term."""
    slots = np.arange(request.n_slots)
    observation = np.array([observation_costs(request.phonemes[p : p + 1], nodes, weights)[0, path[p]] for p in slots])
    emotion = weights.alpha6 * weights.pnt * (1.0 - request.emotions[slots, nodes.emotion[path]])
    arriving = np.zeros(request.n_slots)
    arriving[1:] = transition[path[1:], path[:-1]]
    return MotionPath(path, observation, arriving, emotion)
