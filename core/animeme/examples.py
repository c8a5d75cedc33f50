"""What animemes are learnt from: sentences with their control curves."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.animeme.levels import N_PHONEMES
from core.animeme.utterances import Nearby, Utterances
from core.errors import UserFacingError
from core.rig.control_track import ControlTrack
from core.speech.emotion import EmotionModifier
from core.speech.phoneme import PHONEME_INDEX
from core.speech.transcript import Transcript

# Durations of a phoneme that was never said.
_USUAL_SPAN_S = (0.04, 0.2)


@dataclass(frozen=True, eq=False)
class Example:
    """One sentence: what is said, how the controls moved, and the emotion it was said in."""

    transcript: Transcript
    track: ControlTrack
    emotion: str = "neutral"


@dataclass(frozen=True, eq=False)
class Lesson:
    """Examples as arrays.

    times_s : when the frames of each sentence stand
    values : float64, shape (n_frames, U)
    """

    utterances: Utterances
    times_s: tuple[np.ndarray, ...]
    values: np.ndarray
    names: tuple[str, ...]
    rate_hz: float
    n_emotions: int

    @classmethod
    def of(cls, examples: Sequence[Example]) -> Lesson:
        """Gather ``examples``; raises `UserFacingError` when there are none, or their controls or rates differ."""
        if not examples:
            raise UserFacingError("There are no sentences to learn animemes from.")
        first = examples[0].track
        for example in examples:
            if example.track.names != first.names or abs(example.track.rate_hz - first.rate_hz) > 1e-6:
                raise UserFacingError("The sentences to learn from have different controls or frame rates.")
        transcripts = [example.transcript for example in examples]
        felt = [[EmotionModifier(0.0, e.transcript.duration_s, e.emotion)] for e in examples]
        return cls(
            Utterances.of(transcripts, felt),
            tuple(example.track.times_s for example in examples),
            np.concatenate([example.track.values for example in examples]).astype(float),
            first.names,
            first.rate_hz,
            len({example.emotion for example in examples}),
        )

    @property
    def span_s(self) -> np.ndarray:
        """Shortest and longest duration of each phoneme, seconds, float64, shape (2, n_phonemes)."""
        span = np.repeat(np.array(_USUAL_SPAN_S)[:, None], N_PHONEMES, axis=1)
        for p in np.unique(self.utterances.phoneme):
            said_s = self.utterances.duration_s[self.utterances.phoneme == p]
            span[:, p] = said_s.min(), said_s.max()
        return span

    def emphasis(self, phones: Sequence[str], count: float) -> np.ndarray:
        """Return ``count`` for frames in which one of ``phones`` is said, else 1; float64, shape (n_frames,)."""
        named = np.isin(self.utterances.phoneme, [PHONEME_INDEX[phone] for phone in phones])
        return np.where(named[Nearby.of(self.utterances, self.times_s, 0).utterance], count, 1.0)

    def digest(self) -> str:
        """Return a hex digest of all that is learnt from."""
        found = hashlib.sha256(f"{self.names} {self.rate_hz!r}".encode())
        spoken = self.utterances
        for array in (spoken.phoneme, spoken.start_s, spoken.duration_s, spoken.emotions, spoken.first, self.values):
            found.update(np.ascontiguousarray(array).tobytes())
        return found.hexdigest()
