"""A capture mended: swaps undone, spikes cut, gaps filled, and told row by row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.importing.gap_filling import Gap, fill_gaps_by_pose
from core.importing.jumping_markers import MarkerJumps, marker_jumps, runs
from core.importing.plan import MendLimits
from core.importing.pose_model import PoseModel
from core.importing.swapped_markers import Swap, undo_swaps
from core.suspicion.capture_faults import LONGEST_SPIKE_S

SWAP, SPIKE, GAP, LONG_GAP = "swap", "spike", "gap", "long gap"


@dataclass(frozen=True)
class MendRow:
    """One thing that was done: ``kind`` is swap, spike, gap or long gap (left open).

    marker, other : names, the second of a swap alone; start, stop : frames (exclusive)
    size_mm : how far a spike stood off from what took its place, or two swapped markers from each other; else 0
    """

    kind: str
    marker: str
    start: int
    stop: int
    other: str = ""
    size_mm: float = 0.0


@dataclass(frozen=True)
class Mended:
    """What mending made of a take.

    positions : float64, shape (n_frames, n_markers, 3), mm, NaN in gaps that were too long
    rows : what was done, in order of frames
    """

    positions: np.ndarray
    rows: tuple[MendRow, ...]

    def count(self, kind: str) -> int:
        """Return how often ``kind`` was done."""
        return sum(row.kind == kind for row in self.rows)

    def samples(self, kind: str) -> int:
        """Return how many marker samples ``kind`` concerns."""
        return sum(row.stop - row.start for row in self.rows if row.kind == kind)


def mend(
    positions: np.ndarray,
    names: Sequence[str],
    rate_hz: float,
    limits: MendLimits | None = None,
    rigid: Sequence[int] = (),
    model: PoseModel | None = None,
) -> Mended:
    """Mend one take.

    Swaps are undone first, then excursions are cut where the marker, filled in from its neighbours and its own path,
    would have been elsewhere by ``limits.least_spike_mm`` or more; a jump just before or after a gap widens the gap.
    Last, gaps up to ``limits.longest_gap_s`` are filled (`fill_gaps_by_pose`).

    positions : shape (n_frames, n_markers, 3), mm, NaN where missing
    rigid : rows of near-rigid markers, fewer than three: all
    model : of the poses; learnt from the take itself when absent
    """
    limits = limits or MendLimits()
    rigid = np.asarray(rigid if len(rigid) >= 3 else range(len(names)), int)
    now = np.array(positions, float)
    now[~np.isfinite(now).all(axis=2)] = np.nan
    rows: list[MendRow] = []
    cut: list[Gap] = []
    before = now
    if limits.faults:
        now, swaps = undo_swaps(now, rate_hz, _jumps(now, rate_hz, limits), limits.least_spike_mm)
        rows += [_swap_row(swap, now, names) for swap in swaps]
        before = now.copy()
        cut = _excursions(now, rate_hz, _jumps(now, rate_hz, limits))
        for gap in cut:
            now[gap.start : gap.stop, gap.marker] = np.nan
    if model is None and np.isnan(now).any():
        model = PoseModel.fit([(now, rate_hz)], rigid)
    filled, _, _ = fill_gaps_by_pose(now, rate_hz, limits.longest_gap_s, model)
    spikes = [gap for gap in cut if _away(filled, before, gap) >= limits.least_spike_mm]
    if len(spikes) < len(cut):  # what mending would hardly move was sound: it goes back, and bears on the rest
        now = before.copy()
        for gap in spikes:
            now[gap.start : gap.stop, gap.marker] = np.nan
    filled, done, left = fill_gaps_by_pose(now, rate_hz, limits.longest_gap_s, model)
    rows += [MendRow(SPIKE, names[g.marker], g.start, g.stop, size_mm=_away(filled, before, g)) for g in spikes]
    spiked = {(g.marker, f) for g in spikes for f in range(g.start, g.stop)}
    rows += [MendRow(kind, names[g.marker], g.start, g.stop)
             for kind, gaps in ((GAP, done), (LONG_GAP, left)) for g in gaps
             if not all((g.marker, f) in spiked for f in range(g.start, g.stop))]  # fmt: skip
    return Mended(filled, tuple(sorted(rows, key=lambda r: (r.start, r.stop, r.marker))))


def _jumps(positions: np.ndarray, rate_hz: float, limits: MendLimits) -> list[MarkerJumps]:
    return [marker_jumps(positions[:, k], rate_hz, limits.least_spike_mm, limits.least_deviations)
            for k in range(positions.shape[1])]  # fmt: skip


def _excursions(positions: np.ndarray, rate_hz: float, jumps: list[MarkerJumps]) -> list[Gap]:
    """Frames that left and came back, and those between a jump and a gap or an end close by."""
    reach = max(1, round(LONGEST_SPIKE_S * rate_hz))
    found = []
    for k, of_marker in enumerate(jumps):
        accused = np.zeros(len(positions), bool)
        for excursion in of_marker.excursions:
            accused[excursion.start : excursion.stop] = True
        stretches = runs(np.isfinite(positions[:, k]).all(axis=1))
        for at in of_marker.alone.tolist():
            first, stop = next((a, b) for a, b in stretches if a <= at < b)
            if at - first <= reach:
                accused[first:at] = True
            elif stop - at <= reach:
                accused[at:stop] = True
        found += [Gap(k, start, stop) for start, stop in runs(accused)]
    return found


def _away(filled: np.ndarray, before: np.ndarray, gap: Gap) -> float:
    """The farthest that mending moved the marker; infinite where the cut could not be filled."""
    span = slice(gap.start, gap.stop)
    moved = np.linalg.norm(filled[span, gap.marker] - before[span, gap.marker], axis=1)
    return float(moved.max()) if np.isfinite(moved).all() else np.inf


def _swap_row(swap: Swap, mended: np.ndarray, names: Sequence[str]) -> MendRow:
    span = slice(swap.start, swap.stop)
    apart = np.linalg.norm(mended[span, swap.marker] - mended[span, swap.other], axis=1)
    size_mm = float(np.nanmean(apart)) if np.isfinite(apart).any() else 0.0
    return MendRow(SWAP, names[swap.marker], swap.start, swap.stop, names[swap.other], size_mm)
