"""How long a synthesis takes by the number of its phonemes (Deng and Neumann 2008, table 5)."""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence

import numpy as np

from core.media.audio import Audio
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.engine import MotionEngine, SpeechInput

# Phonemes, and seconds without and with graphics hardware of 2006, on 5,556 motion nodes.
PAPER_TIMES_S = {14: (221.391, 50.828), 24: (333.171, 90.891), 53: (815.719, 232.078), 63: (942.609, 256.484)}
_REPEATS = 3
_SOUND_HZ = 16_000


def phrase_of(transcripts: Sequence[Transcript], n_phonemes: int) -> Transcript:
    """Lay transcripts end to end, from the first again after the last, and cut after ``n_phonemes``."""
    spoken: list[PhonemeUtterance] = []
    at_s = 0.0
    while len(spoken) < n_phonemes:
        for transcript in transcripts:
            spoken += [PhonemeUtterance(u.phone, at_s + u.start_s, at_s + u.end_s) for u in transcript.phonemes]
            at_s += transcript.duration_s
    spoken = spoken[:n_phonemes]
    return Transcript(tuple(spoken), (), spoken[-1].end_s)


def phrase_times_s(engine: MotionEngine, transcripts: Sequence[Transcript]) -> dict[int, float]:
    """Seconds that a prepared engine takes for each length of table 5, medians of three."""
    taken = {}
    for n_phonemes in PAPER_TIMES_S:
        phrase = phrase_of(transcripts, n_phonemes)
        # silence takes those that listen as long as speech would
        audio = Audio(np.zeros(round(phrase.duration_s * _SOUND_HZ), np.float32), _SOUND_HZ)
        speech = SpeechInput(phrase, audio=audio)
        times = []
        for _ in range(_REPEATS):
            began = time.perf_counter()
            engine.synthesise(speech)
            times.append(time.perf_counter() - began)
        taken[n_phonemes] = statistics.median(times)
    return taken
