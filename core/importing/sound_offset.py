"""By how much a capture's motion is late against its sound: where the mouth opens when the speech says it should."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.media.audio import Audio
from core.speech.loudness import FRAME_S, levels_db
from core.speech.phoneme import PAU
from core.speech.transcript import Transcript

LONGEST_OFFSET_S = 0.6
# How far the lips are apart, 0..1, as phoneticians rank the sounds: lips closed, lip on teeth, teeth together, tongue
# up, open vowels. A pause keeps the lips nearly closed.
_OPENING = {
    "aa": 1.0, "ae": 1.0, "ah": 0.7, "ao": 0.9, "aw": 0.9, "ay": 0.9, "eh": 0.8, "er": 0.5, "ey": 0.7, "ih": 0.6,
    "iy": 0.5, "ow": 0.7, "oy": 0.7, "uh": 0.5, "uw": 0.35, "b": 0.0, "p": 0.0, "m": 0.0, "f": 0.15, "v": 0.15,
    PAU: 0.05,
}  # fmt: skip
_OTHER_CONSONANT = 0.4
# The mouth does not jump from sound to sound.
_MOUTH_S = 0.03
# Loudness beside phones in what is expected, and the mouth's speed beside its opening in what is compared: best on
# every sixth GRID sentence, which are in step.
_LOUDNESS, _SPEED = 0.25, 2.0
_FLOOR_DB = 30.0
# Another peak counts as a rival only beyond the width of one syllable's agreement.
_RIVAL_S = 0.12
_SURE_LEAD = 0.3
_SURE_AGREEMENT = 0.6


@dataclass(frozen=True)
class OffsetEstimate:
    """A measured offset.

    offset_s : seconds by which the motion is late; negative, it is early
    confidence : 0..1, from how well mouth and speech agree there, and how much better than elsewhere
    lags_s, agreement : float64, shape (n_lags,), the correlation at each offset, for a picture
    """

    offset_s: float
    confidence: float
    lags_s: np.ndarray
    agreement: np.ndarray


def mouth_opening(positions: np.ndarray, upper_lip: int | None, lower_lip: int | None) -> np.ndarray:
    """Return how far the mouth is open, mm, shape (n_frames,): the distance of the lip markers, which knows no head.

    Without lip markers it is the first principal component of the markers' distances to each other's mean: whatever
    moves most. Its sign is then unknown (see `audio_offset`). positions as in `core.motion.recording.Recording`.
    """
    positions = np.asarray(positions, float)
    if upper_lip is not None and lower_lip is not None:
        return np.linalg.norm(positions[:, upper_lip] - positions[:, lower_lip], axis=1)
    middle = np.nanmean(positions, axis=1, keepdims=True)
    distance = np.linalg.norm(positions - middle, axis=2)
    distance -= np.nanmean(distance, axis=0)
    distance = np.where(np.isfinite(distance), distance, 0.0)
    return distance @ np.linalg.svd(distance, full_matrices=False)[2][0]


def audio_offset(
    opening: np.ndarray, rate_hz: float, audio: Audio, transcript: Transcript | None = None, signed: bool = True
) -> OffsetEstimate | None:
    """Measure the offset of one sentence; None when there is nothing to compare (too short, still, or silent).

    opening : shape (n_frames,), as `mouth_opening` gives it, NaN where unknown; signed : False if its sign is unknown
    transcript : phones on the sound's time axis; without them the loudness alone is compared
    """
    expected = _expected(audio, transcript)
    n = len(expected)
    times = np.arange(n) * FRAME_S
    frames = np.arange(len(opening)) / rate_hz
    known = np.isfinite(opening)
    if known.sum() < 8 or np.ptp(opening[known]) < 1e-6 or np.ptp(expected) < 1e-6:
        return None
    # one lag after the other: the sound at t stands against the motion at t + lag
    lags = np.arange(-round(LONGEST_OFFSET_S / FRAME_S), round(LONGEST_OFFSET_S / FRAME_S) + 1) * FRAME_S
    sigma = max(_MOUTH_S / FRAME_S, 1.0)
    goal = np.stack([_unit(expected), _unit(np.gradient(expected))])
    agreement = np.zeros(len(lags))
    for i, lag in enumerate(lags):
        inside = (times + lag >= frames[0]) & (times + lag <= frames[-1])
        if inside.sum() < 0.5 * n:
            continue
        seen = gaussian_filter1d(np.interp(times[inside] + lag, frames[known], opening[known]), sigma, mode="nearest")
        parts = [float(_unit(s) @ _unit(g[inside])) / inside.sum()
                 for s, g in zip((seen, np.gradient(seen)), goal)]  # fmt: skip
        both = (parts[0] + _SPEED * parts[1]) / (1.0 + _SPEED)
        agreement[i] = both if signed else abs(both)
    return _estimate(lags, agreement)


def pooled_offset(estimates: Sequence[OffsetEstimate]) -> OffsetEstimate | None:
    """Return the one offset that all sentences agree on best, from the mean of their agreements; None for none."""
    if not estimates:
        return None
    return _estimate(estimates[0].lags_s, np.mean([e.agreement for e in estimates], axis=0))


def _expected(audio: Audio, transcript: Transcript | None) -> np.ndarray:
    levels = levels_db(audio.samples, audio.rate_hz)
    loud = float(np.percentile(levels, 98))
    expected = _LOUDNESS * _unit(np.clip((levels - loud) / _FLOOR_DB + 1.0, 0.0, 1.0))
    if transcript is not None:
        said = np.full(len(levels), _OPENING[PAU])
        for utterance in transcript.phonemes:
            span = slice(round(utterance.start_s / FRAME_S), round(utterance.end_s / FRAME_S))
            said[span] = _OPENING.get(utterance.phone, _OTHER_CONSONANT)
        expected += _unit(said)
    return gaussian_filter1d(expected, _MOUTH_S / FRAME_S, mode="nearest")


def _unit(track: np.ndarray) -> np.ndarray:
    spread = track.std()
    return (track - track.mean()) / spread if spread > 1e-12 else np.zeros_like(track)


def _estimate(lags: np.ndarray, agreement: np.ndarray) -> OffsetEstimate:
    best = int(np.argmax(agreement))
    offset = lags[best]
    if 0 < best < len(lags) - 1:
        a, b, c = agreement[best - 1 : best + 2]
        if a - 2 * b + c < 0:
            offset += FRAME_S * 0.5 * (a - c) / (a - 2 * b + c)
    away = np.abs(lags - lags[best]) > _RIVAL_S
    lead = agreement[best] - agreement[away].max()
    confidence = np.clip(agreement[best] / _SURE_AGREEMENT, 0, 1) * np.clip(lead / _SURE_LEAD, 0, 1)
    return OffsetEstimate(float(offset), float(confidence), lags, agreement)
