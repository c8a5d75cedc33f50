"""The suspicion list's jumps and excursions, for each marker of a capture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.suspicion.capture_faults import Excursion, excursions
from core.suspicion.jumps import Jumps

_SHORTEST_RUN = 6


@dataclass(frozen=True)
class MarkerJumps:
    """Jumps of one marker that are clear and large enough.

    at : int64, ascending, a jump leads from frame ``at - 1`` to ``at``
    excursions : what left and came back
    alone : int64, those of ``at`` that no other undoes
    """

    at: np.ndarray
    excursions: tuple[Excursion, ...]
    alone: np.ndarray


def runs(seen: np.ndarray) -> list[tuple[int, int]]:
    """Return (first, one past the last) of each stretch of True in ``seen``, shape (n_frames,)."""
    edges = np.diff(np.concatenate(([0], seen.astype(int), [0])))
    return [(int(a), int(b)) for a, b in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1))]


def marker_jumps(track: np.ndarray, rate_hz: float, least_mm: float, least_deviations: float) -> MarkerJumps:
    """Find the jumps of one marker by `core.suspicion.jumps.Jumps`, in the space of the capture.

    The head moves smoothly, so nothing is gained by taking its motion out, and a fault of one marker would then shake
    all others.

    track : shape (n_frames, 3), mm, NaN where missing
    least_mm, least_deviations : smaller jumps are left out
    """
    bounds = [run for run in runs(np.isfinite(track).all(axis=1)) if run[1] - run[0] >= _SHORTEST_RUN]
    whole = np.where(np.isfinite(track), track, 0.0)
    jumps = Jumps.find(whole, bounds)
    clear = (jumps.deviations(jumps.size) >= least_deviations) & (np.linalg.norm(jumps.step, axis=1) >= least_mm)
    kept = Jumps(jumps.at[clear], jumps.whitened[clear], jumps.step[clear], jumps.usual, jumps.spread, jumps.left)
    paired, alone = excursions(kept, rate_hz)
    return MarkerJumps(kept.at, tuple(paired), kept.at[alone])
