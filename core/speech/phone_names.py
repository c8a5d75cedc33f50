"""Phone names of other sets (ARPAbet, TIMIT, IPA, Festival) in ours.

What is known by name comes from ``resources/speech/phone_names.tsv``; any other IPA symbol takes the nearest of our
phones by its articulation, ``resources/speech/phone_features.tsv``.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from core.errors import UserFacingError
from core.speech.phoneme import PAU, PHONEMES

RESOURCES = Path(__file__).resolve().parents[2] / "resources" / "speech"

# Scales of the two charts. The face decides: lips (place, rounding) weigh more than what happens inside the throat.
_PLACE = {
    "labiovelar": -1.0, "bilabial": 0.0, "labiodental": 1.0, "dental": 2.0, "alveolar": 3.0, "postalveolar": 4.0,
    "retroflex": 4.5, "alveolopalatal": 4.5, "palatal": 5.0, "velar": 6.0, "uvular": 7.0, "pharyngeal": 8.0,
    "glottal": 9.0,
}  # fmt: skip
# manner: how open the mouth's narrowest point is, then nasal, then lateral
_MANNER = {
    "plosive": (0.0, 0, 0), "affricate": (1.1, 0, 0), "nasal": (0.0, 1, 0), "tap": (0.6, 0, 0), "trill": (1.2, 0, 0),
    "fricative": (1.2, 0, 0), "lateral": (2.0, 0, 1), "approximant": (2.0, 0, 0),
}  # fmt: skip
_VOICE = {"voiced": 0.5, "voiceless": 0.0}
_HEIGHT = {
    "close": 0.0, "near-close": 1.0, "close-mid": 2.0, "mid": 3.0, "open-mid": 4.0, "near-open": 5.0, "open": 6.0,
}  # fmt: skip
_BACKNESS = {"front": (0.0, 0), "near-front": (0.5, 0), "central": (1.0, 0), "rhotic": (1.0, 2), "near-back": (1.5, 0),
             "back": (2.0, 0)}  # fmt: skip
_ROUNDING = {"rounded": 3.0, "unrounded": 0.0}

_BRACKETED = re.compile(r"<.*>|\[.*\]|\+.*\+|\(.*\)")
_TRIPHONE = re.compile(r"(?:[^-+]+-)?([^-+]+)(?:\+[^-+]+)?")
_ASCII_MARKS = re.compile(r"(?:_[bies])?$")
_SYLLABIC = "\u0329"
# stress, length, tie bars and tones; modifier letters (aspiration and the like) and combining marks go by category
_IPA_MARKS = "ˈˌːˑ'’ʼ:.|‿˞˥˦˧˨˩\u2197\u2198\u02de"
# these keyboard names mean another sound where a file is written in IPA
_NOT_IPA = frozenset({"y", "q", "ea", "ia", "ua", "oh"})
_AMERICANIST = frozenset("šžčǰ")
_LONGEST_SEQUENCE = 3


@dataclass(frozen=True)
class PhoneMatch:
    """One of our phones, and whether the name meant exactly that."""

    phone: str
    exact: bool


@dataclass(frozen=True)
class _Symbol:
    is_vowel: bool
    features: tuple[float, ...]
    place: float
    phone: str | None


def is_ipa(names: Iterable[str]) -> bool:
    """Whether phone names are written in IPA: one of them is no ASCII, and none is an Americanist letter."""
    foreign = {unicodedata.normalize("NFC", name.strip()) for name in names if not name.strip().isascii()}
    return bool(foreign) and not any(_AMERICANIST & set(name) for name in foreign)


def phone_named(name: str, ipa: bool = False) -> PhoneMatch:
    """Return the phone of our set that ``name`` means, or the nearest one by articulation.

    ``ipa`` says that the name is surely IPA: then y is a front rounded vowel, else our glide. A label of several
    sounds takes its first vowel; without a vowel its lip sound, or its last consonant (the release is what is seen).
    Raises `UserFacingError` for a name that is neither known nor IPA.
    """
    key = unicodedata.normalize("NFC", name.strip())
    if not key or _BRACKETED.fullmatch(key):
        return PhoneMatch(PAU, True)
    if key.isascii():
        key = key.lower()
        if key not in _names() and (triphone := _TRIPHONE.fullmatch(key)):
            key = triphone[1]
        key = _ASCII_MARKS.sub("", key)
    spellings = (key, key.rstrip("012"), _bare(key, keep="ː"), _bare(key))
    for spelling in dict.fromkeys(spellings):
        if ipa and spelling in _NOT_IPA:
            continue
        if spelling in PHONEMES:
            return PhoneMatch(spelling, True)
        if spelling in _names():
            return _names()[spelling]
    bases = _bare(key).replace(_SYLLABIC, "")
    if not bases or len(bases) > _LONGEST_SEQUENCE or any(base not in _symbols() for base in bases):
        raise UserFacingError(f"'{name[:20]}' is not a phone name of ARPAbet, IPA or Festival.")
    symbols = [_symbols()[base] for base in bases]
    seen = next((s for s in symbols if s.is_vowel), None) or next(
        (s for s in symbols if s.place <= _PLACE["labiodental"]), symbols[-1]
    )
    return PhoneMatch(_nearest(seen), len(symbols) == 1 and seen.phone is not None)


def phones_named(names: Sequence[str], places: Sequence[str], strict: bool = False) -> tuple[list[str], list[str]]:
    """Map all phone names of one file.

    places : where each name stands, for messages ("'a.lab', line 3")
    returns : our phones, and one warning for each distinct name that has no exact counterpart
    Raises `UserFacingError` for a name that means nothing, and in ``strict`` mode for one that is not exact.
    """
    ipa = is_ipa(names)
    phones: list[str] = []
    warnings: dict[str, str] = {}
    for name, place in zip(names, places):
        try:
            match = phone_named(name, ipa)
        except UserFacingError as error:
            raise UserFacingError(f"{place}: {error.message}") from error
        if not match.exact and strict:
            raise UserFacingError(
                f"{place}: the phone '{name}' is not in our set; the nearest is '{match.phone}'.",
                "Leave out strict mode to accept the nearest.",
            )
        if not match.exact:
            sentence = f"{place}: the phone '{name}' is not in our set; the nearest, '{match.phone}', is used."
            warnings.setdefault(name, sentence)
        phones.append(match.phone)
    return phones, list(warnings.values())


def _bare(name: str, keep: str = "") -> str:
    """Return IPA without stress, length, ties and diacritics, but with the mark of a syllabic consonant."""
    kept = []
    # the cedilla of ç is no diacritic: it makes another letter
    for character in unicodedata.normalize("NFD", name).replace("c\u0327", "ç").replace("\u030d", _SYLLABIC):
        is_mark = character in _IPA_MARKS or unicodedata.category(character) in ("Mn", "Lm")
        if not is_mark or character in (_SYLLABIC, *keep):
            kept.append(character)
    return "".join(kept)


def _nearest(symbol: _Symbol) -> str:
    if symbol.phone is not None:
        return symbol.phone
    ours = [s for s in _symbols().values() if s.phone is not None and s.is_vowel == symbol.is_vowel]
    return min(ours, key=lambda s: sum(abs(a - b) for a, b in zip(s.features, symbol.features))).phone


def table_rows(name: str) -> list[list[str]]:
    """Return the rows of a table in ``resources/speech``, without its comments and its heading."""
    lines = (RESOURCES / name).read_text(encoding="utf-8").splitlines()
    return [line.split("\t") for line in lines if line and not line.startswith("# ")][1:]


@cache
def _names() -> dict[str, PhoneMatch]:
    rows = table_rows("phone_names.tsv")
    return {unicodedata.normalize("NFC", name): PhoneMatch(phone, exact == "yes") for name, phone, exact, _ in rows}


@cache
def _symbols() -> dict[str, _Symbol]:
    symbols = {}
    for symbol, first, second, third, phone in table_rows("phone_features.tsv"):
        phone_or_none = None if phone == "-" else phone
        if first in _HEIGHT:
            features = (_HEIGHT[first], *_BACKNESS[second], _ROUNDING[third])
            symbols[symbol] = _Symbol(True, features, float("inf"), phone_or_none)
        else:
            features = (*_MANNER[first], _PLACE[second], _VOICE[third])
            symbols[symbol] = _Symbol(False, features, _PLACE[second], phone_or_none)
    return symbols
