"""Markers that took each other's names for a while, found where two tracks break at once and fit crosswise."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from core.importing.jumping_markers import MarkerJumps

# Crosswise, two broken tracks fit together at least this much better than straight on.
_CROSSWISE = 0.4
_LONGEST_BREAK_S = 0.3


@dataclass(frozen=True)
class Swap:
    """Marker rows ``marker`` and ``other`` carry each other's motion from frame ``start`` to ``stop`` (exclusive)."""

    marker: int
    other: int
    start: int
    stop: int


@dataclass(frozen=True)
class _Break:
    """A track that does not go on as it was: last sound frame before, first after, and where it was expected."""

    marker: int
    before: int
    after: int
    expected: np.ndarray
    arrived: np.ndarray


def undo_swaps(
    positions: np.ndarray, rate_hz: float, jumps: list[MarkerJumps], least_mm: float
) -> tuple[np.ndarray, list[Swap]]:
    """Give swapped markers their own names back.

    Where two markers jump in the same frame, or one vanishes for up to 0.3 s and comes back elsewhere while the other
    does too, both are laid crosswise; fits that are far better so are a change of names. Of all namings of a take the
    one that holds longest is right.

    positions : shape (n_frames, n_markers, 3), mm, NaN where missing; jumps : one a marker
    returns : a mended copy, and the swaps by their true names
    """
    n_frames, n_markers = positions.shape[:2]
    changes = _changes(_breaks(positions, rate_hz, jumps), least_mm)
    if not changes:
        return np.array(positions), []
    # carried[f, k]: whose motion is stored as marker k in frame f, in terms of the first frame's names
    carried = np.tile(np.arange(n_markers), (n_frames, 1))
    for a, b in changes:
        one, two = carried[-1, a.marker], carried[-1, b.marker]
        carried[a.after :, a.marker] = two
        carried[b.after :, b.marker] = one
    namings, inverse = np.unique(carried, axis=0, return_inverse=True)
    right = namings[np.bincount(inverse.ravel()).argmax()]
    true_name = np.empty(n_markers, int)
    true_name[right] = np.arange(n_markers)
    carried = true_name[carried]
    mended = np.full_like(positions, np.nan)
    for k in np.flatnonzero((carried == np.arange(n_markers)).all(axis=0)):
        mended[:, k] = positions[:, k]
    for k in np.flatnonzero((carried != np.arange(n_markers)).any(axis=0)):
        for owner in np.unique(carried[:, k]):
            rows = np.flatnonzero((carried[:, k] == owner) & np.isfinite(positions[:, k]).all(axis=1))
            mended[rows, owner] = positions[rows, k]
    return mended, _spans(carried)


def _spans(carried: np.ndarray) -> list[Swap]:
    spans = []
    for k in range(carried.shape[1]):
        wrong = carried[:, k] != k
        edges = np.diff(np.concatenate(([0], wrong.astype(int), [0])))
        for start, stop in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)):
            other = int(carried[start, k])
            if k < other or carried[start, other] != k:
                spans.append(Swap(k, other, int(start), int(stop)))
    return spans


def _breaks(positions: np.ndarray, rate_hz: float, jumps: list[MarkerJumps]) -> list[_Break]:
    seen = np.isfinite(positions).all(axis=2)
    breaks = []
    for k, found in enumerate(jumps):
        jumped = set(found.at.tolist())
        for at in found.at:
            before = positions[at - 1, k]
            steady = at >= 2 and seen[at - 2, k] and at - 1 not in jumped
            slope = before - positions[at - 2, k] if steady else np.zeros(3)
            breaks.append(_Break(k, int(at) - 1, int(at), before + slope, positions[at, k]))
        frames = np.flatnonzero(seen[:, k])
        for i in np.flatnonzero(np.diff(frames) > 1):
            before, after = int(frames[i]), int(frames[i + 1])
            if after - before <= _LONGEST_BREAK_S * rate_hz:
                breaks.append(_Break(k, before, after, positions[before, k], positions[after, k]))
    return sorted(breaks, key=lambda b: (b.after, b.marker))


def _changes(breaks: list[_Break], least_mm: float) -> list[tuple[_Break, _Break]]:
    """Pairs of breaks that overlap and fit crosswise, the clearest first where one break could be in two."""
    candidates = []
    for a, b in itertools.combinations(breaks, 2):
        if a.marker == b.marker or a.before >= b.after or b.before >= a.after:
            continue
        straight = np.linalg.norm(a.arrived - a.expected), np.linalg.norm(b.arrived - b.expected)
        crosswise = np.linalg.norm(b.arrived - a.expected) + np.linalg.norm(a.arrived - b.expected)
        if min(straight) >= least_mm and crosswise < _CROSSWISE * sum(straight):
            candidates.append((crosswise / sum(straight), a, b))
    chosen, used = [], set()
    for _, a, b in sorted(candidates, key=lambda c: c[0]):
        if id(a) not in used and id(b) not in used:
            used |= {id(a), id(b)}
            chosen.append((a, b))
    return sorted(chosen, key=lambda pair: max(pair[0].after, pair[1].after))
