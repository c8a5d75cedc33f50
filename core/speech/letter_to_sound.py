"""Guessing how a word sounds from how it is spelled, for words that no dictionary knows."""

from __future__ import annotations

import re
from collections import defaultdict
from functools import cache

from core.speech.phone_names import table_rows

_CLASSES = {"V": "[aeiouy]", "C": "[b-df-hj-np-tv-xz]"}


def guess_phones(word: str) -> tuple[str, ...]:
    """Return our phones for ``word``, spelled with the letters a to z; the rules are a table in ``resources``.

    A word that the rules leave without any sound ("hh") gives an empty tuple.
    """
    phones: list[str] = []
    at = 0
    while at < len(word):
        for left, letters, right, sounds in _rules()[word[at]]:
            end = at + len(letters)
            if word.startswith(letters, at) and left.search(word[:at]) and right.match(word[end:]):
                # a doubled sound across two rows is one sound
                phones += sounds[1:] if phones and sounds and phones[-1] == sounds[0] else sounds
                at = end
                break
        else:
            at += 1
    return tuple(phones)


@cache
def _rules() -> dict[str, list[tuple[re.Pattern[str], str, re.Pattern[str], tuple[str, ...]]]]:
    rules = defaultdict(list)
    for left, letters, right, phones in table_rows("letter_to_sound.tsv"):
        rule = (re.compile(_expanded(left) + r"\Z"), letters, re.compile(_expanded(right)), tuple(phones.split()))
        rules[letters[0]].append(rule)
    return rules


def _expanded(side: str) -> str:
    return "".join(_CLASSES.get(character, character) for character in side)
