"""Which sentences are learnt from, tuned on, and tested on: one rule for every engine and every corpus."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from core.errors import UserFacingError
from core.motion.corpus import Corpus
from core.motion.recording import Recording

SEED = 2008
SPLITS = ("tune", "test")
_PARTS = 12  # one part to tune, one to test, the rest to learn from
_FEWEST = 3

LETTERS = frozenset("abcdefghijklmnopqrstuvwxyz")
DIGITS = frozenset(("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine"))
WHOLE_WORDS: Mapping[str, frozenset[str]] = {"letters": LETTERS, "digits": DIGITS}
KINDS = ("sentences", *WHOLE_WORDS)


def split_names(names: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Split ``names`` into ``train``, ``tune`` and ``test``: ten, one and one of twelve parts.

    The names are sorted and permuted by ``numpy.random.default_rng(2008)``; the first are to learn from, the last to
    test on. 480 names make 400, 40 and 40. Raises `UserFacingError` for fewer than three.
    """
    if len(names) < _FEWEST:
        raise UserFacingError(f"{len(names)} cannot be split into a part to learn from, one to tune and one to test.")
    in_order = sorted(names)
    permuted = [in_order[i] for i in np.random.default_rng(SEED).permutation(len(in_order))]
    n_part = max(1, round(len(names) / _PARTS))
    return {
        "train": tuple(permuted[: -2 * n_part]),
        "tune": tuple(permuted[-2 * n_part : -n_part]),
        "test": tuple(permuted[-n_part:]),
    }


def hold_out(corpus: Corpus, kind: str = "sentences") -> Corpus:
    """Return ``corpus`` with its tuning and test sentences held out.

    kind : ``sentences`` splits sentences; ``letters`` and ``digits`` split the spoken letters or digits by the same
        rule, and hold out every sentence that says one of them, so that no engine has heard the word: where sentences
        follow a fixed grammar, a split by sentences leaves hardly a word or a triphone unheard
    Raises `UserFacingError` when there is too little to split.
    """
    if kind == "sentences":
        parts = split_names([r.sentence for r in corpus.recordings])
        return replace(corpus, held_out={split: parts[split] for split in SPLITS})
    parts = held_out_words(corpus.recordings, kind)
    tune, test = ({r.sentence for r in corpus.recordings if not _words(r).isdisjoint(parts[split])} for split in SPLITS)
    if len(tune | test) == len(corpus.recordings):
        raise UserFacingError(f"All sentences of the corpus '{corpus.name}' say one of the {kind} held out.")
    return replace(corpus, held_out={"tune": tuple(sorted(tune - test)), "test": tuple(sorted(test))})


def held_out_words(recordings: Sequence[Recording], kind: str) -> dict[str, tuple[str, ...]]:
    """Split the words of ``kind`` (see `WHOLE_WORDS`) that ``recordings`` say; see `split_names`."""
    if kind not in WHOLE_WORDS:
        raise UserFacingError(f"There is no split by '{kind}'.", f"Choose one of {', '.join(KINDS)}.")
    said = set().union(*(_words(recording) for recording in recordings)) & WHOLE_WORDS[kind]
    if len(said) < _FEWEST:
        raise UserFacingError(f"The corpus says {len(said)} different {kind}, too few to hold some out.")
    return split_names(sorted(said))


def _words(recording: Recording) -> set[str]:
    return {word.word.lower() for word in recording.transcript.words}
