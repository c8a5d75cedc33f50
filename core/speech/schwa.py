"""Strut or schwa: which AH of a dictionary without stress is ``ah``, and which ``ax``."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cache

from core.speech.phone_names import phone_named, table_rows

_VOWEL_LETTERS = re.compile(r"[aeiou]+|(?<=[^aeiou])y")
_CLASSES = {"V": "[aeiouy]", "C": "[b-df-hj-np-tv-xz]"}


def phones_of_word(word: str, arpabet: Sequence[str]) -> tuple[str, ...]:
    """Return our phones for a word of CMUdict; its AH become ``ah`` or ``ax`` by ``resources/speech/schwa_rules.tsv``.

    word : as spelled, small letters
    arpabet : its phones, without stress
    """
    n_syllables = sum(phone[0] in "AEIOU" for phone in arpabet)
    phones = []
    vowel = -1
    for phone in arpabet:
        vowel += phone[0] in "AEIOU"
        phones.append(_ah_or_ax(word, vowel, n_syllables) if phone == "AH" else phone_named(phone).phone)
    return tuple(phones)


def _ah_or_ax(word: str, vowel: int, n_syllables: int) -> str:
    letters = [match.start() for match in _VOWEL_LETTERS.finditer(word)]
    for where, pattern, phone in _rules():
        if (
            (where == "word" and pattern.fullmatch(word))
            or (where == "first" and n_syllables > 1 and vowel == 0 and pattern.match(word))
            or (
                where == "inner"
                and n_syllables > 1
                and 0 < vowel < len(letters)
                and pattern.match(word, letters[vowel])
            )
        ):
            return phone
    return "ah" if n_syllables == 1 else "ax"


@cache
def _rules() -> list[tuple[str, re.Pattern[str], str]]:
    rows = table_rows("schwa_rules.tsv")
    return [
        (where, re.compile("".join(_CLASSES.get(c, c) for c in pattern)), phone) for where, pattern, phone, _ in rows
    ]
