"""Numbers as they are read aloud in English."""

from __future__ import annotations

import re

_ONES = (
    "zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve",
    "thirteen", "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen",
)  # fmt: skip
_TENS = ("", "", "twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_SCALES = ((10**12, "trillion"), (10**9, "billion"), (10**6, "million"), (1000, "thousand"), (100, "hundred"))
_LARGEST = 10**15
_MOST_DIGITS = 100
_IRREGULAR_ORDINALS = {
    "one": "first", "two": "second", "three": "third", "five": "fifth", "eight": "eighth", "nine": "ninth",
    "twelve": "twelfth",
}  # fmt: skip
_CURRENCIES = {"$": ("dollar", "cent"), "£": ("pound", "penny"), "€": ("euro", "cent")}
_PLURALS = {"penny": "pence"}

_NUMBER = re.compile(
    r"(?P<currency>[$£€])?(?P<whole>\d{1,3}(?:,\d{3})+|\d+)?(?:\.(?P<fraction>\d+))?(?P<ending>st|nd|rd|th|s|%)?"
)
_CLOCK = re.compile(r"(\d{1,2}):([0-5]\d)")


def number_words(token: str) -> list[str] | None:
    """Return the words of ``token`` ("21st", "$3.50", "1984", "10:30", "5%"), or None when it is no number.

    Four digits from 1100 to 2099 are read as a year, except round thousands and 2001 to 2009; more than 15 digits
    are read one by one.
    """
    if clock := _CLOCK.fullmatch(token):
        hours, minutes = int(clock[1]), int(clock[2])
        if minutes == 0:
            return [*_cardinal(hours), "o'clock"]
        return [*_cardinal(hours), *(["oh"] if minutes < 10 else []), *_cardinal(minutes)]
    number = _NUMBER.fullmatch(token)
    if not number or not (number["whole"] or number["fraction"]):
        return None
    digits = (number["whole"] or "0").replace(",", "")
    if len(digits) > _MOST_DIGITS:
        return _one_by_one(digits)
    if number["currency"]:
        return _money(int(digits), number["fraction"], *_CURRENCIES[number["currency"]])
    if number["fraction"]:
        words = [*(_cardinal(int(digits)) if number["whole"] else []), "point", *_one_by_one(number["fraction"])]
    elif number["whole"] == digits and _is_year(digits):
        words = _year(int(digits))
    elif int(digits) >= _LARGEST or (digits.startswith("0") and len(digits) > 1):
        words = _one_by_one(digits)
    else:
        words = _cardinal(int(digits))
    return _with_ending(words, number["ending"])


def _with_ending(words: list[str], ending: str | None) -> list[str]:
    if ending == "%":
        return [*words, "percent"]
    if ending == "s":
        last = words[-1]
        return [*words[:-1], last[:-1] + "ies" if last.endswith("y") else last + ("es" if last.endswith("x") else "s")]
    if ending:
        return [*words[:-1], _ordinal(words[-1])]
    return words


def _cardinal(number: int) -> list[str]:
    if number < 20:
        return [_ONES[number]]
    if number < 100:
        return [_TENS[number // 10], *([_ONES[number % 10]] if number % 10 else [])]
    for scale, name in _SCALES:
        if number >= scale:
            rest = number % scale
            joint = ["and"] if 0 < rest < 100 and scale <= 1000 else []
            return [*_cardinal(number // scale), name, *joint, *(_cardinal(rest) if rest else [])]
    raise AssertionError(number)


def _ordinal(word: str) -> str:
    if word in _IRREGULAR_ORDINALS:
        return _IRREGULAR_ORDINALS[word]
    return word[:-1] + "ieth" if word.endswith("y") else word + "th"


def _is_year(digits: str) -> bool:
    return len(digits) == 4 and 1100 <= int(digits) <= 2099 and not 2000 <= int(digits) <= 2009


def _year(number: int) -> list[str]:
    century, rest = divmod(number, 100)
    if rest == 0:
        return [*_cardinal(century), "hundred"]
    return [*_cardinal(century), *(["oh"] if rest < 10 else []), *_cardinal(rest)]


def _one_by_one(digits: str) -> list[str]:
    return [_ONES[int(digit)] for digit in digits]


def _money(whole: int, fraction: str | None, unit: str, part: str) -> list[str]:
    words = [*_cardinal(min(whole, _LARGEST - 1)), unit if whole == 1 else unit + "s"]
    parts = int((fraction or "0").ljust(2, "0")[:2])
    if parts:
        words += ["and", *_cardinal(parts), part if parts == 1 else _PLURALS.get(part, part + "s")]
    return words
