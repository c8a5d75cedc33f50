"""Which pose is the neutral one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.motion.corpus import Corpus
from core.motion.normalise import normalise
from core.motion.recording import Recording
from core.speech.phoneme import PAU


def silent_frames(recording: Recording) -> np.ndarray:
    """Return a bool mask, shape (n_frames,), of frames inside a silence, 40 ms away from its ends."""
    times = np.arange(len(recording.positions)) / recording.rate_hz
    mask = np.zeros(len(times), bool)
    for utterance in recording.transcript.phonemes:
        if utterance.phone == PAU:
            mask |= (times >= utterance.start_s + 0.04) & (times <= utterance.end_s - 0.04)
    return mask


def choose_rest_pose(corpus: Corpus, columns: np.ndarray, rigid: np.ndarray, origin: int | None) -> np.ndarray:
    """Mean face of the corpus in neutral silence, lips closed.

    Of the silent frames of neutral sentences (of all sentences when none is neutral) the fifth with the smallest lip
    gap is averaged, in the head space of the first such frame, then once more in the space of that mean.

    columns : rows of the kept markers within the recordings
    returns : float64, shape (n_kept, 3), origin marker (or rigid centroid) at 0
    """
    neutral = [r for r in corpus.recordings if r.emotion == "neutral"] or list(corpus.recordings)
    frames = np.concatenate([_candidates(r, columns) for r in neutral])
    if len(frames) == 0:
        raise ValueError("no frame shows all markers")
    names = list(corpus.kept_markers)
    lips = [corpus.landmarks.get(name) for name in ("upper_lip", "lower_lip")]
    rest = frames[0]
    for _ in range(2):
        rest = rest - (rest[origin] if origin is not None else rest[rigid].mean(axis=0))
        face, _ = normalise(frames, rest, rigid, origin, corpus.with_scale)
        if all(name in names for name in lips):
            gap = np.linalg.norm(face[:, names.index(lips[0])] - face[:, names.index(lips[1])], axis=1)
            face = face[gap <= np.quantile(gap, 0.2)]
        rest = face.mean(axis=0)
    return rest - (rest[origin] if origin is not None else rest[rigid].mean(axis=0))


def _candidates(recording: Recording, columns: np.ndarray, most: int = 200) -> np.ndarray:
    positions = np.asarray(recording.positions, float)[:, columns]
    whole = np.isfinite(positions).all(axis=(1, 2))
    mask = silent_frames(recording) & whole
    chosen: Sequence[int] = np.flatnonzero(mask if mask.any() else whole)
    return positions[chosen[:: max(1, len(chosen) // most)]]
