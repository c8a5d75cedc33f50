"""How early a stop begins after a pause: its closure is silent, so an aligner takes any part of the pause for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from core.speech.sphinx import HeardWord

# Longest stop after a pause, closure and burst. 400 GRID sentences (train part): the corpus's own b lasts 50 ms, its p
# 70 ms, an aligned one up to 300 ms; Festival's labels of the demo corpus: 45 to 58 ms voiced, 82 to 105 ms voiceless.
_LONGEST_S = {"b": 0.06, "d": 0.06, "g": 0.06, "p": 0.1, "t": 0.1, "k": 0.1}
# In sums of times; far below a frame.
_ROUNDING_S = 1e-6


def with_short_closures(placed: Sequence[HeardWord]) -> list[HeardWord]:
    """Return the words, in order of time, with stops after a pause, or at the very start, begun no earlier than usual.

    The end of the stop, which can be heard, stays; the time before goes to the pause.
    """
    shortened: list[HeardWord] = []
    ended_s = 0.0
    for word in placed:
        follows_pause = not shortened or word.start_s > ended_s + _ROUNDING_S
        shortened.append(_shortened(word) if follows_pause and word.phones else word)
        ended_s = word.end_s
    return shortened


def _shortened(word: HeardWord) -> HeardWord:
    (phone, start_s, end_s), *others = word.phones
    start_s = max(start_s, round(end_s - _LONGEST_S.get(phone, end_s), 6))
    return replace(word, start_s=start_s, phones=((phone, start_s, end_s), *others))
