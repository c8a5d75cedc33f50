"""Boundaries between phonemes, moved so that words go with them."""

from __future__ import annotations

from dataclasses import replace

from core.errors import UserFacingError
from core.speech.transcript import Transcript

SHORTEST_PHONEME_S = 0.01
# word boundaries this close to a moved phoneme boundary move with it
_TOGETHER_S = 1e-3


def with_boundary(transcript: Transcript, slot: int, time_s: float) -> Transcript:
    """Return ``transcript`` with the end of phoneme ``slot`` at ``time_s``, or as near as leaves both phonemes 10 ms.

    A word's edge that lay there moves too. Raises `UserFacingError` when there is no room.
    """
    phonemes = list(transcript.phonemes)
    before, after = phonemes[slot : slot + 2]
    earliest_s, latest_s = before.start_s + SHORTEST_PHONEME_S, after.end_s - SHORTEST_PHONEME_S
    if earliest_s > latest_s:
        raise UserFacingError(f"Between /{before.phone}/ and /{after.phone}/ there is no room to move a boundary.")
    old_s, time_s = before.end_s, float(min(max(time_s, earliest_s), latest_s))
    phonemes[slot : slot + 2] = replace(before, end_s=time_s), replace(after, start_s=time_s)
    return replace(transcript, phonemes=tuple(phonemes), words=_words_with(transcript, old_s, time_s))


def _words_with(transcript: Transcript, old_s: float, new_s: float) -> tuple:
    def moved(time_s: float) -> float:
        return new_s if abs(time_s - old_s) <= _TOGETHER_S else time_s

    words = (replace(word, start_s=moved(word.start_s), end_s=moved(word.end_s)) for word in transcript.words)
    return tuple(new if new.end_s > new.start_s else old for new, old in zip(words, transcript.words))
