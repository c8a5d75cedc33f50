"""Blinks, as they were captured, for silences that are longer than any that was."""

from __future__ import annotations

import numpy as np

from core.motion.database import MotionDatabase
from core.synthesis.blend import spoken_share

_SHUT = 0.5  # of the way from the usual opening to the narrowest
_NARROWEST = 0.001  # quantile
_LEAST_DEPTH_MM = 2.0  # less is a trembling lid
_AROUND_S = 0.2  # before and after a lid is down
_RARELY_S = 60.0  # a face whose lids come down less often than this does not blink


class CapturedBlinks:
    """What the face above the mouth does in the captured blinks, and how often.

    A blink is a time when both upper lids stand lower than half-way to their lowest. Without markers on both upper lids
    there is none.

    frames : float, shape (n_frames, n_dims), the database's coefficients, or what was made of them
    """

    def __init__(self, database: MotionDatabase, frames: np.ndarray) -> None:
        self._rate_hz = database.rate_hz
        self._n_dims = frames.shape[1]
        self._blinks: list[np.ndarray] = []
        self._every_s = np.inf
        lids = [database.markers.landmark(f"upper_lid_{side}") for side in ("left", "right")]
        if None in lids or not len(frames):
            return
        columns = [3 * lid + 1 for lid in lids]
        height = (database.pca.mean[columns] + frames @ database.pca.basis[columns].T).mean(axis=1)
        usual = np.median(height)
        depth = usual - np.quantile(height, _NARROWEST)
        if depth < _LEAST_DEPTH_MM:
            return
        is_shut = height < usual - _SHUT * depth
        count = 0
        around = round(_AROUND_S * self._rate_hz)
        above_mouth = np.repeat(1.0 - spoken_share(database.markers), 3)
        upper_face = (database.pca.basis * above_mouth[:, None]).T @ database.pca.basis
        for sentence in database.sentences:
            shut = is_shut[sentence.start_frame : sentence.stop_frame]
            edges = np.diff(np.concatenate(([0], shut.astype(int), [0])))
            count += int((edges == 1).sum())
            for down, up in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)):
                first, last = down - around, up + around
                if first >= 0 and last <= len(shut) and not shut[first:down].any() and not shut[up:last].any():
                    self._blinks.append(_raised(frames[sentence.start_frame :][first:last].astype(float)) @ upper_face)
        if self._blinks and len(frames) / self._rate_hz / count <= _RARELY_S:
            self._every_s = len(frames) / self._rate_hz / count

    def within(self, n_frames: int, seed: int) -> np.ndarray:
        """Offsets from a still face that blinks as often as the captured one; float64, shape (n_frames, n_dims).

        Times between blinks are drawn evenly from half to one and a half times their mean.
        """
        rng = np.random.default_rng(seed)
        offsets = np.zeros((n_frames, self._n_dims))
        if not np.isfinite(self._every_s):
            return offsets
        at = round(self._every_s * rng.uniform(0.0, 1.0) * self._rate_hz)
        while at < n_frames:
            blink = self._blinks[rng.integers(len(self._blinks))]
            if at + len(blink) <= n_frames:
                offsets[at : at + len(blink)] = blink
            at += max(len(blink), round(self._every_s * rng.uniform(0.5, 1.5) * self._rate_hz))
        return offsets


def _raised(track: np.ndarray) -> np.ndarray:
    """Take out the straight line from the first frame to the last."""
    share = np.linspace(0.0, 1.0, len(track))[:, None]
    return track - (track[0] + share * (track[-1] - track[0]))
