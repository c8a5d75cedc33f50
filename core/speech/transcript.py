"""What is said, and when: phoneme and word utterances on one time axis."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from core.speech.phoneme import PAU


@dataclass(frozen=True)
class PhonemeUtterance:
    """One phoneme of our set as it is said, from ``start_s`` to ``end_s`` in seconds."""

    phone: str
    start_s: float
    end_s: float


@dataclass(frozen=True)
class WordUtterance:
    """One word as it is said, in seconds."""

    word: str
    start_s: float
    end_s: float


@dataclass(frozen=True)
class Transcript:
    """Aligned speech: phonemes that follow each other without a gap from 0 to ``duration_s``.

    ``warnings`` are sentences for the user about what had to be guessed (an unknown phone, a word that is not in
    the dictionary). Make one with `Transcript.covering`.
    """

    phonemes: tuple[PhonemeUtterance, ...]
    words: tuple[WordUtterance, ...]
    duration_s: float
    warnings: tuple[str, ...] = field(default=())

    @property
    def phones(self) -> tuple[str, ...]:
        """The phone names, in order."""
        return tuple(utterance.phone for utterance in self.phonemes)

    def between(self, start_s: float, end_s: float) -> Transcript:
        """Return what is said from ``start_s`` to ``end_s``, on a time axis that begins at ``start_s``."""
        end_s = min(end_s, self.duration_s)

        def inside(said: Iterable) -> list:
            cut = (
                replace(u, start_s=max(u.start_s, start_s) - start_s, end_s=min(u.end_s, end_s) - start_s) for u in said
            )
            return [u for u in cut if u.end_s > u.start_s]

        return Transcript.covering(inside(self.phonemes), inside(self.words), end_s - start_s, self.warnings)

    @classmethod
    def covering(
        cls,
        phonemes: Iterable[PhonemeUtterance],
        words: Iterable[WordUtterance],
        duration_s: float,
        warnings: Iterable[str] = (),
        shortest_gap_s: float = 1e-3,
    ) -> Transcript:
        """Lay ``phonemes`` over 0..``duration_s``: gaps become silence, neighbouring silences one.

        Phonemes are sorted, cut at ``duration_s`` and at the start of the next one; gaps shorter than
        ``shortest_gap_s`` go to the phoneme before. One that keeps no time is dropped.
        """
        laid: list[PhonemeUtterance] = []

        def lay(phone: str, start_s: float, end_s: float) -> None:
            if end_s - start_s <= 0:
                return
            if laid and laid[-1].phone == phone == PAU:
                start_s = laid.pop().start_s
            laid.append(PhonemeUtterance(phone, start_s, end_s))

        now_s = 0.0
        ordered = sorted(phonemes, key=lambda u: (u.start_s, u.end_s))
        for utterance, following in zip(ordered, [*ordered[1:], None]):
            start_s = max(utterance.start_s, now_s)
            end_s = min(utterance.end_s, duration_s)
            if following is not None:
                end_s = min(end_s, max(following.start_s, start_s))
            if end_s <= start_s:
                continue
            if start_s - now_s > shortest_gap_s:
                lay(PAU, now_s, start_s)
            else:
                start_s = now_s
            lay(utterance.phone, start_s, end_s)
            now_s = end_s
        if duration_s - now_s > shortest_gap_s or not laid:
            lay(PAU, now_s, duration_s)
        elif laid[-1].end_s < duration_s:
            last = laid.pop()
            laid.append(PhonemeUtterance(last.phone, last.start_s, duration_s))
        kept_words = tuple(
            WordUtterance(w.word, max(w.start_s, 0.0), min(w.end_s, duration_s))
            for w in sorted(words, key=lambda w: w.start_s)
            if w.start_s < duration_s
        )
        return cls(tuple(laid), kept_words, duration_s, tuple(warnings))
