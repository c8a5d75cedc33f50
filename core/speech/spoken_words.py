"""From text as it is written to the words that are spoken."""

from __future__ import annotations

import re
import unicodedata

from core.speech.abbreviations import read_in_full
from core.speech.number_words import number_words
from core.speech.script_marks import without_script_marks

_QUOTES = str.maketrans({"’": "'", "‘": "'", "ʼ": "'", "`": "'", "´": "'", "′": "'", "“": '"', "”": '"'})
_DOUBLE_QUOTES = re.compile(r"''+")
_HYPHENS = re.compile(r"[\u2010\u2011\u00ad\u2212]")
_DASHES = re.compile(r"[\u2012-\u2015_/\\|~]|--+|\.\.+|…")
_SYMBOLS = {"&": "and", "@": "at", "+": "plus", "=": "equals", "°": "degrees", "%": "percent", "#": "number"}
_EDGES = re.compile(r"^(?!-\d)[^\w$£€.&@+=°%#']+|[^\w%°&@+=']+$")
_NUMBER_LIKE = re.compile(r"[$£€]?\.?\d")
_LETTERS_OR_DIGITS = re.compile(r"\d++(?:st|nd|rd|th|s)?+(?![^\W\d])|\d+|[^\W\d]+(?:'[^\W\d]+)*'?")


def spoken_words(text: str) -> list[str]:
    """Return the words of ``text`` in the order they are said, as they are spelled.

    Numbers, sums of money, years and times of day become words; curly quotes become straight, dashes part words,
    hyphens stay ("twenty-one" is one word here); what a script does not mean to be said is left out (see
    `core.speech.script_marks.without_script_marks`).
    """
    text = read_in_full(without_script_marks(text)[0])
    text = unicodedata.normalize("NFKC", text.replace("…", " ")).translate(_QUOTES)
    text = _DOUBLE_QUOTES.sub('"', text)
    text = _DASHES.sub(" ", _HYPHENS.sub("-", text))
    words: list[str] = []
    for token in text.split():
        words += _words_of(_EDGES.sub("", token))
    return words


def _words_of(token: str) -> list[str]:
    if token in _SYMBOLS:
        return [_SYMBOLS[token]]
    if _NUMBER_LIKE.match(token.lstrip("'-(")):
        read = number_words(token.lstrip("'-(").rstrip(".,:)'").lower())
        if read is not None:
            return ["minus", *read] if token.startswith("-") else read
    words: list[str] = []
    for part in re.split(r"([&@+=°%#])|[^\w'\-.,:$£€]+", token):
        if part in _SYMBOLS:
            words.append(_SYMBOLS[part])
        elif part and any(character.isdigit() for character in part):
            for piece in _LETTERS_OR_DIGITS.findall(part):
                words += number_words(piece.lower()) or [piece]
        elif part:
            words += _without_punctuation(part)
    return words


def _without_punctuation(part: str) -> list[str]:
    found = []
    for word in re.split(r"[.,:$£€]+", part):
        word = word.strip("-")
        # a quote at both sides is a quotation, at one side it may belong to the word ('tis, dogs')
        if word.startswith("'") and word.endswith("'"):
            word = word.strip("'")
        if any(character.isalpha() for character in word):
            found.append(word)
    return found
