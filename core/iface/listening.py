"""How well a microphone is heard: its level, samples that clip, and sound that was lost on the way."""

from __future__ import annotations

from collections import deque

import numpy as np

FULL_SCALE = 0.999
_FLOOR_DB = -90.0
_RUSH_S = 3.0
# A peak falls by this much in a second, so that it can be read.
_FALL_DB_A_S = 24.0


class LevelMeter:
    """Follows the level of a sound.

    rms_db, peak_db : of the newest block, and the highest lately, decibels of full scale, -90 at least
    clipped : samples at full scale so far; silent_s : for how long every sample was exactly 0, as of a muted device
    """

    def __init__(self, rate_hz: int) -> None:
        self._rate_hz = rate_hz
        self.rms_db = self.peak_db = _FLOOR_DB
        self.clipped, self.silent_s = 0, 0.0

    def accept(self, samples: np.ndarray) -> None:
        """Take the next block, shape (n,), -1..1."""
        if len(samples) == 0:
            return
        loud = np.abs(np.nan_to_num(samples))
        block_s = len(samples) / self._rate_hz
        self.rms_db = _decibels(float(np.sqrt(np.mean(np.square(loud, dtype=float)))))
        self.peak_db = max(_decibels(float(loud.max())), self.peak_db - _FALL_DB_A_S * block_s)
        self.clipped += int((loud >= FULL_SCALE).sum())
        self.silent_s = 0.0 if loud.any() else self.silent_s + block_s


def _decibels(amplitude: float) -> float:
    return max(_FLOOR_DB, 20.0 * float(np.log10(max(amplitude, 1e-9))))


class DropoutWatch:
    """Tells from when blocks arrive that sound was lost which the device did not tell of.

    A block may come late, but what was lost never comes: from then on each block arrives later than its place in the
    sound says. The earliest arrival of each second is compared with that of the second before; a clock that is off by
    a thousandth passes. A sound server may begin with a rush of what it had gathered, so that the first seconds tell
    nothing, and later move its buffer by a block of 10 ms when another program begins to play, which is no loss.

    dropouts : how often sound was lost; lost_s : how much of it in all
    """

    def __init__(self, rate_hz: int, least_s: float = 0.015) -> None:
        self._rate_hz, self._least_s = rate_hz, least_s
        self._n, self._window_end_s, self._first_s = 0, 0.0, None
        self._lead: deque[float] = deque(maxlen=2)  # earliest arrival of the last second that is over, and of this one
        self.dropouts, self.lost_s = 0, 0.0

    def accept(self, n_samples: int, arrived_s: float) -> None:
        """Take a block of ``n_samples`` that arrived at ``arrived_s``, by a clock that runs evenly."""
        if self._first_s is None:
            self._first_s = arrived_s
        self._n += n_samples
        late_s = arrived_s - self._n / self._rate_hz
        if arrived_s >= self._window_end_s:
            if arrived_s - self._first_s > _RUSH_S:
                self._end_window()
            self._window_end_s = arrived_s + 1.0
            self._lead.append(late_s)
        else:
            self._lead[-1] = min(self._lead[-1], late_s)

    def _end_window(self) -> None:
        if len(self._lead) == 2 and self._lead[1] - self._lead[0] > self._least_s:
            self.dropouts += 1
            self.lost_s += self._lead[1] - self._lead[0]
