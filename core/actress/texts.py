"""Which texts the synthetic actress speaks: a greedy choice that covers many diphones with few sentences.

``python -m core.actress.texts`` chooses from ``resources/demo/candidates.txt``, writes ``sentences.csv`` and prints
what the choice covers; ``python -m core.actress.speech`` then speaks it.
"""

from __future__ import annotations

import csv
import itertools
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from core.actress.randomness import Chance
from core.errors import UserFacingError
from core.speech.emotion import EMOTIONS

DEMO_FOLDER = Path(__file__).resolve().parents[2] / "resources" / "demo"
# What every emotion says, and what each says alone: contexts to compare, and contexts to add.
SHARED_COUNT, OWN_COUNT = 34, 11
TUNING_COUNT, COMPARISON_COUNT = 6, 3
# Sentences of the length that a reader takes in one breath; the choice by gain alone would take the longest.
PHONES = (22, 36)
# A diphone that no emotion has yet is worth so much of one that only this emotion lacks.
NEW_TO_ALL = 2.0

# Texts of the paper's figures and tables.
DATABASE_REQUIRED = ("I know you meant it.", "And so you just abandoned them?")
TUNING_REQUIRED = "It is a fact that long words are difficult to articulate unless you concentrate."
COMPARISON_REQUIRED = "Please go on, because Jeff's father has no idea of how the things became so horrible."

# Chosen by hand, so that each suits its emotion; the films of the demo.
DEMO_TEXTS = {
    "neutral": "The evening train will leave from platform number five.",
    "happiness": "We won the game and everybody is coming to our house!",
    "anger": "How could you go and break my favorite window?",
    "sadness": "Nobody ever came back to visit the poor old man.",
}

Diphone = tuple[str, str]


class Line(NamedTuple):
    """One sentence to be spoken (a row of ``sentences.csv``); role is database, tuning, comparison or demo."""

    sentence: str
    emotion: str
    role: str
    text: str


def words_of(text: str) -> list[str]:
    """Return the words of a text, small letters, apostrophes kept."""
    return re.findall(r"[a-z']+", text.lower())


def diphones(phones: Sequence[str]) -> Counter[Diphone]:
    """Count the pairs of neighbouring phones of one sentence or word."""
    return Counter(itertools.pairwise(phones))


@cache
def cmu_dictionary() -> Mapping[str, tuple[str, ...]]:
    """Read the CMU dictionary that pocketsphinx brings: word, or word(2), to ARPAbet phones without stress."""
    import pocketsphinx

    dictionary = {}
    with open(Path(pocketsphinx.get_model_path()) / "en-us" / "cmudict-en-us.dict", encoding="utf-8") as lines:
        for line in lines:
            word, *phones = line.split()
            dictionary[word] = tuple(phones)
    return dictionary


def dictionary_diphones() -> Counter[Diphone]:
    """Count the diphones inside the words of the CMU dictionary, every pronunciation once."""
    return Counter(itertools.chain.from_iterable(itertools.pairwise(phones) for phones in cmu_dictionary().values()))


def cmu_phones(texts: Iterable[str]) -> dict[str, tuple[str, ...]]:
    """Pronounce ``texts`` by the CMU dictionary (first pronunciation).

    Raises `UserFacingError` for a word that is not in it.
    """
    dictionary = cmu_dictionary()
    pronounced = {}
    for text in texts:
        words = words_of(text)
        unknown = [word for word in words if word not in dictionary]
        if unknown:
            raise UserFacingError(f"'{unknown[0]}' in '{text}' is not in the CMU dictionary.")
        pronounced[text] = tuple(phone for word in words for phone in dictionary[word])
    return pronounced


def choose_texts(
    phones_of: Mapping[str, Sequence[str]], count: int, worth: Mapping[Diphone, float], chosen: Iterable[str] = ()
) -> list[str]:
    """Choose texts that together hold diphones worth as much as a greedy choice finds.

    phones_of : text to its phones; its order settles ties
    worth : value of each diphone, counted once however often it is said
    chosen : texts that are taken already
    returns : ``chosen`` and then the others in the order of their choice, ``count`` in all or as many as there are
    """
    pairs = {text: frozenset(diphones(phones)) for text, phones in phones_of.items()}
    taken = list(chosen)
    missing = dict(worth)
    for text in taken:
        for pair in pairs[text]:
            missing.pop(pair, None)
    left = [text for text in pairs if text not in taken]
    while left and len(taken) < count:
        best = max(left, key=lambda text: sum(missing.get(pair, 0.0) for pair in pairs[text]))
        left.remove(best)
        taken.append(best)
        for pair in pairs[best]:
            missing.pop(pair, None)
    return taken


