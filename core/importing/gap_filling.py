"""Gaps of single markers, filled by what the other markers say and joined to what was seen on both sides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from core.importing.pose_model import PoseModel

# What is seen on each side of a gap, as far as it bears on it.
_SIDE_S = 0.1
# Beyond this length the slopes at the ends say little about the middle.
_SLOPE_FADES_S = 0.15
_LEAST_SEEN = 6
# Over shorter gaps a marker's own path says more than the other markers, which bring their jitter along.
_OWN_PATH_S = 0.1
# A track with less jitter than this is smooth enough for the slope of a parabola; more asks for a line, over longer.
_SMOOTH_MM = 0.03
_FRAMES_OF_PARABOLA, _FRAMES_OF_LINE = 3, 5


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
    longer gaps). Where the other markers say nothing, in gaps up to 0.1 s and without a model it is that cubic alone.

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
        is_long = gap.stop - gap.start > _OWN_PATH_S * rate_hz
        if model is not None and is_long and len(others) >= _LEAST_SEEN:
            expected = model.expected(positions[first:last], others, gap.marker)
        off = positions[anchors, gap.marker] - expected[anchors - first]
        carried = _carried(anchors, off, gap, rate_hz, jitter_mm(positions[:, gap.marker]) < _SMOOTH_MM)
        filled[gap.start : gap.stop, gap.marker] = expected[gap.start - first : gap.stop - first] + carried
        done.append(gap)
    return filled, done, left


def jitter_mm(track: np.ndarray) -> float:
    """Return the standard deviation of a track's jitter per axis, told by its third differences; mm.

    track : shape (n_frames, 3), NaN where missing; 0 for a track that is too short to tell
    """
    third = np.diff(track, n=3, axis=0)
    third = third[np.isfinite(third)]
    return float(1.4826 * np.median(np.abs(third)) / np.sqrt(20.0)) if len(third) else 0.0


def _carried(anchors: np.ndarray, off: np.ndarray, gap: Gap, rate_hz: float, is_smooth: bool) -> np.ndarray:
    """Carry a track, shape (n_anchors, 3), over a gap between its anchors; shape (n_gap, 3)."""
    before, after = anchors < gap.start, anchors >= gap.stop
    # the run of anchors that touches the gap, so that another gap close by does not bend the slope
    before &= anchors >= gap.start - _run(anchors[before][::-1], -1)
    after &= anchors < gap.stop + _run(anchors[after], 1)
    fade = 1.0 / (1.0 + ((gap.stop - gap.start) / rate_hz / _SLOPE_FADES_S) ** 2)
    n = _FRAMES_OF_PARABOLA if is_smooth else _FRAMES_OF_LINE
    slopes = [
        fade * _slope(anchors[before][-n:] - (gap.start - 1), off[before][-n:], is_smooth),
        fade * _slope(anchors[after][:n] - gap.stop, off[after][:n], is_smooth),
    ]
    values = [off[before][-1], off[after][0]]
    return CubicHermiteSpline([gap.start - 1, gap.stop], values, slopes, axis=0)(np.arange(gap.start, gap.stop))


def _run(frames: np.ndarray, direction: int) -> int:
    steps = np.diff(frames) == direction
    return 1 + (int(np.argmin(steps)) if not steps.all() else len(steps))


def _slope(frames: np.ndarray, values: np.ndarray, is_smooth: bool) -> np.ndarray:
    """The slope at frame 0 of a parabola, or a line, through the frames beside a gap; values of shape (n, 3)."""
    degree = min(2 if is_smooth else 1, len(frames) - 1)
    return np.polyfit(frames, values, degree)[-2] if degree else np.zeros(values.shape[1])
