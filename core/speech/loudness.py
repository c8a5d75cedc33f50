"""Where a sound is loud and where it pauses, from its energy alone."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

FRAME_S = 0.01

# Quieter than this in its loudest moments is an empty track; room tone in a studio lies near -60 dB.
_SILENT_DB = -65.0
# Speech rises and falls by 20 dB and more between its phones; hiss, hum and tones do not.
_STEADY_DB = 6.0
# Sound this far below the loud parts of speech is not taken for speech.
_SPEECH_BELOW_LOUD_DB = 20.0
_PAUSE_WINDOW = 15


def levels_db(samples: np.ndarray, rate_hz: int) -> np.ndarray:
    """Return the level of each 10 ms, in dB of full scale; shape (n_frames,), at least one."""
    step = round(rate_hz * FRAME_S)
    n_frames = max(len(samples) // step, 1)
    frames = np.resize(samples, n_frames * step).reshape(n_frames, step)
    return 10 * np.log10(np.mean(frames.astype(np.float64) ** 2, axis=1) + 1e-12)


def holds_no_speech(levels: np.ndarray) -> bool:
    """Whether a sound is empty or steady: silence, hiss, hum."""
    loud, quiet = np.percentile(levels, (98, 5))
    return bool(loud < _SILENT_DB or loud - quiet < _STEADY_DB)


def loud_frames(levels: np.ndarray) -> np.ndarray:
    """Return which frames are as loud as speech is in this sound; bool, shape (n_frames,)."""
    floor, loud = np.percentile(levels, (5, 95))
    return levels > max(loud - _SPEECH_BELOW_LOUD_DB, (floor + loud) / 2)


def stretches(levels: np.ndarray, shortest_s: float, longest_s: float) -> Iterator[tuple[float, float]]:
    """Cut a sound into stretches between two lengths, each time at the quietest moment that is within reach."""
    smooth = np.convolve(levels, np.ones(_PAUSE_WINDOW) / _PAUSE_WINDOW, mode="same")
    shortest, longest = round(shortest_s / FRAME_S), round(longest_s / FRAME_S)
    start = 0
    while len(levels) - start > longest:
        # leave enough for the stretch after
        reach = slice(start + shortest, min(start + longest, len(levels) - shortest))
        cut = reach.start + int(np.argmin(smooth[reach]))
        yield start * FRAME_S, cut * FRAME_S
        start = cut
    yield start * FRAME_S, len(levels) * FRAME_S
