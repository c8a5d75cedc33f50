"""A search that stays alive while its request is edited."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath
from core.search.compute import SearchKernels
from core.search.constraints import SearchRequest, check_feasible
from core.search.solve import solve
from core.search.tables import SearchTables
from core.search.transitions import TransitionCosts

_FEW_STEPS = 2  # passes over the matrix that are quicker than a relaxation from scratch


@dataclass(frozen=True)
class Alternative:
    """A motion node that could stand in a slot; ``price`` is the exact cost added if it is forced there."""

    node: int
    price: float


class SearchSession:
    """The current best path of one utterance, and the price of every alternative.

    `update` answers an edit; `refresh` renews the tables that prices are read from, which takes one pass over the
    transition matrix a slot, and may run later. An answer never depends on a stale table. The kernels must have been
    prepared with the matrix of the transition costs.
    """

    def __init__(self, request: SearchRequest, costs: TransitionCosts, kernels: SearchKernels) -> None:
        self._costs = costs
        self._kernels = kernels
        self._tables: SearchTables | None = None
        self.request = request
        self.path = self._solve()

    def update(self, request: SearchRequest) -> MotionPath:
        """Answer an edited request; raises `UserFacingError`, leaving everything as it was, when it is infeasible.

        Removing nodes that are off the best path changes neither path nor cost: removal only takes paths away, and
        the best one is still there. But table entries that ran through a removed node are stale from then on, so the
        tables are marked invalid wherever a local cost changed, and renewed before their next use.
        """
        nodes = self._costs.terms.nodes
        check_feasible(request, nodes)
        before = self.request
        same_length = request.n_slots == before.n_slots
        if self._tables is not None:
            if same_length:
                self._tables.change(request)
            else:
                self._tables = None
        self.request = request
        if not (same_length and self._keeps_path(before, request)):
            self.path = self._answer()
        return self.path

    def _keeps_path(self, before: SearchRequest, request: SearchRequest) -> bool:
        """Whether the edit only takes away nodes that the best path does not use."""
        return (
            np.array_equal(before.phonemes, request.phonemes)
            and np.array_equal(before.emotions, request.emotions)
            and np.array_equal(before.lengths, request.lengths)
            and dict(before.pins) == dict(request.pins)
            and before.removed <= request.removed
            and not request.removed.intersection(self.path.nodes.tolist())
        )

    def _answer(self) -> MotionPath:
        tables = self._tables
        if tables is not None and tables.missing_steps <= _FEW_STEPS:
            path = tables.best()
            if path is not None:
                return path
        return self._solve()

    def _solve(self) -> MotionPath:
        return solve(self.request, self._costs, lambda: self._kernels)

    def reweight(self) -> MotionPath:
        """Answer again after the weights of the transition costs were changed (and the kernels prepared anew)."""
        self._tables = None
        self.path = self._solve()
        return self.path

    @property
    def has_prices(self) -> bool:
        """Whether `prices` can be read without a `refresh`."""
        return self._tables is not None and self._tables.is_whole

    def refresh(self, progress: Progress = SILENT) -> None:
        """Make the tables whole."""
        if self._tables is None:
            self._tables = SearchTables(self.request, self._costs, self._kernels)
        self._tables.refresh(progress)

    def prices(self, slot: int) -> np.ndarray:
        """Exact extra cost of forcing each node into ``slot``: its min-marginal minus the optimum.

        float64, shape (n_nodes,), >= 0, 0 for the node in use; inf for removed nodes, and for all but the pinned node
        of a pinned slot. Renews the tables first if an edit made them stale.
        """
        if not 0 <= slot < self.request.n_slots:
            raise UserFacingError(f"There is no slot {slot}; the sentence has slots 0 to {self.request.n_slots - 1}.")
        self.refresh()
        extra = self._tables.min_marginals(slot) - self.path.cost
        extra[self.path.nodes[slot]] = 0.0
        return extra.clip(0.0)

    def alternatives(self, slot: int, count: int) -> list[Alternative]:
        """Return the ``count`` cheapest nodes for ``slot``, the one in use first."""
        prices = self.prices(slot)
        order = np.argsort(prices, kind="stable")
        order = order[order != self.path.nodes[slot]]
        ranked = [int(self.path.nodes[slot]), *order[np.isfinite(prices[order])].tolist()]
        return [Alternative(row, float(prices[row])) for row in ranked[:count]]

    def breakdown(self) -> list[Mapping[str, float]]:
        """Cost of each slot by term: observation, emotion, and what arriving took.

        That is position, velocity, smoothing and viseme, or no_predecessor (rule 4 of table 1). All in the unit of
        COST; the terms of a slot sum to its cost.
        """
        terms, weights, nodes = self._costs.terms, self._costs.weights, self._costs.terms.nodes
        rows = []
        for p, m in enumerate(self.path.nodes):
            row = dict.fromkeys(("position", "velocity", "smoothing", "viseme", "no_predecessor"), 0.0)
            if p and nodes.pre[m] < 0:
                row["no_predecessor"] = weights.alpha1 * weights.pnt
            elif p and nodes.pre[m] != self.path.nodes[p - 1]:
                position, velocity, smoothing, differs = terms.of_pair(self.path.nodes[p - 1], m)
                row.update(position=weights.alpha3 * position, velocity=velocity, smoothing=weights.alpha2 * smoothing,
                           viseme=weights.pnt * differs)  # fmt: skip
            row.update(observation=float(self.path.observation[p]), emotion=float(self.path.emotion[p]))
            rows.append(row)
        return rows