def choose_database(phones_of: Mapping[str, Sequence[str]], worth: Mapping[Diphone, float]) -> dict[str, list[str]]:
    """Return the texts of each emotion: the shared ones first, then those that it says alone."""
    handy = {
        text: phones
        for text, phones in phones_of.items()
        if text in DATABASE_REQUIRED or PHONES[0] <= len(phones) <= PHONES[1]
    }
    shared = choose_texts(handy, SHARED_COUNT, worth, DATABASE_REQUIRED)
    texts = {emotion: list(shared) for emotion in EMOTIONS}
    said = set(shared)
    covered = set().union(*(diphones(phones_of[text]) for text in said))
    for count in range(SHARED_COUNT + 1, SHARED_COUNT + OWN_COUNT + 1):
        for emotion in EMOTIONS:
            raised = {pair: value * (1 if pair in covered else NEW_TO_ALL) for pair, value in worth.items()}
            free = {text: phones for text, phones in handy.items() if text not in said or text in texts[emotion]}
            texts[emotion] = choose_texts(free, count, raised, texts[emotion])
            said.add(texts[emotion][-1])
            covered |= diphones(phones_of[texts[emotion][-1]]).keys()
    return texts


def choose_lines() -> list[Line]:
    """Choose the whole corpus: database, tuning, comparison and demo; the first text of an emotion is ``n01``..."""
    phones_of = cmu_phones([*candidate_texts(), *DEMO_TEXTS.values()])
    for text in DEMO_TEXTS.values():
        del phones_of[text]
    database = choose_database(phones_of, dictionary_diphones())
    said = {text for texts in database.values() for text in texts}
    rest = [text for text in phones_of if text not in said and PHONES[0] <= len(phones_of[text]) <= PHONES[1]]
    # Everyday English as the candidates hold it, not another choice by diphones: it is to test the database.
    order = Chance("held-out texts").normal(len(rest)).argsort()
    held_out = iter([rest[i] for i in order])
    lines = [
        Line(f"{emotion[0]}{i + 1:02d}", emotion, "database", text)
        for emotion in EMOTIONS
        for i, text in enumerate(database[emotion])
    ]
    for role, letter, count, required in (
        ("tuning", "t", TUNING_COUNT, TUNING_REQUIRED),
        ("comparison", "c", COMPARISON_COUNT, COMPARISON_REQUIRED),
    ):
        for emotion in EMOTIONS:
            for i in range(count):
                text = required if emotion == EMOTIONS[0] and i == 0 else next(held_out)
                lines.append(Line(f"{emotion[0]}{letter}{i + 1}", emotion, role, text))
    lines += [Line(f"demo-{emotion}", emotion, "demo", text) for emotion, text in DEMO_TEXTS.items()]
    return lines


def coverage(texts: Iterable[str]) -> tuple[float, float]:
    """Return which share of the dictionary's diphones ``texts`` hold: of kinds, and weighted by frequency."""
    worth = dictionary_diphones()
    held = set().union(*(diphones(phones) for phones in cmu_phones(texts).values())) & worth.keys()
    return len(held) / len(worth), sum(worth[pair] for pair in held) / worth.total()


def candidate_texts() -> list[str]:
    """Return the texts to choose from."""
    lines = (DEMO_FOLDER / "candidates.txt").read_text(encoding="utf-8").splitlines()
    return [line.strip() for line in lines if line.strip()]


def bundled_lines() -> list[Line]:
    """Return the sentences of ``sentences.csv``, the choice as it was spoken."""
    with open(DEMO_FOLDER / "sentences.csv", encoding="utf-8", newline="") as lines:
        return [Line(**row) for row in csv.DictReader(lines)]


def _main() -> None:
    lines = choose_lines()
    with open(DEMO_FOLDER / "sentences.csv", "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(Line._fields)
        writer.writerows(lines)
    for emotion in (*EMOTIONS, "all"):
        texts = {line.text for line in lines if line.role == "database" and emotion in (line.emotion, "all")}
        kinds, tokens = coverage(texts)
        print(f"{emotion}: {len(texts)} texts, {kinds:.1%} of the diphones, {tokens:.1%} weighted by frequency")


if __name__ == "__main__":
    _main()
