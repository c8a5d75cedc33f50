"""Control curves: named controls of a character over time, what every export and the editable graph take."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from core.errors import UserFacingError
from core.media.video import timecode


@dataclass(frozen=True)
class ControlTrack:
    """Values of named controls, frame by frame.

    names : of the U controls, all different
    values : float32, shape (n_frames, U), finite, dimensionless; 0 at rest, 1 at full strength, and nothing here
        keeps them between the two (see `clipped`)
    rate_hz : frame f stands at f / rate_hz
    start_frame : what frame 0 is counted as, from midnight, at ``rate_hz``; a timecode is made of it
    """

    names: tuple[str, ...]
    values: np.ndarray
    rate_hz: float
    start_frame: int = 0

    def __post_init__(self) -> None:
        values = np.asarray(self.values, np.float32)
        names = tuple(self.names)
        if values.ndim != 2 or values.shape[1] != len(names):
            raise ValueError(f"{len(names)} controls need values (n_frames, {len(names)}), not {values.shape}")
        if len(values) == 0 or not 0 < self.rate_hz < math.inf:
            raise ValueError("a track has frames and a rate")
        if len(set(names)) != len(names) or not all(names):
            raise UserFacingError("Two controls have the same name, or one has none.", "Name each differently.")
        if not np.isfinite(values).all():
            frame, control = np.argwhere(~np.isfinite(values))[0]
            raise UserFacingError(f"Control '{names[control]}' has no number at frame {frame}.")
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "names", names)

    def __len__(self) -> int:
        return len(self.values)

    @property
    def duration_s(self) -> float:
        """How long the track lasts, its last frame included."""
        return len(self.values) / self.rate_hz

    @property
    def times_s(self) -> np.ndarray:
        """When each frame stands, float64, shape (n_frames,), from 0."""
        return np.arange(len(self.values)) / self.rate_hz

    @property
    def start_timecode(self) -> str:
        """``hh:mm:ss:ff`` of the first frame."""
        return timecode(self.start_frame, self.rate_hz)

    def column(self, name: str) -> np.ndarray:
        """Return one control, float32, shape (n_frames,); raises `UserFacingError` for one that there is not."""
        if name not in self.names:
            raise UserFacingError(f"There is no control '{name[:60]}'.", f"There are {', '.join(self.names[:12])}.")
        return self.values[:, self.names.index(name)]

    def arranged(self, names: Sequence[str]) -> ControlTrack:
        """Return the controls ``names`` in that order, at rest where the track has none; others are left out."""
        row = {name: u for u, name in enumerate(self.names)}
        values = np.zeros((len(self.values), len(names)), np.float32)
        for u, name in enumerate(names):
            if name in row:
                values[:, u] = self.values[:, row[name]]
        return replace(self, names=tuple(names), values=values)

    def beyond(self, lowest: float = 0.0, highest: float = 1.0) -> tuple[str, ...]:
        """Return the controls that leave the span, by more than a thousandth."""
        out = ((self.values < lowest - 1e-3) | (self.values > highest + 1e-3)).any(axis=0)
        return tuple(name for name, leaves in zip(self.names, out) if leaves)

    def clipped(self, lowest: float = 0.0, highest: float = 1.0) -> ControlTrack:
        """Return the track kept within the span; `beyond` tells what that changes."""
        return replace(self, values=np.clip(self.values, np.float32(lowest), np.float32(highest)))

    def at_rate(
        self, rate_hz: Fraction | float, n_frames: int | None = None, start_frame: int | None = None
    ) -> ControlTrack:
        """Sample at another rate; the last frame is held.

        Between frames runs a monotone cubic (PCHIP), which passes through all of them and never overshoots: what was
        within [0, 1] stays there. Nothing is filtered on the way down, for the one frame in which the lips meet would
        be blurred open.

        n_frames : as many as cover the track when absent
        start_frame : at the new rate; when absent, that of the same moment
        """
        rate = float(rate_hz)
        if n_frames is None:
            n_frames = max(1, math.ceil(self.duration_s * rate - 1e-6))
        if start_frame is None:
            start_frame = round(self.start_frame / self.rate_hz * rate)
        if math.isclose(rate, self.rate_hz, rel_tol=1e-9):
            rows = np.minimum(np.arange(n_frames), len(self.values) - 1)
            return replace(self, values=self.values[rows], rate_hz=rate, start_frame=start_frame)
        times_s = np.minimum(np.arange(n_frames) / rate, self.times_s[-1])
        if len(self.values) == 1:
            sampled = np.repeat(self.values, n_frames, axis=0)
        else:
            from scipy.interpolate import PchipInterpolator

            sampled = PchipInterpolator(self.times_s, self.values, axis=0)(times_s)
        return replace(self, values=sampled, rate_hz=rate, start_frame=start_frame)

    def between(self, start_s: float, end_s: float) -> ControlTrack:
        """Return the frames that stand within ``start_s`` <= time < ``end_s``; raises `UserFacingError` for none."""
        first, stop = (math.ceil(time_s * self.rate_hz - 1e-6) for time_s in (start_s, end_s))
        first, stop = max(first, 0), min(stop, len(self.values))
        if first >= stop:
            raise UserFacingError(f"From {start_s:g} s to {end_s:g} s there is no frame of the curves.")
        return replace(self, values=self.values[first:stop], start_frame=self.start_frame + first)
