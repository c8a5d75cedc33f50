"""The arithmetic that a search asks for, and its plain reference.

One step of the dynamic programming (Algorithm 1 of Deng and Neumann 2008) is a min-plus product of the transition
matrix with the front of costs so far. The matrix is rounded to float32 once, when it is made; every sum after that is
float64 in each backend, so that all backends give the same bits and therefore the same path, ties included.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.motion.node import NIL, NodeTable
from core.progress import SILENT, Progress
from core.search.terms import TransitionTerms
from core.search.weights import SearchWeights


@dataclass(frozen=True)
class DeviceReport:
    """Which driver really runs: backend name, device name, API version, and whether it is software."""

    backend: str
    device: str
    api: str
    software: bool


class SearchKernels(Protocol):
    """What a compute backend offers to the search."""

    report: DeviceReport

    def prepare(self, transition: np.ndarray) -> None:
        """Take the matrix of `transition_matrix`, float32, shape (n_nodes, n_nodes), row = node arrived at."""

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """Return ``min_n(front[n] + transition[m, n])`` for every m; float64, shape (n_nodes,)."""

    def release(self) -> None:
        """Free the device's memory."""


class NumpyKernels:
    """The reference: float64 sums in blocks that stay in the cache."""

    report = DeviceReport("numpy", "CPU", f"numpy {np.__version__}", True)

    def __init__(self) -> None:
        self._transition = np.zeros((0, 0), np.float32)

    def prepare(self, transition: np.ndarray) -> None:
        """See `SearchKernels.prepare`."""
        self._transition = transition

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """See `SearchKernels.min_plus`."""
        arrived = np.empty(len(self._transition))
        rows = max(1, (1 << 20) // (8 * len(front)))
        sums = np.empty((rows, len(front)))
        for first in range(0, len(arrived), rows):
            block = self._transition[first : first + rows]
            np.add(block, front, out=sums[: len(block)])
            arrived[first : first + rows] = sums[: len(block)].min(axis=1)
        return arrived

    def release(self) -> None:
        """See `SearchKernels.release`."""
        self._transition = np.zeros((0, 0), np.float32)


def transition_matrix(terms: TransitionTerms, weights: SearchWeights, progress: Progress = SILENT) -> np.ndarray:
    """TC of table 1 for all pairs: ``matrix[m, n]`` is the cost of following motion node n by motion node m.

    Rule 1 (n is m's captured predecessor) is free; rules 2 and 3 price the blend and the gap, with PNT added when the
    visemes differ; rule 4 (m has no predecessor) is ``α1 · PNT``.

    returns : float32, shape (n_nodes, n_nodes)
    """
    nodes: NodeTable = terms.nodes
    n_nodes = len(nodes)
    matrix = np.full((n_nodes, n_nodes), weights.alpha1 * weights.pnt, np.float32)
    done = 0
    with_pre = np.flatnonzero(nodes.pre != NIL)
    for block in terms.blocks():
        cost = weights.alpha3 * block.position_gap
        cost += block.velocity_gap
        cost += weights.alpha2 * block.smoothing
        cost += weights.pnt * block.viseme_differs
        matrix[block.targets] = cost
        done += len(block.targets)
        progress.step(done / len(with_pre), "pricing transitions")
    matrix[with_pre, nodes.pre[with_pre]] = 0.0
    return matrix
