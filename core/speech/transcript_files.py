"""Transcripts with times, from whatever tool they come."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from core.errors import UserFacingError
from core.speech.label_file import parse_labels
from core.speech.phone_names import is_ipa, phone_named, phones_named
from core.speech.phone_table import PhoneTable, by_table
from core.speech.phoneme import PAU
from core.speech.text_file import read_text
from core.speech.textgrid import IntervalTier, parse_textgrid
from core.speech.timed_label import TimedLabel, check_order
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

# How far a transcript may end from the end of its sound. A quarter of a second covers the padding that encoders and
# aligners add and the frame that they drop; a wrong or cut file is off by more.
END_TOLERANCE_S = 0.25

_PHONE_TIER = re.compile(r"\b(phones?|phonemes?|segments?|segs?|phn|mau)\b")
_WORD_TIER = re.compile(r"\b(words?|wrd|orthography|ort|text)\b")
# What word tiers write where nobody speaks.
_NO_WORD = re.compile(r"|sil|sp|pau|#|_|<.*>|\[.*\]")
# A tier without a telling name is one of phones when so many of its labels are names of phones.
_LEAST_SHARE_OF_PHONES = 0.9


def read_transcript(
    path: str | Path, duration_s: float, strict: bool = False, table: PhoneTable | None = None
) -> Transcript:
    """Read a Praat TextGrid (long or short text), a Festival/xwaves or HTK label file, or ``start end phone`` lines.

    duration_s : length of the sound it belongs to
    strict : refuse phones that are not in our set, instead of taking the nearest with a warning
    table : what the names of another phone set stand for; names that it lacks are read as ARPAbet, IPA or Festival's

    A TextGrid must end within 0.25 s of the sound, for it holds its silences too. A label file may end earlier when
    its last label is silence, or, with a warning, when it marks no silence at all; none may end later.
    Raises `UserFacingError` naming the line or interval that is wrong.
    """
    name = f"'{path}'"
    text = read_text(path, "transcript")
    if "ooTextFile" in text[:200] or Path(path).suffix.lower() == ".textgrid":
        written = _from_textgrid(text, name, table or {})
    elif "\0" in text or text.startswith("ooBinary"):
        raise UserFacingError(f"{name} is not text.", "Save it as a TextGrid text file or a label file.")
    else:
        labels = tuple(parse_labels(text, name))
        written = _Written(labels, (), labels[-1].end_s if labels else 0.0, holds_all_silence=False)
    check_order(written.phones)
    check_order(written.words)
    if table:
        written = replace(written, phones=tuple(by_table(written.phones, table)))
    ours, warnings = phones_named([p.name for p in written.phones], [p.place for p in written.phones], strict)
    if all(phone == PAU for phone in ours):
        raise UserFacingError(f"{name} holds no phones.")
    may_end_early = not written.holds_all_silence and (ours[-1] == PAU or PAU not in ours)
    _check_end(name, written.end_s, duration_s, may_end_early)
    if written.end_s < duration_s - END_TOLERANCE_S and PAU not in ours:
        warnings.append(f"{name} ends at {written.end_s:.2f} s; the sound after that is taken as silence.")
    return Transcript.covering(
        (PhonemeUtterance(phone, p.start_s, p.end_s) for phone, p in zip(ours, written.phones)),
        (WordUtterance(w.name, w.start_s, w.end_s) for w in written.words if not _NO_WORD.fullmatch(w.name.lower())),
        duration_s,
        warnings,
    )


@dataclass(frozen=True)
class _Written:
    phones: tuple[TimedLabel, ...]
    words: tuple[TimedLabel, ...]
    end_s: float
    holds_all_silence: bool


def _from_textgrid(text: str, name: str, table: PhoneTable) -> _Written:
    tiers = parse_textgrid(text, name)
    phones = _tier_of_phones(tiers, name, table)
    words = next((t.labels for t in tiers if t is not phones and _WORD_TIER.search(t.name.lower())), ())
    return _Written(phones.labels, words, max(phones.end_s, phones.labels[-1].end_s), holds_all_silence=True)


def _tier_of_phones(tiers: Sequence[IntervalTier], name: str, table: PhoneTable) -> IntervalTier:
    filled = [tier for tier in tiers if any(label.name for label in tier.labels)]
    if not filled:
        raise UserFacingError(f"{name} has no tier of intervals with labels.")
    for tier in filled:
        if _PHONE_TIER.search(tier.name.lower()):
            return tier
    likely = max(filled, key=lambda tier: _share_of_phones(tier, table))
    if _share_of_phones(likely, table) < _LEAST_SHARE_OF_PHONES:
        found = ", ".join(f"'{tier.name}'" for tier in filled)
        raise UserFacingError(f"{name} has no tier of phones; it has {found}.", "Name the tier 'phones'.")
    return likely


def _share_of_phones(tier: IntervalTier, table: PhoneTable) -> float:
    names = [label.name for label in by_table(tier.labels, table) if label.name]
    return sum(_is_phone(name, is_ipa(names)) for name in names) / len(names)


def _is_phone(name: str, ipa: bool) -> bool:
    try:
        return phone_named(name, ipa).exact
    except UserFacingError:
        return False


def _check_end(name: str, end_s: float, duration_s: float, may_end_early: bool) -> None:
    if end_s > duration_s + END_TOLERANCE_S:
        relation = "after"
    elif end_s < duration_s - END_TOLERANCE_S and not may_end_early:
        relation = "before"
    else:
        return
    raise UserFacingError(
        f"{name} ends at {end_s:.2f} s, {relation} the sound, which lasts {duration_s:.2f} s.",
        "Do the two belong together?",
    )
