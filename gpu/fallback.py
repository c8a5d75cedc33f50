"""A compute backend whose device may fail in mid-work."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from core.search.compute import DeviceFailed, DeviceReport, NumpyKernels, SearchKernels

log = logging.getLogger("gpu")
Answer = TypeVar("Answer")


class FallbackKernels:
    """`SearchKernels` that go on with numpy when their device fails.

    All backends give the same bits, so a search that loses its device half-way ends with the same answer. ``report``
    then names numpy, and in ``lost`` the device that failed.
    """

    def __init__(self, kernels: SearchKernels) -> None:
        self._kernels = kernels
        self._transition: np.ndarray | None = None
        self.report: DeviceReport = kernels.report

    def prepare(self, transition: np.ndarray) -> None:
        """See `SearchKernels.prepare`."""
        self._transition = transition
        self._attempt(lambda kernels: kernels.prepare(transition))

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        """See `SearchKernels.min_plus`."""
        return self._attempt(lambda kernels: kernels.min_plus(front))

    def min_plus_both(self, front: np.ndarray, behind: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """See `SearchKernels.min_plus_both`."""
        return self._attempt(lambda kernels: kernels.min_plus_both(front, behind))

    def release(self) -> None:
        """See `SearchKernels.release`."""
        self._transition = None
        self._attempt(lambda kernels: kernels.release())

    def _attempt(self, work: Callable[[SearchKernels], Answer]) -> Answer:
        try:
            return work(self._kernels)
        except DeviceFailed as error:
            self._go_on_with_numpy(error)
        return work(self._kernels)

    def _go_on_with_numpy(self, error: DeviceFailed) -> None:
        self.report = replace(NumpyKernels.report, lost=f"{error} The search goes on with numpy.")
        log.warning(self.report.lost)
        with contextlib.suppress(DeviceFailed):
            self._kernels.release()
        self._kernels = NumpyKernels()
        if self._transition is not None:
            self._kernels.prepare(self._transition)
