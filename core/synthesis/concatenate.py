"""From a path of motion nodes to one stretch of frames (Deng and Neumann 2008, section 7.2)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.motion.node import NodeTable
from core.motion.resample import frame_bounds
from core.search.terms import warp_matrix


@dataclass(frozen=True)
class SlotFrames:
    """Where each phoneme slot lies among the frames of a synthesis.

    start, stop : int, shape (n_slots,); neighbours share a boundary, a slot shorter than a frame may be empty
    n_frames : frames in all
    """

    start: np.ndarray
    stop: np.ndarray

    @property
    def n_frames(self) -> int:
        """Number of frames in all."""
        return int(self.stop[-1])

    @classmethod
    def of(cls, starts_s: Sequence[float], ends_s: Sequence[float], rate_hz: float) -> SlotFrames:
        """Round the boundaries of contiguous slots, in seconds from 0, to frames; one frame at least in all."""
        start, stop = frame_bounds(starts_s, ends_s, rate_hz)
        stop[-1] = max(stop[-1], 1)
        return cls(start, stop)


def concatenate(path: np.ndarray, slots: SlotFrames, frames: np.ndarray, nodes: NodeTable) -> np.ndarray:
    """Time-warp each node of ``path`` to its slot and lay them end to end.

    path : int, shape (n_slots,), rows of nodes
    frames : shape (n_all_frames, n_dims), the database's coefficients
    returns : float64, shape (slots.n_frames, n_dims)
    """
    laid = np.zeros((slots.n_frames, frames.shape[1]))
    for p, row in enumerate(path):
        length = int(slots.stop[p] - slots.start[p])
        if length:
            captured = frames[nodes.start[row] : nodes.stop[row]].astype(float)
            laid[slots.start[p] : slots.stop[p]] = warp_matrix(len(captured), length) @ captured
    return laid
