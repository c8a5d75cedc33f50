import itertools
from collections import Counter

import pytest

from core.actress.texts import (
    COMPARISON_REQUIRED,
    DATABASE_REQUIRED,
    OWN_COUNT,
    SHARED_COUNT,
    TUNING_REQUIRED,
    bundled_lines,
    candidate_texts,
    choose_lines,
    choose_texts,
    cmu_dictionary,
    cmu_phones,
    coverage,
    dictionary_diphones,
    diphones,
    words_of,
)
from core.errors import UserFacingError
from core.speech.emotion import EMOTIONS

LINES = bundled_lines()
ALIKE = Counter({pair: 1.0 for pair in itertools.product("ABCXYZ", repeat=2)})


def _texts(role, emotion=None):
    return [line.text for line in LINES if line.role == role and emotion in (line.emotion, None)]


def test_choice_takes_the_text_that_brings_most_new_diphones():
    phones = {"ab": "AB", "abc": "ABC", "abcab": "ABCAB", "xyz": "XYZ"}
    assert choose_texts(phones, 2, ALIKE) == ["abcab", "xyz"]
    assert choose_texts(phones, 2, ALIKE, chosen=["xyz"]) == ["xyz", "abcab"]


def test_choice_prefers_what_is_worth_more():
    phones = {"abc": "ABC", "xy": "XY"}
    assert choose_texts(phones, 1, {("A", "B"): 1, ("B", "C"): 1, ("X", "Y"): 3}) == ["xy"]


def test_choice_ends_with_the_candidates():
    assert sorted(choose_texts({"a": "A", "b": "B"}, 5, ALIKE)) == ["a", "b"]


def test_dictionary_diphones_are_counted_within_words():
    counts = dictionary_diphones()
    entries = cmu_dictionary()
    assert counts.total() == sum(len(phones) - 1 for phones in entries.values())
    assert counts["P", "L"] == sum(
        sum(pair == ("P", "L") for pair in itertools.pairwise(phones)) for phones in entries.values()
    )


def test_a_word_outside_the_dictionary_is_named():
    with pytest.raises(UserFacingError, match="'qwxq' in 'a qwxq'"):
        cmu_phones(["a qwxq"])


def test_bundled_sentences_are_the_choice():
    assert choose_lines() == LINES


def test_sizes_are_those_of_the_issue():
    for emotion in EMOTIONS:
        assert len(_texts("database", emotion)) == len(set(_texts("database", emotion))) == SHARED_COUNT + OWN_COUNT
        assert SHARED_COUNT + OWN_COUNT >= 45
        assert len(_texts("tuning", emotion)) == 6 and len(_texts("comparison", emotion)) == 3
        assert len(_texts("demo", emotion)) == 1
    assert len({line.sentence for line in LINES}) == len(LINES)


def test_held_out_texts_are_in_no_emotion_of_the_database():
    database = {" ".join(words_of(text)) for text in _texts("database")}
    held_out = [" ".join(words_of(text)) for role in ("tuning", "comparison", "demo") for text in _texts(role)]
    assert len(set(held_out)) == 24 + 12 + 4
    assert not database & set(held_out)


def test_texts_of_the_paper_are_spoken():
    for text in DATABASE_REQUIRED:
        assert all(text in _texts("database", emotion) for emotion in EMOTIONS)
    assert TUNING_REQUIRED in _texts("tuning") and COMPARISON_REQUIRED in _texts("comparison")


def test_greedy_choice_covers_more_than_as_many_candidates_at_random():
    chosen = set(_texts("database", "neutral"))
    kinds, tokens = coverage(chosen)
    for start in range(0, 300, 60):
        plain = candidate_texts()[start : start + len(chosen)]
        plain_kinds, plain_tokens = coverage(plain)
        assert kinds > plain_kinds and tokens > plain_tokens
    held = set().union(*(diphones(phones) for phones in cmu_phones(chosen).values())) & dictionary_diphones().keys()
    assert kinds == pytest.approx(len(held) / len(dictionary_diphones()))
