"""Marker names of two studios laid beside each other: as written, as meant, or nearly so."""

from __future__ import annotations

import difflib
import re
from collections.abc import Sequence

import numpy as np

# Whole words of a marker's name that mean the same thing.
_WORDS = {
    "l": "left", "lt": "left", "r": "right", "rt": "right", "m": "mid", "c": "mid", "middle": "mid", "center": "mid",
    "centre": "mid", "brow": "eyebrow", "up": "upper", "top": "upper", "down": "lower", "low": "lower",
    "bottom": "lower", "out": "outer", "outside": "outer", "in": "inner", "inside": "inner", "lips": "lip",
    "mouth": "lip", "end": "corner", "jaw": "chin",
}  # fmt: skip
_SIDES = ("left", "right")
# Words that say where on a part of the face; two names that are alike speak of the same part.
_WHERE = (*_SIDES, "upper", "lower", "inner", "outer", "mid", "corner")
_PART = re.compile(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|[0-9]+")
LEAST_ALIKE = 0.8
_SAME_PART = 0.75


def meant_words(name: str) -> tuple[str, ...]:
    """Return the words of a marker's name as they are meant, sorted: ``Actor:LBrow_Out`` is eyebrow, left, outer."""
    bare = name.rsplit(":", 1)[-1]
    # a side written before a small letter, as in Lcheek and Leyebrow
    bare = re.sub(r"(^|_)([LR])(?=[a-z]{3})(?!eft|ight|ip|ower|id)", r"\1\2_", bare)
    parts = [part.lower() for part in _PART.findall(bare)]
    return tuple(sorted(_WORDS.get(part, part.lstrip("0") or "0") for part in parts))


def likeness(found: str, wanted: str) -> float:
    """Return how surely two names mean one marker: 1 as written, 0.95 as meant, below that by their letters; 0..1.

    Names that speak of different sides, or of different numbers, are not alike at all.
    """
    if found == wanted:
        return 1.0
    ours, theirs = meant_words(found), meant_words(wanted)
    if not ours or not theirs:
        return 0.0
    if ours == theirs:
        return 0.95
    for kind in (lambda w: w in _SIDES, str.isdigit):
        if [w for w in ours if kind(w)] != [w for w in theirs if kind(w)]:
            return 0.0
    parts = [[w for w in words if w not in _WHERE and not w.isdigit()] for words in (ours, theirs)]
    if all(parts) and max(_by_letters(a, b) for a in parts[0] for b in parts[1]) < _SAME_PART:
        return 0.0
    return 0.9 * _by_letters(" ".join(ours), " ".join(theirs))


def _by_letters(a: str, b: str) -> float:
    return difflib.SequenceMatcher(None, a, b, autojunk=False).ratio()


def name_likeness(found: Sequence[str], wanted: Sequence[str]) -> np.ndarray:
    """Return `likeness` of all pairs, float64, shape (n_found, n_wanted), 0 where it is too weak to count."""
    table = np.array([[likeness(f, w) for w in wanted] for f in found]).reshape(len(found), len(wanted))
    return np.where(table >= LEAST_ALIKE, table, 0.0)
