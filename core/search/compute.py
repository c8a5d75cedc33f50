"""The arithmetic that a search asks for, and its plain reference.

One step of the dynamic programming (Algorithm 1 of Deng and Neumann 2008) is a min-plus product of the transition
matrix with the front of costs so far. The matrix is rounded to float32 once, when it is made; every sum after that is
float64 in each backend, so that all backends give the same bits and therefore the same path, ties included.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Protocol

import numpy as np

from core.errors import UserFacingError


@dataclass(frozen=True)
class DeviceReport:
    """What really runs: backend, device, API and driver with their versions, and whether it is software.

    lost : one sentence about the device that failed before, in whose place this one goes on; empty when none did
    """

    backend: str
    device: str
    api: str
    software: bool
    driver: str = ""
    lost: str = ""

    def as_dict(self) -> dict[str, object]:
        """Return it for ``--json``."""
        return asdict(self)


class DeviceFailed(UserFacingError):
    """A compute device was lost, has no room, or gave up in mid-work; the message says which and why."""


class SearchKernels(Protocol):
    """What a compute backend offers to the search. The matrix has the node arrived at as its row.

    A method raises `DeviceFailed` when the device cannot do it.
    """

    report: DeviceReport

    def prepare(self, transition: np.ndarray) -> None:
        """Take the transition matrix, float32, shape (n_nodes, n_nodes)."""

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """One step forward: ``min_n(front[n] + transition[m, n])`` for every m; float64, shape (n_nodes,)."""

    def min_plus_both(self, front: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """One step forward and one backward in a single pass over the matrix.

        returns : ``min_n(front[n] + transition[m, n])`` for every m, and ``min_m(behind[m] + transition[m, n])`` for
            every n; float64, shape (n_nodes,) each
        """

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
        for rows, sums in self._stripes():
            np.add(self._transition[rows], front, out=sums)
            arrived[rows] = sums.min(axis=1)
        return arrived

    def min_plus_both(self, front: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `SearchKernels.min_plus_both`."""
        arrived = np.empty(len(self._transition))
        left = np.full(len(self._transition), np.inf)
        for rows, sums in self._stripes():
            np.add(self._transition[rows], front, out=sums)
            arrived[rows] = sums.min(axis=1)
            np.add(self._transition[rows], behind[rows, None], out=sums)
            np.minimum(left, sums.min(axis=0), out=left)
        return arrived, left

    def _stripes(self):
        n_nodes = len(self._transition)
        n_rows = max(1, (1 << 20) // (8 * n_nodes))
        buffer = np.empty((n_rows, n_nodes))
        for first in range(0, n_nodes, n_rows):
            rows = slice(first, min(first + n_rows, n_nodes))
            yield rows, buffer[: rows.stop - first]

    def release(self) -> None:
        """See `SearchKernels.release`."""
        self._transition = np.zeros((0, 0), np.float32)
