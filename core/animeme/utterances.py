"""Phonemes of one or many sentences as arrays, and which of them are near which frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.speech.emotion import emotion_weights
from core.speech.phoneme import PAU, PHONEME_INDEX
from core.speech.transcript import Transcript

_SHORTEST_S = 1e-3  # a phoneme has a time of its own to be placed in, however short a label says it is
_PAU = PHONEME_INDEX[PAU]


@dataclass(frozen=True, eq=False)
class Utterances:
    """J phoneme occurrences, sentence after sentence; each sentence has its own time axis.

    phoneme, previous, following : int, shape (J,), index into `PHONEMES`; silence beyond a sentence's edge
    start_s, duration_s : float64, shape (J,)
    emotions : float64, shape (J, n_emotions), the mix that each is said in, rows sum to 1
    first : int, shape (n_sentences + 1,), where each sentence begins
    """

    phoneme: np.ndarray
    previous: np.ndarray
    following: np.ndarray
    start_s: np.ndarray
    duration_s: np.ndarray
    emotions: np.ndarray
    first: np.ndarray

    def __len__(self) -> int:
        return len(self.phoneme)

    @classmethod
    def of(cls, transcripts: Sequence[Transcript], modifiers: Sequence[Sequence] | None = None) -> Utterances:
        """Gather the phonemes of ``transcripts``; ``modifiers``: emotion spans, a sequence a sentence."""
        parts: list[tuple[np.ndarray, ...]] = []
        for s, transcript in enumerate(transcripts):
            said = transcript.phonemes
            phoneme = np.array([PHONEME_INDEX[u.phone] for u in said])
            starts_s, ends_s = (np.array([getattr(u, end) for u in said]) for end in ("start_s", "end_s"))
            around = np.concatenate([[_PAU], phoneme, [_PAU]])
            felt = emotion_weights(starts_s, ends_s, modifiers[s] if modifiers else ())
            durations_s = np.maximum(ends_s - starts_s, _SHORTEST_S)
            parts.append((phoneme, around[:-2], around[2:], starts_s, durations_s, felt))
        first = np.cumsum([0, *(len(part[0]) for part in parts)])
        return cls(*(np.concatenate(column) for column in zip(*parts)), first)


@dataclass(frozen=True, eq=False)
class Nearby:
    """Pairs of a frame and a phoneme that may have a say in it, in order of the frames.

    frame, utterance : int, shape (N,)
    offset_s : float64, shape (N,), from the phoneme's centre to the frame
    n_frames : frames of all sentences together
    """

    frame: np.ndarray
    utterance: np.ndarray
    offset_s: np.ndarray
    n_frames: int

    @classmethod
    def of(cls, utterances: Utterances, times_s: Sequence[np.ndarray], neighbours: int) -> Nearby:
        """Pair each frame with the phoneme said then, and with up to ``neighbours`` before and after it.

        times_s : when the frames of each sentence stand, ascending
        """
        current = np.concatenate([
            np.clip(
                np.searchsorted(utterances.start_s[first:stop], times, side="right") - 1, 0, stop - first - 1
            ) + first
            for first, stop, times in zip(utterances.first, utterances.first[1:], times_s)
        ])  # fmt: skip
        lengths = [len(times) for times in times_s]
        lowest, highest = (np.repeat(edge, lengths)[:, None] for edge in (utterances.first[:-1], utterances.first[1:]))
        near = current[:, None] + np.arange(-neighbours, neighbours + 1)
        frame, k = np.nonzero((near >= lowest) & (near < highest))
        utterance = near[frame, k]
        centre_s = utterances.start_s[utterance] + utterances.duration_s[utterance] / 2
        return cls(frame, utterance, np.concatenate(times_s)[frame] - centre_s, len(current))
