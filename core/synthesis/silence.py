"""Silence: frames of ``/pau/`` are made anew from what stands on either side.

Deng and Neumann 2008, section 7.2 and figure 13.
"""

from __future__ import annotations

import numpy as np

from core.speech.phoneme import PAU, PHONEMES
from core.synthesis.concatenate import SlotFrames

INTERPOLATIONS = ("linear", "cubic", "cosine")
_EASE_S = 0.25  # how long a mouth takes to open from rest and to close again; longer silences hold the rest pose


def regenerate_silence(
    motion: np.ndarray,
    phonemes: np.ndarray,
    slots: SlotFrames,
    rest: np.ndarray,
    rate_hz: float,
    interpolation: str = "linear",
) -> np.ndarray:
    """Replace the frames of silent slots by interpolation between their boundary frames.

    Difference from the paper, which leaves it open: a silence at the start or end of an utterance has one boundary
    only, so the face eases between it and the rest pose, and holds the rest pose beyond.

    motion : shape (n_frames, n_dims); rest : shape (n_dims,); interpolation : one of `INTERPOLATIONS`
    returns : a copy with silence filled in; a motion that is all silence is all rest pose
    """
    if interpolation not in INTERPOLATIONS:
        raise ValueError(f"interpolation is one of {INTERPOLATIONS}, not {interpolation!r}")
    filled = np.array(motion, float)
    pau = PHONEMES.index(PAU)
    silent = np.zeros(len(filled), bool)
    for p in np.flatnonzero(np.asarray(phonemes) == pau):
        silent[slots.start[p] : slots.stop[p]] = True
    edges = np.diff(np.concatenate(([0], silent.astype(int), [0])))
    ease = max(1, round(_EASE_S * rate_hz))
    for start, stop in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)):
        opens, ends = start == 0, stop == len(filled)
        if opens and ends:
            filled[start:stop] = rest
        elif opens:
            eased = min(ease, stop - start)
            filled[start:stop] = rest
            filled[stop - eased : stop] = _between(rest, filled[stop], eased, "cosine")
        elif ends:
            eased = min(ease, stop - start)
            filled[start:stop] = rest
            filled[start : start + eased] = _between(filled[start - 1], rest, eased, "cosine")
        elif interpolation == "cubic":
            filled[start:stop] = _hermite(filled, start, stop)
        else:
            filled[start:stop] = _between(filled[start - 1], filled[stop], stop - start, interpolation)
    return filled


def _between(left: np.ndarray, right: np.ndarray, n: int, interpolation: str) -> np.ndarray:
    share = np.arange(1, n + 1) / (n + 1)
    if interpolation == "cosine":
        share = 0.5 - 0.5 * np.cos(np.pi * share)
    return left + share[:, None] * (right - left)


def _hermite(motion: np.ndarray, start: int, stop: int) -> np.ndarray:
    """Cubic that keeps the velocity on both sides."""
    from scipy.interpolate import CubicHermiteSpline

    left, right = start - 1, stop
    leaving = motion[left] - motion[max(left - 1, 0)]
    arriving = motion[min(right + 1, len(motion) - 1)] - motion[right]
    spline = CubicHermiteSpline([left, right], motion[[left, right]], np.stack([leaving, arriving]))
    return spline(np.arange(start, stop))
