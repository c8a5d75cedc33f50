"""Which texts the synthetic actress speaks: a greedy choice that covers many diphones with few sentences.

``python -m core.actress.texts`` prints the choice from ``resources/demo/candidates.txt``.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from core.errors import UserFacingError

DEMO_FOLDER = Path(__file__).resolve().parents[2] / "resources" / "demo"
TEXT_COUNT = 12
# Texts of the paper's figures.
REQUIRED = ("I know you meant it.", "And so you just abandoned them?")


def diphones(phones: Sequence[str]) -> frozenset[tuple[str, str]]:
    """Return the pairs of neighbouring phones of one sentence, silence at both ends included."""
    padded = ("SIL", *phones, "SIL")
    return frozenset(itertools.pairwise(padded))


def choose_texts(phones_of: Mapping[str, Sequence[str]], count: int, required: Iterable[str] = ()) -> list[str]:
    """Choose ``count`` texts that together hold as many different diphones as a greedy choice finds.

    phones_of : text to its phones; its order settles ties
    required : texts that are taken first, whatever they bring
    returns : the texts in the order of their choice; all of them if there are fewer than ``count``
    """
    pairs = {text: diphones(phones) for text, phones in phones_of.items()}
    chosen = list(required)
    covered = set().union(*(pairs[text] for text in chosen))
    while len(chosen) < min(count, len(pairs)):
        best = max((text for text in pairs if text not in chosen), key=lambda text: len(pairs[text] - covered))
        chosen.append(best)
        covered |= pairs[best]
    return chosen


def cmu_phones(texts: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Pronounce ``texts`` by the CMU dictionary that pocketsphinx brings (first pronunciation, ARPAbet).

    Raises `UserFacingError` for a word that is not in it.
    """
    import pocketsphinx

    dictionary: dict[str, tuple[str, ...]] = {}
    with open(Path(pocketsphinx.get_model_path()) / "en-us" / "cmudict-en-us.dict", encoding="utf-8") as lines:
        for line in lines:
            word, *phones = line.split()
            dictionary[word] = tuple(phones)
    pronounced = {}
    for text in texts:
        words = re.findall(r"[a-z']+", text.lower())
        unknown = [word for word in words if word not in dictionary]
        if unknown:
            raise UserFacingError(f"'{unknown[0]}' in '{text}' is not in the CMU dictionary.")
        pronounced[text] = tuple(phone for word in words for phone in dictionary[word])
    return pronounced


def candidate_texts() -> list[str]:
    """Return the texts to choose from."""
    lines = (DEMO_FOLDER / "candidates.txt").read_text(encoding="utf-8").splitlines()
    return [line.strip() for line in lines if line.strip()]


if __name__ == "__main__":
    print("\n".join(choose_texts(cmu_phones(candidate_texts()), TEXT_COUNT, REQUIRED)))
