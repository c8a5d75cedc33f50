"""Sudden jumps in captured tracks, found one after the other so that none casts a shadow on its neighbours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

# A jump between two frames, seen by the filter of `jump_residuals` at the frames around it.
_SHADOW = {-2: 1 / 6, -1: -2 / 3, 1: -2 / 3, 2: 1 / 6}
# Robust deviations from the usual at which a residual counts as a jump.
LEAST_JUMP = 3.0
_TIMES_AT_ONE_FRAME = 7
_TYPICAL_SHARE = 0.9


@dataclass(frozen=True)
class Jumps:
    """Jumps of one track.

    at : int64, shape (n_jumps,), ascending; a jump leads from frame ``at - 1`` to frame ``at``
    whitened : float64, shape (n_jumps, n_dims), each jump in units of the track's usual residuals
    step : float64, shape (n_jumps, n_dims), the same in the track's own units
    usual, spread : median size of a whitened residual and its robust standard deviation
    left : float64, shape (n_frames + 1,), whitened size of what remains at each frame without the jumps
    """

    at: np.ndarray
    whitened: np.ndarray
    step: np.ndarray
    usual: float
    spread: float
    left: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """Whitened length of each jump, shape (n_jumps,)."""
        return np.linalg.norm(self.whitened, axis=1)

    def deviations(self, size: np.ndarray) -> np.ndarray:
        """Return how many robust standard deviations ``size`` lies above the usual residual."""
        return (size - self.usual) / self.spread

    @classmethod
    def find(cls, track: np.ndarray, bounds: Sequence[tuple[int, int]]) -> Jumps:
        """Find the jumps of ``track``, shape (n_frames, n_dims): one marker's positions, or the face's coefficients.

        bounds : (first frame, one past the last) of each piece that was captured without a break
        """
        residuals = jump_residuals(track, bounds)
        white, unwhiten = _whitened(residuals)
        size = np.linalg.norm(white, axis=1)
        inner = size[size > 0]
        usual = float(np.median(inner)) if len(inner) else 0.0
        spread = max(1.4826 * float(np.median(np.abs(inner - usual))) if len(inner) else 0.0, 1e-12)
        found = _peel(white, usual + LEAST_JUMP * spread)
        at = np.array(sorted(found), np.int64)
        whitened = np.array([found[f] for f in at]).reshape(len(at), track.shape[1])
        return cls(at, whitened, whitened @ unwhiten, usual, spread, np.linalg.norm(white, axis=1))


def jump_residuals(track: np.ndarray, bounds: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return what each step has beyond a cubic through the two steps before and the two after it.

    Row f is about the step from frame f - 1 to f: ``v_f - (4 (v_(f-1) + v_(f+1)) - v_(f-2) - v_(f+2)) / 6``.

    returns : float64, shape (n_frames + 1, n_dims); 0 at the ends of pieces and in pieces under 6 frames
    """
    track = np.asarray(track, float)
    residuals = np.zeros((len(track) + 1, track.shape[1]))
    for first, stop in bounds:
        if stop - first < 6:
            continue
        steps = np.pad(np.diff(track[first:stop], axis=0), ((2, 2), (0, 0)), mode="reflect")
        around = 4 * (steps[1:-3] + steps[3:-1]) - steps[:-4] - steps[4:]
        residuals[first + 1 : stop] = steps[2:-2] - around / 6
    return residuals


def _whitened(residuals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return residuals of unit covariance as most of them have it, and the matrix that takes them back."""
    inner = residuals[np.abs(residuals).sum(axis=1) > 0]
    n_dims = residuals.shape[1]
    if len(inner) < 2 * n_dims:
        return residuals.copy(), np.eye(n_dims)
    deviation = 1.4826 * np.median(np.abs(inner), axis=0) + 1e-12
    length = np.linalg.norm(inner / deviation, axis=1)
    # faults are few and large: without the largest tenth, the covariance is that of sound capture
    typical = inner[length <= np.quantile(length, _TYPICAL_SHARE)]
    values, vectors = np.linalg.eigh(np.cov(typical.T).reshape(n_dims, n_dims))
    scale = np.sqrt(values.clip(max(values.max(), 1e-12) * 1e-9))
    return residuals @ (vectors / scale), (vectors * scale).T


def _peel(white: np.ndarray, least: float) -> dict[int, np.ndarray]:
    """Take the largest jump away with its shadow, again and again, until none of ``least`` is left; edits ``white``."""
    size = np.linalg.norm(white, axis=1)
    found: dict[int, np.ndarray] = {}
    times: dict[int, int] = {}
    while size[f := int(size.argmax())] >= least:
        times[f] = times.get(f, 0) + 1
        if times[f] > _TIMES_AT_ONE_FRAME:  # two jumps side by side converge slowly; what is left of them is small
            size[f] = 0.0
            continue
        jump = white[f].copy()
        found[f] = found.get(f, 0.0) + jump
        white[f] = 0.0
        size[f] = 0.0
        for away, share in _SHADOW.items():
            if 0 <= f + away < len(white):
                white[f + away] -= share * jump
                size[f + away] = np.linalg.norm(white[f + away])
    return found
