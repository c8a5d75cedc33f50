"""Short forms that are read in full: titles, units, millions, fractions, telephone numbers, addresses of the web."""

from __future__ import annotations

import re
from functools import cache

from core.speech.phone_names import table_rows

_MANY = {"k": "thousand", "m": "million", "bn": "billion", "b": "billion"}
_MANY_MONEY = re.compile(r"([$£€])(\d[\d,.]*)(?:\s?(k|m|bn|b)|\s(thousand|million|billion|trillion))\b", re.IGNORECASE)
_UNITS_OF_MONEY = {"$": "dollars", "£": "pounds", "€": "euros"}
_FRACTIONS = {"1/2": "one half", "1/3": "one third", "2/3": "two thirds", "1/4": "one quarter", "3/4": "three quarters"}
_VULGAR = {"½": "1/2", "⅓": "1/3", "⅔": "2/3", "¼": "1/4", "¾": "3/4"}
_FRACTION = re.compile(r"(?<![\d/.])(?:(\d+)[ \t])?([123]/[234])(?![\d/])")
# seven digits and more in groups joined by hyphens
_TELEPHONE = re.compile(r"(?<![\w-])(?:\d{1,3}-){0,2}\d{3}-\d{4}(?![\w-])")
_WEB = re.compile(r"\b[\w-]+(?:\.[\w-]+)*\.(?:com|org|net|edu|gov|io|tv|uk|de|eu)\b", re.IGNORECASE)
_HASHTAG = re.compile(r"(?<!\w)#(?=[^\W\d])")
_BEHIND_NUMBER = re.compile(r"(?<=\d)[ \t]?([^\W\d_]+(?:/h)?)\b\.?(?!['\w])")
_BEFORE_STOP = re.compile(r"\b([^\W\d_]+)\.")


def read_in_full(text: str) -> str:
    """Return ``text`` with short forms written out; the words are in ``resources/speech/abbreviations.tsv``."""
    for sign, fraction in _VULGAR.items():
        text = re.sub(rf"(\d){sign}", rf"\1 {fraction}", text).replace(sign, fraction)
    text = _MANY_MONEY.sub(lambda m: f"{m[2]} {_MANY[m[3].lower()] if m[3] else m[4]} {_UNITS_OF_MONEY[m[1]]}", text)
    text = _FRACTION.sub(_fraction, text)
    text = _TELEPHONE.sub(lambda match: " ".join(match[0].replace("-", "")), text)
    text = _WEB.sub(lambda match: match[0].replace(".", " dot "), text)
    text = _HASHTAG.sub("hashtag ", text)
    text = _BEHIND_NUMBER.sub(_unit, text)
    return _BEFORE_STOP.sub(_short_form, text)


def _fraction(match: re.Match[str]) -> str:
    spoken = _FRACTIONS.get(match[2])
    if spoken is None:
        return match[0]
    return f"{match[1]} and {spoken.replace('one half', 'a half')}" if match[1] else spoken


def _unit(match: re.Match[str]) -> str:
    spoken, when = _table().get(match[1].lower(), ("", ""))
    return f" {spoken}" if when == "number" else match[0]


def _short_form(match: re.Match[str]) -> str:
    spoken, when = _table().get(match[1].lower(), ("", ""))
    return spoken if when == "dot" or (when == "title" and match[1][0].isupper()) else match[0]


@cache
def _table() -> dict[str, tuple[str, str]]:
    return {written: (spoken, when) for written, spoken, when, _ in table_rows("abbreviations.tsv")}
