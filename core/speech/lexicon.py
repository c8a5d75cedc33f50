"""A user's own dictionary: how names and invented words are said."""

from __future__ import annotations

import re
from pathlib import Path

from core.errors import UserFacingError
from core.speech.phone_names import phones_named
from core.speech.phoneme import PAU
from core.speech.text_file import read_text

# word -> its pronunciations in our phones
Lexicon = dict[str, list[tuple[str, ...]]]

_VARIANT = re.compile(r"\(\d+\)$")
_COMMENTS = ("#", ";;;")


def read_lexicon(path: str | Path, strict: bool = False) -> Lexicon:
    """Read lines ``word phone phone ...`` in ARPAbet, IPA or our phones; ``#`` or ``;;;`` begins a comment line.

    A word may have several lines, one for each way to say it (CMUdict's ``word(2)`` is the same).
    Raises `UserFacingError` naming the line that has no phones or a phone that means nothing (in ``strict`` mode:
    none of ours).
    """
    lexicon = parse_lexicon(read_text(path, "lexicon"), str(path), strict)
    if not lexicon:
        raise UserFacingError(f"The lexicon '{path}' holds no word.", _SHAPE)
    return lexicon


def parse_lexicon(text: str, name: str, strict: bool = False) -> Lexicon:
    """Read the lines of a lexicon, maybe none; ``name`` is what messages call it. Raises as `read_lexicon` does."""
    lexicon: Lexicon = {}
    for number, line in enumerate(text.split("\n"), start=1):
        columns = line.split()
        if not columns or columns[0].startswith(_COMMENTS):
            continue
        place = f"'{name}', line {number}"
        word = _VARIANT.sub("", columns[0]).lower()
        phones, _ = phones_named(columns[1:], [place] * (len(columns) - 1), strict)
        if not phones or PAU in phones:
            raise UserFacingError(f"{place}: '{columns[0][:20]}' has no phones, or a silence among them.", _SHAPE)
        lexicon.setdefault(word, []).append(tuple(phones))
    return lexicon


_SHAPE = "Each line is a word and its phones, such as 'efase IY F EY S'."
