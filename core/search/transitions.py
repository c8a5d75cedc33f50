"""Transition costs of a database under given weights: held as one matrix, or produced in tiles when it is too large."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.motion.node import NIL
from core.progress import SILENT, Progress
from core.search.terms import TransitionTerms
from core.search.weights import SearchWeights

BUDGET_BYTES = 2 << 30


@dataclass(frozen=True)
class TransitionParts:
    """The weight-independent terms of all pairs, kept so that a change of weights costs no new matrix products.

    position_gap, velocity_gap, smoothing : float32, shape (n_nodes, n_nodes), row = node arrived at; 0 in rows of
        nodes without a captured predecessor
    """

    position_gap: np.ndarray
    velocity_gap: np.ndarray
    smoothing: np.ndarray

    @classmethod
    def of(cls, terms: TransitionTerms, progress: Progress = SILENT) -> TransitionParts:
        """Compute the terms of all pairs, in 12 n_nodes² bytes."""
        n_nodes = len(terms.nodes)
        parts = cls(*(np.zeros((n_nodes, n_nodes), np.float32) for _ in range(3)))
        done, todo = 0, max(1, int((terms.nodes.pre != NIL).sum()))
        for block in terms.blocks():
            parts.position_gap[block.targets] = block.position_gap
            parts.velocity_gap[block.targets] = block.velocity_gap
            parts.smoothing[block.targets] = block.smoothing
            done += len(block.targets)
            progress.step(done / todo, "pricing transitions")
        return parts

    def weighted(self, terms: TransitionTerms, weights: SearchWeights, out: np.ndarray | None = None) -> np.ndarray:
        """TC of table 1 for all pairs: ``matrix[m, n]`` is the cost of following motion node n by motion node m.

        Rule 1 (n is m's captured predecessor) is free; rules 2 and 3 price the blend and the gap, with PNT added when
        the visemes differ; rule 4 (m has no predecessor) is ``α1 · PNT``.

        returns : float32, shape (n_nodes, n_nodes), in ``out`` when given
        """
        nodes = terms.nodes
        n_nodes = len(nodes)
        matrix = np.empty((n_nodes, n_nodes), np.float32) if out is None else out
        viseme = nodes.viseme
        has_pre = nodes.pre != NIL
        rows = max(1, (4 << 20) // (4 * n_nodes))  # a stripe of each part stays in the cache
        spare = np.empty((rows, n_nodes), np.float32)
        for first in range(0, n_nodes, rows):
            m = slice(first, min(first + rows, n_nodes))
            stripe, extra = matrix[m], spare[: m.stop - first]
            np.multiply(self.position_gap[m], np.float32(weights.alpha3), out=stripe)
            stripe += self.velocity_gap[m]
            np.multiply(self.smoothing[m], np.float32(weights.alpha2), out=extra)
            stripe += extra
            stripe[viseme[nodes.pre[m]][:, None] != viseme[None]] += np.float32(weights.pnt)
            stripe[~has_pre[m]] = weights.alpha1 * weights.pnt
        with_pre = np.flatnonzero(has_pre)
        matrix[with_pre, nodes.pre[with_pre]] = 0.0
        return matrix


PriceParts = Callable[[TransitionTerms, Progress], TransitionParts]


class TransitionCosts:
    """TC for the pairs that a search asks for.

    Within ``budget_bytes`` the weight-independent parts and the matrix are held (16 n_nodes² bytes); beyond it every
    block is computed when asked for, and nothing is kept.

    price : makes the parts of all pairs, as `TransitionParts.of` does
    """

    def __init__(
        self,
        terms: TransitionTerms,
        weights: SearchWeights,
        budget_bytes: int = BUDGET_BYTES,
        price: PriceParts = TransitionParts.of,
    ) -> None:
        self.terms = terms
        self._price = price
        self.weights = weights
        self.is_held = 16 * len(terms.nodes) ** 2 <= budget_bytes
        self._parts: TransitionParts | None = None
        self._matrix: np.ndarray | None = None

    def prepare(self, progress: Progress = SILENT) -> None:
        """Compute what is held; does nothing the second time, or beyond the budget."""
        if self.is_held and self._matrix is None:
            if self._parts is None:
                self._parts = self._price(self.terms, progress)
            self._matrix = self._parts.weighted(self.terms, self.weights)

    def reweight(self, weights: SearchWeights) -> None:
        """Change the weights; the parts stay."""
        if weights != self.weights:
            self.weights = weights
            if self._matrix is not None:
                self._parts.weighted(self.terms, weights, out=self._matrix)

    @property
    def matrix(self) -> np.ndarray:
        """The held matrix; raises `ValueError` beyond the budget."""
        if not self.is_held:
            raise ValueError("the transition matrix is beyond the memory budget")
        self.prepare()
        return self._matrix

    def block(self, targets: np.ndarray, sources: np.ndarray) -> np.ndarray:
        """Return TC of following each of ``sources`` by each of ``targets``; float32, shape (n_targets, n_sources)."""
        if self.is_held:
            return self.matrix[np.ix_(targets, sources)]
        return self.terms.costs(targets, sources, self.weights)

    def least(self, targets: np.ndarray, sources: np.ndarray) -> np.ndarray:
        """Return what `block` cannot fall below, without DSC and much sooner where nothing is held."""
        return self.terms.least_costs(targets, sources, self.weights).astype(np.float32)
