"""What a capture shows that the actor did not do: jitter of the tracking, and a head that was fitted a little off.

Both are judged sentence by sentence and taken out of a copy of the frames; the database keeps what was captured.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from scipy.signal import savgol_filter
from scipy.sparse import csr_matrix

from core.motion.database import CapturedSentence
from core.motion.resample import frame_bounds
from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PAU, PHONEME_INDEX, PHONEMES


def without_jitter(
    frames: np.ndarray, sentences: Iterable[CapturedSentence], rate_hz: float, window_s: float
) -> np.ndarray:
    """Smooth each sentence by Savitzky–Golay, order 2, over ``window_s``; 0.2 s is 5 frames of a camera at 25 Hz.

    frames : shape (n_frames, n_dims)
    returns : a copy, same dtype; a sentence shorter than the window stays as it is
    """
    steady = np.array(frames)
    window = 2 * round(window_s * rate_hz / 2.0) + 1
    for sentence in sentences:
        span = slice(sentence.start_frame, sentence.stop_frame)
        if 3 <= window <= sentence.stop_frame - sentence.start_frame:
            steady[span] = savgol_filter(steady[span], window, 2, axis=0)
    return steady


def without_offsets(frames: np.ndarray, sentences: Iterable[CapturedSentence], rate_hz: float) -> np.ndarray:
    """Take from each sentence what it is off, on average, from the mean frames of what is said in it.

    Each frame is expected at the mean of all frames of its phone and emotion (silences before, between and after speech
    apart). The mean distance from that, over a sentence, is a head fitted a little off, or a marker set down anew: not
    speech. Offsets and means are found in turns, twice, since each is judged by the other.

    frames : shape (n_frames, n_dims)
    returns : a copy, same dtype
    """
    sentences = tuple(sentences)
    steady = np.array(frames, float)
    spoken = _spoken(sentences, len(frames), rate_hz)
    kinds, kind = np.unique(spoken, return_inverse=True)
    count = np.bincount(kind, minlength=len(kinds))[:, None]
    of_kind = csr_matrix((np.ones(len(kind)), (kind, np.arange(len(kind)))), shape=(len(kinds), len(kind)))
    for _ in range(2):
        means = (of_kind @ steady) / count
        for sentence in sentences:
            span = slice(sentence.start_frame, sentence.stop_frame)
            steady[span] -= (steady[span] - means[kind[span]]).mean(axis=0)
    return steady.astype(frames.dtype)


def _spoken(sentences: tuple[CapturedSentence, ...], n_frames: int, rate_hz: float) -> np.ndarray:
    """One number for phone and emotion of each frame, int, shape (n_frames,); -1 outside of all sentences."""
    opening, closing = len(PHONEMES), len(PHONEMES) + 1
    spoken = np.full(n_frames, -1)
    for sentence in sentences:
        utterances = sentence.transcript.phonemes
        bounds = frame_bounds([u.start_s for u in utterances], [u.end_s for u in utterances], rate_hz)
        phones = np.array([PHONEME_INDEX[u.phone] for u in utterances])
        if utterances[-1].phone == PAU:
            phones[-1] = closing
        if utterances[0].phone == PAU:
            phones[0] = opening
        span = np.full(sentence.stop_frame - sentence.start_frame, closing)
        for phone, start, stop in zip(phones, *bounds):
            span[start:stop] = phone
        spoken[sentence.start_frame : sentence.stop_frame] = span * len(EMOTIONS) + EMOTION_INDEX[sentence.emotion]
    return spoken
