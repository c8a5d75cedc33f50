"""Forward and backward tables over all nodes and slots: prices of every alternative, and answers to edits.

arrive(p, n) is the least cost of what comes before node n in slot p, leave(p, n) of what comes after; neither includes
n's own cost in p. So the least cost of a path through n in p (its min-marginal) is ``arrive + local + leave``, and a
change of the local costs of slot p alters neither table at p: it can be answered at once.
"""

from __future__ import annotations

import numpy as np

from core.motion.node import CONTEXT_REACH
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, priced, slot_costs
from core.search.compute import SearchKernels
from core.search.constraints import SearchRequest
from core.search.transitions import TransitionCosts


class SearchTables:
    """The tables of one request, kept whole or in part.

    ``arrive`` is valid for slots up to ``n_arrive`` - 1 and ``leave`` from ``first_leave`` on. With ``local`` they take
    24 bytes a slot and node.
    """

    def __init__(self, request: SearchRequest, costs: TransitionCosts, kernels: SearchKernels) -> None:
        n_nodes = len(costs.terms.nodes)
        self.request = request
        self._costs = costs
        self._kernels = kernels
        self.local = np.stack(
            [slot_costs(request, p, costs.terms.nodes, costs.weights) for p in range(request.n_slots)]
        )
        self.arrive = np.zeros((request.n_slots, n_nodes))
        self.leave = np.zeros((request.n_slots, n_nodes))
        self.n_arrive = 1
        self.first_leave = request.n_slots - 1

    @property
    def is_whole(self) -> bool:
        """Whether both tables are valid everywhere."""
        return self.n_arrive == self.request.n_slots and self.first_leave == 0

    @property
    def missing_steps(self) -> int:
        """Passes over the matrix until some slot has both tables, each pass serving both directions."""
        return max(0, -(-(self.first_leave - self.n_arrive + 1) // 2))

    def change(self, request: SearchRequest) -> None:
        """Take a new request with as many slots; what the change can have touched becomes invalid, nothing else."""
        changed = []
        for p in range(request.n_slots):
            if _same_slot(self.request, request, p):
                continue
            local = slot_costs(request, p, self._costs.terms.nodes, self._costs.weights)
            if not np.array_equal(local, self.local[p]):
                self.local[p] = local
                changed.append(p)
        self.request = request
        if changed:
            self.n_arrive = min(self.n_arrive, changed[0] + 1)
            self.first_leave = max(self.first_leave, changed[-1])

    def best(self) -> MotionPath | None:
        """Return the best path, advancing both tables until they meet.

        None when several paths cost the same: which one is the answer is settled from the last slot backward.
        """
        while self.n_arrive <= self.first_leave:
            self._advance()
        p = self.first_leave
        return self._path_through(p, self.arrive[p] + self.local[p] + self.leave[p])

    def refresh(self, progress: Progress = SILENT) -> None:
        """Make both tables whole; one pass over the matrix serves a step of each."""
        todo = max(self.request.n_slots - self.n_arrive, self.first_leave, 1)
        while not self.is_whole:
            self._advance()
            left = max(self.request.n_slots - self.n_arrive, self.first_leave)
            progress.step(1.0 - left / todo, "pricing alternatives")

    def min_marginals(self, slot: int) -> np.ndarray:
        """Least cost of a path through each node in ``slot``; float64, shape (n_nodes,), inf where blocked.

        Blocked are removed nodes, and all but the pinned one. Both tables must be valid there.
        """
        return self.arrive[slot] + self.local[slot] + self.leave[slot]

    def _advance(self) -> None:
        forward, backward = self.n_arrive < self.request.n_slots, self.first_leave > 0
        p, q = self.n_arrive, self.first_leave - 1
        if forward and backward:
            front = self.arrive[p - 1] + self.local[p - 1]
            behind = self.local[q + 1] + self.leave[q + 1]
            self.arrive[p], self.leave[q] = self._kernels.min_plus_both(front, behind)
        elif forward:
            self.arrive[p] = self._kernels.min_plus(self.arrive[p - 1] + self.local[p - 1])
        else:
            behind = self.local[q + 1] + self.leave[q + 1]
            _, self.leave[q] = self._kernels.min_plus_both(np.full_like(behind, np.inf), behind)
        self.n_arrive += forward
        self.first_leave -= backward

    def _path_through(self, slot: int, totals: np.ndarray) -> MotionPath | None:
        path = np.empty(self.request.n_slots, int)
        path[slot] = _only_least(totals)
        everyone = np.arange(totals.size)
        for p in range(slot - 1, -1, -1):
            into = self._costs.block(path[p + 1 : p + 2], everyone)[0]
            path[p] = _only_least(self.arrive[p] + self.local[p] + into)
        for p in range(slot + 1, self.request.n_slots):
            out_of = self._costs.block(everyone, path[p - 1 : p])[:, 0]
            path[p] = _only_least(out_of + self.local[p] + self.leave[p])
        if (path < 0).any():
            return None
        return priced(path, self.request, self._costs)


def _only_least(costs: np.ndarray) -> int:
    """Row of the least cost, or -1 when a second one comes within rounding of it."""
    row = int(costs.argmin())
    within = costs <= costs[row] + 1e-9 * max(abs(float(costs[row])), 1e-300)
    return row if np.count_nonzero(within) == 1 else -1


def _same_slot(one: SearchRequest, other: SearchRequest, p: int) -> bool:
    around = slice(max(0, p - CONTEXT_REACH), p + CONTEXT_REACH + 1)  # the phones around count in a slot's own cost
    return (
        np.array_equal(one.phonemes[around], other.phonemes[around])
        and _length(one, p) == _length(other, p)
        and np.array_equal(one.emotions[p], other.emotions[p])
        and one.pins.get(p) == other.pins.get(p)
        and (p in one.pins or one.removed == other.removed)
    )


def _length(request: SearchRequest, p: int) -> int | None:
    return None if request.lengths is None else int(request.lengths[p])
