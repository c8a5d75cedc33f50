"""How each word of a text may be said, in our phones."""

from __future__ import annotations

import itertools
import re
import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from core.errors import UserFacingError
from core.speech.letter_to_sound import guess_phones
from core.speech.phone_names import table_rows
from core.speech.schwa import phones_of_word

Phones = tuple[str, ...]

_FOLDED = str.maketrans({"ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "ł": "l", "đ": "d", "ð": "th", "þ": "th", "ı": "i"})
_DRAWN_OUT = re.compile(r"(.)\1{2,}")
_MOST_VARIANTS = 4
_LONGEST_SPELLED = 5
_SHORTEST_PART = 3

# Endings that known words take. "S" and "D" depend on the sound before, as in cats, dogs, horses; walked, played.
_ENDINGS: tuple[tuple[str, str], ...] = (
    ("'s", "S"), ("'d", "D"), ("'ll", "ax l"), ("'ve", "v"), ("'re", "er"), ("n't", "ax n t"),
    ("nesses", "n ax s ih z"), ("ness", "n ax s"), ("lessly", "l ax s l iy"), ("less", "l ax s"),
    ("fully", "f ax l iy"), ("ful", "f ax l"), ("ings", "ih ng z"), ("ing", "ih ng"), ("ers", "er z"), ("er", "er"),
    ("est", "ih s t"), ("ably", "ax b l iy"), ("able", "ax b ax l"), ("ish", "ih sh"), ("ly", "l iy"),
    ("ed", "D"), ("es", "S"), ("s", "S"), ("y", "iy"),
)  # fmt: skip
_BEGINNINGS: tuple[tuple[str, str], ...] = (
    ("un", "ax n"), ("re", "r iy"), ("non", "n aa n"), ("pre", "p r iy"), ("mis", "m ih s"), ("dis", "d ih s"),
    ("anti", "ae n t iy"), ("semi", "s eh m iy"), ("sub", "s ah b"), ("de", "d iy"),
)  # fmt: skip
_SIBILANTS = {"s", "z", "sh", "zh", "ch", "jh"}
_VOICELESS = {"p", "t", "k", "f", "th", "s", "sh", "ch", "hh"}


@dataclass(frozen=True)
class Pronunciation:
    """A word as written, the ways it may be said (at least one), and a warning if they were guessed."""

    word: str
    variants: tuple[Phones, ...]
    warning: str = ""


class Pronouncer:
    """Finds pronunciations: the user's lexicon, the dictionary, the parts of a word, its letters, its spelling.

    dictionary : gives the pronunciations of a word in small letters, in ARPAbet without stress; none if unknown
    lexicon : the user's own words; they come first and replace the dictionary's
    """

    def __init__(
        self, dictionary: Callable[[str], Sequence[Phones]], lexicon: Mapping[str, Sequence[Phones]] | None = None
    ) -> None:
        self._dictionary = dictionary
        self._lexicon = {_folded(word): tuple(phones) for word, phones in (lexicon or {}).items()}

    def pronounce(self, word: str) -> Pronunciation:
        """Return how ``word`` is said; raises `UserFacingError` when it has letters that English does not read."""
        folded = _folded(word)
        if variants := self._known(folded):
            return Pronunciation(word, variants)
        if not folded.replace("'", "").replace("-", "").isascii():
            raise UserFacingError(
                f"The word '{word[:40]}' cannot be read as English.", "Give its phones in a lexicon file."
            )
        if variants := self._drawn_out(folded) or self._inflected(folded) or self._hyphenated(folded):
            return Pronunciation(word, variants)
        letters = "".join(c for c in folded if c.isalpha())
        if _is_spelled(word, letters) and (variants := self._spelled(letters)):
            how = "its letters one by one"
        elif variants := self._compound(letters):
            how = "the words in it"
        else:
            variants = (guess_phones(letters) or self._spelled(letters)[0],)
            how = "its spelling"
        said = f"The word '{word}' is in no dictionary; it is said as '{' '.join(variants[0])}', guessed from {how}."
        return Pronunciation(word, variants, said)

    def _known(self, word: str) -> tuple[Phones, ...]:
        for spelling in dict.fromkeys((word, word.strip("'"))):
            if spelling in self._lexicon:
                return self._lexicon[spelling]
            found = [phones_of_word(spelling, arpabet) for arpabet in self._dictionary(spelling)]
            if found := [*found, *_extra_words().get(spelling, ())]:
                return tuple(dict.fromkeys(found))
        return ()

    def _drawn_out(self, word: str) -> tuple[Phones, ...]:
        """Find "nooo" and "sssh", as scripts write them."""
        calm = (_DRAWN_OUT.sub(r"\1" * n, word) for n in (2, 1))
        return next((v for spelling in calm if spelling != word and (v := self._known(spelling))), ())

    def _inflected(self, word: str) -> tuple[Phones, ...]:
        for ending, sounds in _ENDINGS:
            stem = word.removesuffix(ending)
            if stem == word or len(stem) < 2:
                continue
            for base in _bases(stem, ending):
                if variants := self._known(base):
                    return tuple(v + _ending_sounds(sounds, v[-1]) for v in variants)
        for beginning, sounds in _BEGINNINGS:
            rest = word.removeprefix(beginning)
            if rest == word or len(rest) <= _SHORTEST_PART:
                continue
            if variants := self._known(rest) or self._inflected(rest):
                return tuple((*sounds.split(), *v) for v in variants)
        return ()

    def _hyphenated(self, word: str) -> tuple[Phones, ...]:
        parts = [part for part in word.split("-") if part]
        return self._joined([self.pronounce(part).variants for part in parts]) if len(parts) > 1 else ()

    def _compound(self, word: str) -> tuple[Phones, ...]:
        cuts = range(_SHORTEST_PART, len(word) - _SHORTEST_PART + 1)
        # two parts of like length are the likeliest to be two words
        for cut in sorted(cuts, key=lambda cut: abs(2 * cut - len(word))):
            first, second = self._known(word[:cut]), self._known(word[cut:]) or self._inflected(word[cut:])
            if first and second:
                return self._joined([first, second])
        return ()

    def _spelled(self, letters: str) -> tuple[Phones, ...]:
        # the dictionary's "a." is the name of the letter, its "a" the article
        return self._joined([self._known(f"{letter}.") or self._known(letter) for letter in letters])

    def _joined(self, parts: Sequence[tuple[Phones, ...]]) -> tuple[Phones, ...]:
        ways = itertools.islice(itertools.product(*parts), _MOST_VARIANTS)
        return tuple(tuple(itertools.chain.from_iterable(way)) for way in ways)


def _folded(word: str) -> str:
    letters = unicodedata.normalize("NFD", word.lower().translate(_FOLDED))
    return "".join(c for c in letters if unicodedata.category(c) != "Mn")


def _is_spelled(word: str, letters: str) -> bool:
    return len(letters) <= _LONGEST_SPELLED and (
        (word.isupper() and len(letters) > 1) or not any(c in "aeiouy" for c in letters)
    )


def _bases(stem: str, ending: str) -> list[str]:
    bases = [stem]
    if ending[0] in "eiay" and ending != "es":
        bases.append(stem + "e")
        if len(stem) > 2 and stem[-1] == stem[-2]:
            bases.append(stem[:-1])
    if stem.endswith("i"):
        bases.append(stem[:-1] + "y")
    return bases


def _ending_sounds(sounds: str, last: str) -> Phones:
    if sounds == "S":
        return ("ih", "z") if last in _SIBILANTS else ("s",) if last in _VOICELESS else ("z",)
    if sounds == "D":
        return ("ih", "d") if last in ("t", "d") else ("t",) if last in _VOICELESS else ("d",)
    return tuple(sounds.split())


@cache
def _extra_words() -> dict[str, list[Phones]]:
    words: dict[str, list[Phones]] = {}
    for word, phones, _ in table_rows("extra_words.tsv"):
        words.setdefault(word, []).append(tuple(phones.split()))
    return words
