"""What every engine makes: marker motion in head space."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from core.motion.marker_set import MarkerSet


@dataclass(frozen=True)
class MarkerMotion:
    """Motion of a marker set in head space.

    positions : float32, shape (n_frames, n_markers, 3), millimetres; frame f stands at f / rate_hz
    """

    positions: np.ndarray
    rate_hz: float
    markers: MarkerSet

    @property
    def displacements(self) -> np.ndarray:
        """Positions less the rest pose, mm; what a face is deformed by."""
        return self.positions - self.markers.rest.astype(np.float32)

    def at_rate(self, fps: Fraction | float, n_frames: int) -> MarkerMotion:
        """Sample at an output rate, linearly between frames; the last frame is held."""
        sampled = self._between_frames(np.arange(n_frames) * (self.rate_hz / float(fps)))
        return MarkerMotion(sampled, float(fps), self.markers)

    def at_times(self, times_s: np.ndarray) -> np.ndarray:
        """Return the positions at moments, float32, shape (n_times, n_markers, 3), mm, linearly between frames.

        Before the first and after the last frame the motion holds still.
        """
        return self._between_frames(np.asarray(times_s, float) * self.rate_hz)

    def _between_frames(self, place: np.ndarray) -> np.ndarray:
        place = np.clip(place, 0, len(self.positions) - 1)
        low = place.astype(int)
        high = np.minimum(low + 1, len(self.positions) - 1)
        share = (place - low).astype(np.float32)[:, None, None]
        return self.positions[low] * (1 - share) + self.positions[high] * share
