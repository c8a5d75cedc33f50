"""Edits of the transcript, phoneme by phoneme.

A pin or lock survives a boundary that moves; it names what stands for one phoneme, so renaming, splitting or merging
that phoneme drops it, and the edit says so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Self

from core.document.change import Change
from core.document.document import Document
from core.document.edits import FieldEdit
from core.document.parts import Speech
from core.errors import UserFacingError
from core.speech.boundaries import SHORTEST_PHONEME_S, with_boundary
from core.speech.phoneme import PHONEME_INDEX, PHONEMES
from core.speech.transcript import PhonemeUtterance

_ROUNDING_S = 1e-9


class _TranscriptEdit(FieldEdit):
    """Shared: the same sound with another transcript."""

    @classmethod
    def of(
        cls,
        document: Document,
        label: str,
        phonemes: Sequence[PhonemeUtterance],
        moved_slot: Callable[[int], int | None],
        gesture: int | None = None,
        words: tuple | None = None,
    ) -> Self:
        """Return the edit; ``moved_slot`` tells where a pin of an old slot goes, None drops it."""
        speech = document.speech
        transcript = replace(
            speech.transcript, phonemes=tuple(phonemes), words=speech.transcript.words if words is None else words
        )
        same = transcript == speech.transcript
        changed = speech if same else Speech(speech.audio, transcript, speech.text)
        pins, locks = _moved(document.pins, moved_slot), _moved(document.locks, moved_slot)
        lost = len(document.pins) - len(pins), len(document.locks) - len(locks)
        parts = [f"{n} {what}{'s' * (n > 1)}" for n, what in zip(lost, ("pin", "lock")) if n]
        note = f"{label} dropped {' and '.join(parts)}; undo brings it back." if parts else ""
        change = Change.ALIGNMENT | (Change.CONSTRAINTS if pins != document.pins or locks != document.locks
                                     else Change(0))  # fmt: skip
        return cls.setting(document, label, change, gesture=gesture, note=note,
                           speech=changed, pins=pins, locks=locks)  # fmt: skip


def _moved(ties: Mapping[int, str], moved_slot: Callable[[int], int | None]) -> Mapping[int, str]:
    moved = {moved_slot(slot): node for slot, node in ties.items()}
    return MappingProxyType({slot: node for slot, node in moved.items() if slot is not None})


class MovePhonemeBoundary(_TranscriptEdit):
    """Move the end of a phoneme, which is the start of the next; a word's edge that lay there moves too."""

    @classmethod
    def on(cls, document: Document, slot: int, time_s: float, gesture: int | None = None) -> MovePhonemeBoundary:
        """Return the edit that ends ``slot`` at ``time_s``, or as near as leaves both phonemes 10 ms.

        Raises `UserFacingError` when there is no such boundary or no room.
        """
        before, after = _phonemes(document, slot, slot + 1)[slot : slot + 2]
        moved = with_boundary(document.speech.transcript, slot, time_s)
        return cls.of(document, f"Move boundary of /{before.phone}/ and /{after.phone}/", moved.phonemes, lambda p: p,
                      gesture, moved.words)  # fmt: skip


class RenamePhoneme(_TranscriptEdit):
    """Say that another phone is spoken in a slot."""

    @classmethod
    def on(cls, document: Document, slot: int, phone: str) -> RenamePhoneme:
        """Return the edit; raises `UserFacingError` for a phone that is not of our set."""
        phonemes = list(_phonemes(document, slot))
        old = phonemes[slot].phone
        if phone not in PHONEME_INDEX:
            raise UserFacingError(f"'{phone}' is not a phone.", f"Known are {' '.join(PHONEMES)}.")
        phonemes[slot] = replace(phonemes[slot], phone=phone)
        return cls.of(
            document, f"Rename /{old}/ to /{phone}/", phonemes, lambda p: None if p == slot and phone != old else p
        )


class SplitPhoneme(_TranscriptEdit):
    """Make two utterances of one, both of its phone."""

    @classmethod
    def on(cls, document: Document, slot: int, time_s: float | None = None) -> SplitPhoneme:
        """Return the edit that splits ``slot`` at ``time_s`` (None: in the middle).

        Raises `UserFacingError` when it is too short.
        """
        phonemes = list(_phonemes(document, slot))
        old = phonemes[slot]
        if old.end_s - old.start_s < 2 * SHORTEST_PHONEME_S - _ROUNDING_S:
            raise UserFacingError(f"/{old.phone}/ lasts {1000 * (old.end_s - old.start_s):.0f} ms, too short to split.")
        middle_s = (old.start_s + old.end_s) / 2
        if time_s is None or not old.start_s + SHORTEST_PHONEME_S <= time_s <= old.end_s - SHORTEST_PHONEME_S:
            time_s = middle_s
        phonemes[slot : slot + 1] = replace(old, end_s=float(time_s)), replace(old, start_s=float(time_s))
        return cls.of(
            document, f"Split /{old.phone}/", phonemes, lambda p: p if p < slot else None if p == slot else p + 1
        )


class MergePhonemes(_TranscriptEdit):
    """Let a phoneme take over the time of the next one."""

    @classmethod
    def on(cls, document: Document, slot: int) -> MergePhonemes:
        """Return the edit; raises `UserFacingError` for the last phoneme, which has no next."""
        phonemes = list(_phonemes(document, slot, slot + 1))
        kept, gone = phonemes[slot : slot + 2]
        phonemes[slot : slot + 2] = [replace(kept, end_s=gone.end_s)]
        return cls.of(document, f"Merge /{kept.phone}/ and /{gone.phone}/", phonemes,
                      lambda p: p if p < slot else None if p <= slot + 1 else p - 1)  # fmt: skip


def _phonemes(document: Document, *slots: int) -> tuple[PhonemeUtterance, ...]:
    if document.speech is None:
        raise UserFacingError("There is no speech to edit.", "Choose speech first.")
    phonemes = document.speech.transcript.phonemes
    if not all(0 <= slot < len(phonemes) for slot in slots):
        raise UserFacingError(f"There is no phoneme {max(slots)}; the sentence has {len(phonemes)}, counted from 0.")
    return phonemes
