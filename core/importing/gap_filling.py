"""Gaps of single markers, filled by what the other markers say and joined to what was seen on both sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from core.importing.pose_model import PoseModel

# Frames on each side of a gap from which its slope is taken.
_SIDE_S = 0.05
# Beyond this length the slopes at the ends say little about the middle.
_SLOPE_FADES_S = 0.15
_LEAST_SEEN = 6


@dataclass(frozen=True)
class Gap:
    """Frames ``start`` to ``stop`` (exclusive) in which marker row ``marker`` is missing."""

    marker: int
    start: int
    stop: int


def find_gaps(positions: np.ndarray) -> list[Gap]:
    """Return all gaps of ``positions``, shape (n_frames, n_markers, 3), NaN where missing, marker by marker."""
    missing = ~np.isfinite(positions).all(axis=2)
    gaps = []
    for k in np.flatnonzero(missing.any(axis=0)):
        edges = np.diff(np.concatenate(([0], missing[:, k].astype(int), [0])))
        gaps += [Gap(int(k), int(a), int(b)) for a, b in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1))]
    return gaps


def fill_gaps_by_pose(
    positions: np.ndarray, rate_hz: float, longest_gap_s: float, model: PoseModel | None
) -> tuple[np.ndarray, list[Gap], list[Gap]]:
    """Fill every gap of at most ``longest_gap_s`` that has something seen on both sides; leave the others open.

    Inside a gap the marker follows where the seen markers expect it (`PoseModel.expected`), plus what it was off that
    expectation before and after, carried across by a cubic that meets both ends in place and slope (slopes fade in
    longer gaps). Where the other markers say nothing it is that cubic alone; so it is without a model.

    positions : shape (n_frames, n_markers, 3), mm, NaN where missing
    returns : a filled copy, the gaps that were filled, the gaps that are left
    """
    filled = np.array(positions, float)
    seen = np.isfinite(filled).all(axis=2)
    side = max(2, round(_SIDE_S * rate_hz))
    done, left = [], []
    for gap in find_gaps(positions):
        inside = gap.start > 0 and gap.stop < len(filled)
        if not inside or gap.stop - gap.start > round(longest_gap_s * rate_hz):
            left.append(gap)
            continue
        first, last = max(0, gap.start - side), min(len(filled), gap.stop + side)
        anchors = np.flatnonzero(seen[first:last, gap.marker]) + first
        others = np.flatnonzero(seen[first:last].all(axis=0))
        expected = np.zeros((last - first, 3))
        if model is not None and len(others) >= _LEAST_SEEN:
            expected = model.expected(positions[first:last], others, gap.marker)
        off = positions[anchors, gap.marker] - expected[anchors - first]
        carried = _carried(anchors, off, gap, rate_hz)
        filled[gap.start : gap.stop, gap.marker] = expected[gap.start - first : gap.stop - first] + carried
        done.append(gap)
    return filled, done, left


def _carried(anchors: np.ndarray, off: np.ndarray, gap: Gap, rate_hz: float) -> np.ndarray:
    """Carry a track, shape (n_anchors, 3), over a gap between its anchors; shape (n_gap, 3)."""
    before, after = anchors < gap.start, anchors >= gap.stop
    # the run of anchors that touches the gap, so that another gap close by does not bend the slope
    before &= anchors >= gap.start - _run(anchors[before][::-1], -1)
    after &= anchors < gap.stop + _run(anchors[after], 1)
    fade = 1.0 / (1.0 + ((gap.stop - gap.start) / rate_hz / _SLOPE_FADES_S) ** 2)
    slopes = [fade * _slope(anchors[side], off[side]) for side in (before, after)]
    ends = [anchors[before][-1], anchors[after][0]]
    values = [off[before][-1], off[after][0]]
    return CubicHermiteSpline(ends, values, slopes, axis=0)(np.arange(gap.start, gap.stop))


def _run(frames: np.ndarray, direction: int) -> int:
    steps = np.diff(frames) == direction
    return 1 + (int(np.argmin(steps)) if not steps.all() else len(steps))


def _slope(frames: np.ndarray, values: np.ndarray) -> np.ndarray:
    """The slope at a gap's end: that of the parabola, or line, through the frames beside it."""
    if len(frames) < 2:
        return np.zeros(values.shape[1])
    return np.polyfit(frames - frames[0], values, 1)[0]
