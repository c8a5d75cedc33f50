"""Smooth joins between motion nodes that were not captured one after the other.

Deng and Neumann 2008, section 7.2, equation 16 and table 4.
"""

from __future__ import annotations

import itertools
from functools import lru_cache

import numpy as np
from scipy.interpolate import make_smoothing_spline

from core.motion.node import NodeTable
from core.speech.phoneme import PAU, PHONEMES
from core.synthesis.concatenate import SlotFrames

# Table 4: how strongly the captured frames of a phone hold against the smoothing, by how visible the phone is.
_WEIGHT_OF_PHONE = {
    **dict.fromkeys(("p", "b", "m", "f", "v", "w"), 2.0),
    **dict.fromkeys(("k", "g", "ch", "ng", "r"), 0.5),
}
SMOOTHING_WEIGHTS = np.array([_WEIGHT_OF_PHONE.get(phone, 1.0) for phone in PHONEMES])
_TIE = 1e5  # weight of the untouched neighbours: high enough to hold, low enough for a well-conditioned system


def smooth_joins(
    motion: np.ndarray,
    path: np.ndarray,
    phonemes: np.ndarray,
    slots: SlotFrames,
    nodes: NodeTable,
    half_window: int = 3,
) -> np.ndarray:
    """Smooth the ``2 * half_window`` frames around each join.

    Equation 16, ``Σ W (g_i - f_i)² + ∫ g''² dt``, with t in frames: a weighted cubic smoothing spline. Differences from
    the paper: the spline's ends are tied to two untouched frames on either side (a free spline misses them by a tenth
    of the jump), and windows that overlap become one spline. Joins to silence are left: silence is made anew.

    motion : shape (n_frames, n_dims); phonemes : int, shape (n_slots,), of the slots
    returns : a smoothed copy
    """
    smoothed = np.array(motion, float)
    frame_weights = np.ones(len(motion))
    for p, phone in enumerate(phonemes):
        frame_weights[slots.start[p] : slots.stop[p]] = SMOOTHING_WEIGHTS[phone]
    for start, stop in join_windows(path, phonemes, slots, nodes, half_window, len(motion)):
        first, last = max(start - 2, 0), min(stop + 2, len(motion))
        if last - first < 5:
            continue  # a cubic smoothing spline needs five points
        weights = frame_weights[first:last].copy()
        weights[: start - first] = weights[stop - first :] = _TIE
        smoothed[start:stop] = (_smoother(tuple(weights)) @ smoothed[first:last])[start - first : stop - first]
    return smoothed


@lru_cache(maxsize=4096)
def _smoother(weights: tuple[float, ...]) -> np.ndarray:
    """What equation 16 does to a window, as a matrix: the spline is linear in the frames, and windows are alike."""
    times = np.arange(len(weights), dtype=float)
    return make_smoothing_spline(times, np.eye(len(weights)), w=np.array(weights), lam=1.0)(times)


def join_windows(
    path: np.ndarray, phonemes: np.ndarray, slots: SlotFrames, nodes: NodeTable, half_window: int, n_frames: int
) -> list[tuple[int, int]]:
    """Return frame ranges (start, stop) to be smoothed, in order, those that touch made one."""
    pau = PHONEMES.index(PAU)
    kept = [p for p in range(len(path)) if slots.stop[p] > slots.start[p]]
    windows: list[tuple[int, int]] = []
    for before, after in itertools.pairwise(kept):
        silent = pau in (phonemes[before], phonemes[after])
        captured_so = after == before + 1 and nodes.pre[path[after]] == path[before]
        if silent or captured_so:
            continue
        join = int(slots.start[after])
        start, stop = max(join - half_window, 0), min(join + half_window, n_frames)
        if windows and start <= windows[-1][1]:
            start = windows.pop()[0]
        windows.append((start, stop))
    return windows
