"""Head and gaze for speech that nobody was filmed saying: small, smooth, and the same each time.

The head nods into loud words and drifts from phrase to phrase; the eyes rest on a point, jump to another one, and
come back. Seeded by what is said, so that the same speech always moves the same way.
"""

from __future__ import annotations

import hashlib

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.ndimage import gaussian_filter1d

from core.speech.phoneme import PAU
from core.speech.transcript import Transcript

# Sizes of a calm talker's motion, as standard deviations; larger is a shaking head.
DRIFT_DEG = (1.1, 1.5, 0.9)  # nodding, turning, tilting
NOD_DEG = 1.9
DRIFT_KNOT_S = (0.55, 1.1)
SHIFT_MM = (0.8, 0.5, 1.2)
EASE_S = 0.35

GAZE_DEG = (3.2, 1.6)
FIXATION_S = (0.35, 1.5)
SACCADE_S = 0.035
STAYS = 0.35  # how often the eyes, resting on the viewer, do so again
RETURNS = 0.75  # how often they come back from elsewhere


def head_track(
    transcript: Transcript, rate_hz: float, n_frames: int, loudness_db: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Return rotation vectors (radians) and translations (mm) of the head, both float64, shape (n_frames, 3).

    loudness_db : level of each 10 ms (`core.speech.loudness.levels_db`), for nods; without it words are nodded to by
        their length. At the first and the last frame the head is at rest.
    """
    rng = _seeded(transcript, "head")
    time_s = np.arange(n_frames) / rate_hz
    end_s = max(n_frames / rate_hz, 1.0 / rate_hz)
    drift = np.stack([_wander(rng, time_s, end_s) * np.radians(size) for size in DRIFT_DEG], axis=1)
    # pitch about x: positive looks down
    drift[:, 0] += np.radians(NOD_DEG) * _emphasis(transcript, time_s, rate_hz, loudness_db)
    shift = np.stack([_wander(rng, time_s, end_s) * size for size in SHIFT_MM], axis=1)
    ease = np.clip(np.minimum(time_s, time_s[-1] - time_s) / EASE_S, 0.0, 1.0)[:, None]
    ease = ease * ease * (3.0 - 2.0 * ease)
    return drift * ease, shift * ease


def gaze_track(transcript: Transcript, rate_hz: float, n_frames: int) -> np.ndarray:
    """Return where the eyes look: yaw (to the character's left) and pitch (up) in degrees, float64, (n_frames, 2).

    Fixations with quick jumps between them; over half of the time, and first and last, they look at the viewer.
    """
    rng = _seeded(transcript, "gaze")
    end_s = n_frames / rate_hz
    starts, targets = [0.0], [np.zeros(2)]
    while starts[-1] < end_s:
        starts.append(starts[-1] + rng.uniform(*FIXATION_S))
        away = rng.normal(size=2) * GAZE_DEG
        at_viewer = rng.random() < (RETURNS if targets[-1].any() else STAYS)
        targets.append(np.zeros(2) if at_viewer else np.clip(away, -8.0, 8.0))
    time_s = np.arange(n_frames) / rate_hz
    gaze = np.zeros((n_frames, 2))
    for start, before, after in zip(starts[1:], targets, targets[1:]):
        share = np.clip((time_s - start) / SACCADE_S, 0.0, 1.0)[:, None]
        gaze += share * (after - before)
    back = np.clip((end_s - 0.25 - time_s) / SACCADE_S, 0.0, 1.0)[:, None]
    return gaze * back


def _seeded(transcript: Transcript, track: str) -> np.random.Generator:
    said = " ".join(f"{u.phone} {u.start_s:.3f}" for u in transcript.phonemes)
    digest = hashlib.sha256(f"{track} {said}".encode()).digest()
    return np.random.default_rng(int.from_bytes(digest[:8], "big"))


def _wander(rng: np.random.Generator, time_s: np.ndarray, end_s: float) -> np.ndarray:
    knots = [-1.0, 0.0]
    while knots[-1] < end_s + 1.0:
        knots.append(knots[-1] + rng.uniform(*DRIFT_KNOT_S))
    return gaussian_filter1d(PchipInterpolator(knots, rng.normal(size=len(knots)))(time_s), 3.0, mode="nearest")


def _emphasis(transcript: Transcript, time_s: np.ndarray, rate_hz: float, loudness_db: np.ndarray | None) -> np.ndarray:
    """Return 0..1: how much each moment is stressed, from the loudness of words or else their length."""
    strength = np.zeros(len(time_s))
    spoken = [u for u in transcript.phonemes if u.phone != PAU]
    words = transcript.words or tuple(spoken)
    weights = []
    for word in words:
        if loudness_db is not None and len(loudness_db):
            first = min(int(word.start_s * 100), len(loudness_db) - 1)
            weights.append(float(loudness_db[first : max(int(word.end_s * 100), first + 1)].max()))
        else:
            weights.append(word.end_s - word.start_s)
    if not weights:
        return strength
    low, high = np.quantile(weights, [0.3, 0.95])
    for word, weight in zip(words, weights):
        stress = np.clip((weight - low) / max(high - low, 1e-9), 0.0, 1.0) ** 2
        middle = word.start_s + 0.4 * (word.end_s - word.start_s)
        strength = np.maximum(strength, stress * np.exp(-(((time_s - middle) / 0.14) ** 2)))
    return gaussian_filter1d(strength, max(0.05 * rate_hz, 0.5), mode="nearest")
