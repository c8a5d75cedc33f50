"""The phoneme set and its visemes.

Phones are Festival's US English names, the set of Deng and Neumann (2008), table A1.
"""

from __future__ import annotations

PAU = "pau"

# Table A1: 15 viseme classes; the name of a class is its first phone.
VISEME_CLASSES: tuple[tuple[str, ...], ...] = (
    ("pau",),
    ("r",),
    ("ae", "ax", "ah", "aa"),
    ("k", "g", "ng"),
    ("ao", "y", "iy", "ih", "ay", "aw"),
    ("f", "v"),
    ("ey", "eh", "el", "em", "en", "er"),
    ("ow", "oy"),
    ("b", "p", "m"),
    ("th", "dh"),
    ("hh",),
    ("n", "d", "t", "l"),
    ("ch", "sh", "jh"),
    ("s", "z", "zh"),
    ("w", "uw", "uh"),
)

PHONEMES: tuple[str, ...] = tuple(phone for group in VISEME_CLASSES for phone in group)
PHONEME_INDEX: dict[str, int] = {phone: i for i, phone in enumerate(PHONEMES)}
VISEME_OF_PHONEME: tuple[int, ...] = tuple(viseme for viseme, group in enumerate(VISEME_CLASSES) for _ in group)


def viseme_of(phone: str) -> int:
    """Return the viseme class (0..14, row of table A1) of ``phone``; `KeyError` if it is not in the set."""
    return VISEME_OF_PHONEME[PHONEME_INDEX[phone]]
