"""How near a synthesis is to its capture, and how alive: plain sums over frames and markers.

Positions are in mm, head space, shape (n_frames, n_markers, 3), of the same markers at the same times; a gap is the
vertical distance of the inner lips' midpoints, mm, shape (n_frames,). `core.evaluation.comparison` brings them so far.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.signal import savgol_filter

from core.motion.resample import frame_bounds
from core.speech.phoneme import PAU
from core.speech.transcript import Transcript

# Liveliness is compared at the rate of video: at 120 Hz a smoothing as long as that of 25 Hz takes half of real speech
# away, and a shorter one leaves what no camera of the other corpus would have seen.
LIVELINESS_HZ = 25.0
CLOSED_MM = 2.0
BILABIALS = ("p", "b", "m")


def error_mm2(synthesised: np.ndarray, captured: np.ndarray) -> float:
    """Mean over frames and markers of the squared distance, mm² (Deng and Neumann 2008, equation 12)."""
    return float(((synthesised - captured) ** 2).sum(axis=2).mean())


def errors_per_frame_mm2(synthesised: np.ndarray, captured: np.ndarray) -> np.ndarray:
    """Equation 12 before its mean over frames: mm², shape (n_frames,)."""
    return ((synthesised - captured) ** 2).sum(axis=2).mean(axis=1)


def distance_mm(synthesised: np.ndarray, captured: np.ndarray) -> float:
    """Mean over frames and markers of the distance, mm; given the lip markers alone, the lip error."""
    return float(np.linalg.norm(synthesised - captured, axis=2).mean())


def lip_gap_mm(positions: np.ndarray, upper_lip: int, lower_lip: int) -> np.ndarray:
    """Vertical distance from the marker in the middle of the lower lip to that of the upper, shape (n_frames,)."""
    return positions[:, upper_lip, 1] - positions[:, lower_lip, 1]


def lip_width_mm(positions: np.ndarray, left_corner: int, right_corner: int) -> np.ndarray:
    """Distance of the markers in the corners of the mouth, shape (n_frames,)."""
    return np.linalg.norm(positions[:, left_corner] - positions[:, right_corner], axis=1)


def correlation(synthesised: np.ndarray, captured: np.ndarray) -> float:
    """Pearson's r of two tracks; 0 where one of them holds still."""
    a, b = synthesised - synthesised.mean(), captured - captured.mean()
    scale = np.sqrt((a @ a) * (b @ b))
    still = 1e-9 * max(1.0, np.abs(synthesised).max(), np.abs(captured).max())
    return float(a @ b / scale) if min(np.abs(a).max(), np.abs(b).max()) > still else 0.0


def lightly_smoothed(track: np.ndarray) -> np.ndarray:
    """Savitzky–Golay of order 2 over 5 frames: at 25 Hz it takes out the jitter of tracked video, and little else."""
    return savgol_filter(track, 5, 2, axis=0) if len(track) >= 5 else np.array(track, float)


def derivative(track: np.ndarray, rate_hz: float, order: int) -> np.ndarray:
    """Difference of neighbouring frames, per s^order: velocity (1), acceleration (2); ``order`` frames shorter."""
    return np.diff(track, n=order, axis=0) * rate_hz**order


def variance_ratio(synthesised: Sequence[np.ndarray], captured: Sequence[np.ndarray]) -> float | None:
    """Variance of the synthesised tracks over that of the captured ones; 1 is as alive, less is dull, more jittery.

    One track a sentence; each varies about its own mean, and variances are averaged over all frames of all sentences.
    None when the captured tracks hold still.
    """

    def variance(tracks: Sequence[np.ndarray]) -> float:
        return sum(((t - t.mean()) ** 2).sum() for t in tracks if len(t)) / max(1, sum(len(t) for t in tracks))

    alive = variance(captured)
    return float(variance(synthesised) / alive) if alive > 0 else None


class Closures(NamedTuple):
    """Bilabials that the capture closes, and how many of them the synthesis closes too."""

    captured: int
    synthesised: int


def closures(synthesised: np.ndarray, captured: np.ndarray, transcript: Transcript, rate_hz: float) -> Closures:
    """Count p, b, m whose gap comes within 2 mm of the least gap of the captured sentence.

    That least is the measure of both, so that a mouth which hardly opens or never shuts gains nothing. A phone's frames
    are those that it touches.

    synthesised, captured : gaps, mm, shape (n_frames,)
    """
    closed = captured.min() + CLOSED_MM
    n_captured = n_synthesised = 0
    for utterance in transcript.phonemes:
        start, stop = int(utterance.start_s * rate_hz), int(np.ceil(utterance.end_s * rate_hz)) + 1
        if utterance.phone in BILABIALS and start < len(captured) and captured[start:stop].min() <= closed:
            n_captured += 1
            n_synthesised += bool(synthesised[start:stop].min() <= closed)
    return Closures(n_captured, n_synthesised)


class Roughness(NamedTuple):
    """What the markers do, on average, where one phone meets the next."""

    velocity_jump_mm_s: float
    acceleration_mm_s2: float


def roughness_at_joins(positions: np.ndarray, transcript: Transcript, rate_hz: float) -> Roughness | None:
    """Velocity jump and acceleration over each boundary of two phones that are spoken; None when there is none.

    With the boundary between frames b - 1 and b, the jump is that from the step before b - 1 to the step after b, and
    the acceleration the mean of those at b - 1 and at b. A boundary that was captured whole is the standard.
    """
    _, ends = frame_bounds([], [u.end_s for u in transcript.phonemes], rate_hz)
    spoken = [u.phone != PAU for u in transcript.phonemes]
    joins = [b for b, left, right in zip(ends, spoken, spoken[1:]) if left and right and 2 <= b < len(positions) - 1]
    if not joins:
        return None
    b = np.array(joins)
    steps = np.diff(positions, axis=0) * rate_hz  # steps[f] leads from frame f to f + 1
    bends = np.diff(steps, axis=0) * rate_hz  # bends[f] is at frame f + 1

    def length(vectors: np.ndarray) -> float:
        return float(np.linalg.norm(vectors, axis=2).mean())

    return Roughness(length(steps[b] - steps[b - 2]), (length(bends[b - 2]) + length(bends[b - 1])) / 2)
