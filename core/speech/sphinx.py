"""pocketsphinx, held at one place: forced alignment and recognition of one stretch of sound."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio, resampled

SPHINX_RATE_HZ = 16_000
FRAME_S = 0.01
# Below about three 10 ms frames a phone the models of three states cannot pass.
SHORTEST_PHONE_S = 0.03

# Silence around the sound lets the first and last phone begin; dither keeps digital silence from the logarithm.
_PAD_S = 0.25
_DITHER = 2.0
_PEAK = 0.8 * 32767
# Pruning so wide that only too little time can stop an alignment.
_WIDE = 1e-300

_PARTS_IN_ARPABET = {"ax": ("AH",), "el": ("AH", "L"), "em": ("AH", "M"), "en": ("AH", "N")}


@dataclass(frozen=True)
class HeardWord:
    """One word as the decoder places it, in seconds of the whole sound; silence and noise are no words.

    index : which of the words asked for; for a recognised word its place in the result
    phones : (phone of our set, start_s, end_s), empty when only the word was placed
    mismatch : mean log-likelihood per frame, in the decoder's unit, by which the best-fitting sounds beat this word's;
        0 is perfect. Right words of clean speech have about 15 (95 % below 35), wrong ones 55; 0 if not measured
    """

    index: int
    word: str
    start_s: float
    end_s: float
    phones: tuple[tuple[str, float, float], ...] = ()
    mismatch: float = 0.0

    @property
    def duration_s(self) -> float:
        """Length in seconds."""
        return self.end_s - self.start_s


class SphinxSound:
    """A sound as the decoder wants it: 16 kHz, full level."""

    def __init__(self, audio: Audio) -> None:
        self.samples = resampled(audio, SPHINX_RATE_HZ).samples
        self.duration_s = audio.duration_s
        self._gain = _PEAK / max(float(np.abs(self.samples).max()), 1e-6)

    def pcm(self, start_s: float, end_s: float) -> bytes:
        """Return 16-bit samples of a stretch, with silence around and dither, the same at every call."""
        piece = self.samples[round(start_s * SPHINX_RATE_HZ) : round(end_s * SPHINX_RATE_HZ)]
        padded = np.pad(piece * self._gain, round(_PAD_S * SPHINX_RATE_HZ))
        padded += np.random.default_rng(0).normal(0, _DITHER, len(padded))
        return np.clip(padded, -32768, 32767).astype("<i2").tobytes()


class SphinxAligner:
    """Aligns words that it was given with sound; one at a time, not for use by two threads."""

    def __init__(self, wide: bool = False) -> None:
        beams = {"beam": _WIDE, "wbeam": _WIDE, "pbeam": _WIDE} if wide else {}
        self._decoder = _decoder(lm=None, bestpath=False, **beams)
        self._variants: dict[str, tuple[str, ...]] = {}

    def dictionary(self, word: str) -> list[tuple[str, ...]]:
        """Return the pronunciations of ``word`` in pocketsphinx's English dictionary, in ARPAbet without stress."""
        found = []
        while phones := self._decoder.lookup_word(word if not found else f"{word}({len(found) + 1})"):
            found.append(tuple(phones.split()))
        return found

    def add_word(self, index: int, variants: Sequence[tuple[str, ...]]) -> None:
        """Make word number ``index`` known, to be said in one of ``variants`` (our phones)."""
        for v, phones in enumerate(variants, start=1):
            name = _name(index) if v == 1 else f"{_name(index)}({v})"
            arpabet = [part for phone in phones for part in _in_arpabet(phone)]
            self._decoder.add_word(name, " ".join(arpabet), False)
            self._variants[name] = phones

    def place_words(self, sound: SphinxSound, start_s: float, end_s: float, words: Sequence[int]) -> list[HeardWord]:
        """Place added ``words`` (their numbers) in a stretch of sound; an empty list when they do not fit."""
        self._decoder.set_align_text(" ".join(map(_name, words)))
        self._decode(sound.pcm(start_s, end_s))
        if self._decoder.hyp() is None:
            return []
        clock = _Clock(start_s, end_s)
        placed = [s for s in self._decoder.seg() if s.word in self._variants]
        return [HeardWord(_index(s.word), s.word, clock(s.start_frame), clock(s.end_frame + 1)) for s in placed]

    def place_phones(self, sound: SphinxSound, start_s: float, end_s: float, words: Sequence[int]) -> list[HeardWord]:
        """Place words and their phones; memory grows with the square of the length, so for less than a minute."""
        if not self.place_words(sound, start_s, end_s, words):
            return []
        self._decoder.set_alignment()
        self._decode(sound.pcm(start_s, end_s))
        alignment = self._decoder.get_alignment()
        clock = _Clock(start_s, end_s)
        placed = []
        for entry in alignment or ():
            if entry.name not in self._variants:
                continue
            edges = [*(clock(part.start) for part in entry), clock(entry.start + entry.duration)]
            mismatch = -entry.score / entry.duration
            phones = []
            at = 0
            for phone in self._variants[entry.name]:
                n_parts = len(_in_arpabet(phone))
                phones.append((phone, edges[at], edges[at + n_parts]))
                at += n_parts
            placed.append(HeardWord(_index(entry.name), entry.name, edges[0], edges[-1], tuple(phones), mismatch))
        return placed

    def _decode(self, pcm: bytes) -> None:
        self._decoder.start_utt()
        self._decoder.process_raw(pcm, full_utt=True)
        self._decoder.end_utt()


class SphinxRecogniser:
    """Recognises American English with pocketsphinx's general language model."""

    def __init__(self) -> None:
        # 3,000 states a frame hear the same words in our trials as the default 30,000, in two thirds of the time
        self._decoder = _decoder(maxhmmpf=3000)

    def words(self, sound: SphinxSound, start_s: float, end_s: float) -> list[HeardWord]:
        """Return the words heard in a stretch of sound; none in silence."""
        self._decoder.start_utt()
        self._decoder.process_raw(sound.pcm(start_s, end_s), full_utt=True)
        self._decoder.end_utt()
        if self._decoder.hyp() is None:
            return []
        clock = _Clock(start_s, end_s)
        spoken = [s for s in self._decoder.seg() if s.word[0] not in "<[+"]
        return [
            HeardWord(i, s.word.partition("(")[0], clock(s.start_frame), clock(s.end_frame + 1))
            for i, s in enumerate(spoken)
        ]


@dataclass(frozen=True)
class _Clock:
    """Turns frames of a padded stretch into seconds of the whole sound."""

    start_s: float
    end_s: float

    def __call__(self, frame: int) -> float:
        time_s = round(self.start_s - _PAD_S + frame * FRAME_S, 6)
        return min(max(time_s, self.start_s), self.end_s)


def _decoder(**settings):
    from pocketsphinx import Decoder

    try:
        return Decoder(samprate=SPHINX_RATE_HZ, loglevel="FATAL", **settings)
    except RuntimeError as error:
        raise UserFacingError(
            "The speech models of pocketsphinx cannot be loaded.", "Install the package pocketsphinx again."
        ) from error


def _in_arpabet(phone: str) -> tuple[str, ...]:
    return _PARTS_IN_ARPABET.get(phone, (phone.upper(),))


def _name(index: int) -> str:
    return f"word-{index}"


def _index(name: str) -> int:
    return int(name.partition("(")[0].removeprefix("word-"))
