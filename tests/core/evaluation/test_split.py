"""One rule says what is learnt from, tuned on and tested on."""

from __future__ import annotations

import numpy as np
import pytest

from core.errors import UserFacingError
from core.evaluation.split import SPLITS, held_out_words, hold_out, split_names
from core.motion.corpus import Corpus
from core.motion.recording import Recording
from core.speech.transcript import Transcript, WordUtterance

DIGIT_OF = {"zero": "z", "one": "1", "two": "2", "three": "3", "four": "4", "five": "5", "six": "6", "seven": "7",
            "eight": "8", "nine": "9"}  # fmt: skip


def said(name, words):
    utterances = tuple(WordUtterance(word, 0.1 * i, 0.1 * i + 0.1) for i, word in enumerate(words.split()))
    transcript = Transcript((), utterances, 1.0)
    return Recording(name, "neutral", np.zeros((2, 1, 3), np.float32), ("m",), 25.0, transcript)


def test_480_names_make_400_40_and_40_by_the_stated_permutation():
    names = [f"s{i:03d}" for i in range(480)]
    parts = split_names(names[::-1])
    assert {split: len(part) for split, part in parts.items()} == {"train": 400, "tune": 40, "test": 40}
    order = np.random.default_rng(2008).permutation(480)
    assert [*parts["train"], *parts["tune"], *parts["test"]] == [f"s{i:03d}" for i in order]


@pytest.mark.parametrize("n", [3, 4, 11, 13, 30, 100])
def test_every_name_is_in_one_part_and_no_part_is_empty(n):
    names = [f"n{i}" for i in range(n)]
    parts = split_names(names)
    assert sorted(name for part in parts.values() for name in part) == sorted(names)
    assert all(parts.values())
    assert len(parts["tune"]) == len(parts["test"]) <= max(1, n / 12 + 0.5)


def test_two_names_cannot_be_split():
    with pytest.raises(UserFacingError, match="cannot be split"):
        split_names(["a", "b"])


def test_grid_is_split_by_sentences_letters_or_digits(shared_data):
    from core.speech.transcript_files import read_transcript

    folder = shared_data("grid-s1")
    recordings = []
    for path in sorted((folder / "textgrid").glob("*.TextGrid")):
        words = " ".join(w.word for w in read_transcript(path, 2.978).words if w.word)
        recordings.append(said(path.stem, words))
    corpus = Corpus("grid", recordings, ("m",))
    assert [len(hold_out(corpus).held_out[split]) for split in SPLITS] == [40, 40]
    for kind, place in (("letters", 3), ("digits", 4)):
        words, held_out = held_out_words(recordings, kind), hold_out(corpus, kind).held_out
        for split in SPLITS:
            assert 30 < len(held_out[split]) < 60
        # a clip's name spells its sentence: letter in fourth place, digit in fifth, z for zero
        spelt = {DIGIT_OF.get(word, word) for word in words["test"]}
        by_name = {r.sentence for r in recordings if r.sentence[place] in spelt}
        assert set(held_out["test"]) == by_name


def test_a_word_held_out_is_in_no_sentence_to_learn_from():
    words = ("one two", "two three", "three four", "five a", "six", "seven b", "eight c", "nine", "zero one", "four")
    recordings = [said(f"s{i}", text) for i, text in enumerate(words)]
    corpus = hold_out(Corpus("c", recordings, ("m",)), "digits")
    parts = held_out_words(recordings, "digits")
    apart = {name for names in corpus.held_out.values() for name in names}
    heard = {w.word for r in recordings if r.sentence not in apart for w in r.transcript.words}
    assert heard.isdisjoint(parts["tune"] + parts["test"])
    assert set(corpus.held_out["tune"]).isdisjoint(corpus.held_out["test"])


@pytest.mark.parametrize(("kind", "says"), [("digits", "too few"), ("verbs", "no split by 'verbs'")])
def test_what_cannot_be_held_out_is_explained(kind, says):
    with pytest.raises(UserFacingError, match=says):
        hold_out(Corpus("c", [said(f"s{i}", "one two") for i in range(5)], ("m",)), kind)
