"""A vowel dragged out in a sentence, as a singer does: does its shape stay?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.animeme.animeme import AnimemeModel
from core.speech.transcript import PhonemeUtterance, Transcript

VOWELS = frozenset(["ae", "ax", "ah", "aa", "ao", "iy", "ih", "ay", "aw", "ey", "eh", "er", "ow", "oy", "uw", "uh"])


def dragged(transcript: Transcript, slot: int, duration_s: float) -> Transcript:
    """Return ``transcript`` with phoneme ``slot`` lasting ``duration_s``, all after it later, words left out."""
    longer_s = duration_s - (transcript.phonemes[slot].end_s - transcript.phonemes[slot].start_s)
    moved = [
        PhonemeUtterance(u.phone, u.start_s + longer_s * (p > slot), u.end_s + longer_s * (p >= slot))
        for p, u in enumerate(transcript.phonemes)
    ]
    return Transcript(tuple(moved), (), transcript.duration_s + longer_s)


def wander_when_dragged(
    model: AnimemeModel, transcripts: Sequence[Transcript], control: str, duration_s: float = 2.0, holds: bool = False
) -> float:
    """How much a control changes within the middle eight tenths of a dragged vowel, over its range in the sentence.

    The longest vowel of each sentence is dragged to ``duration_s``; mean over sentences. 0 is a shape that stays.
    """
    rate_hz, found = 60.0, []
    for transcript in transcripts:
        vowels = [p for p, u in enumerate(transcript.phonemes) if u.phone in VOWELS]
        if not vowels:
            continue
        slot = max(vowels, key=lambda p: transcript.phonemes[p].end_s - transcript.phonemes[p].start_s)
        sung = dragged(transcript, slot, duration_s)
        usual = np.ptp(model.curves(transcript, rate_hz).column(control))
        start_s = sung.phonemes[slot].start_s
        values = model.curves(sung, rate_hz, holds=holds).column(control)
        middle = values[int((start_s + 0.1 * duration_s) * rate_hz) : int((start_s + 0.9 * duration_s) * rate_hz)]
        found.append(float(np.ptp(middle) / usual))
    return float(np.mean(found)) if found else 0.0
