from core.actress.corpus import database_sentences, demo_sentences
from core.actress.texts import (
    REQUIRED,
    TEXT_COUNT,
    candidate_texts,
    choose_texts,
    cmu_phones,
    diphones,
)


def test_choice_takes_the_text_that_brings_most_new_diphones():
    phones = {"ab": "AB", "abc": "ABC", "abcab": "ABCAB", "xyz": "XYZ"}
    assert choose_texts(phones, 2) == ["abcab", "xyz"]
    assert choose_texts(phones, 2, required=["xyz"]) == ["xyz", "abcab"]


def test_choice_ends_with_the_candidates():
    assert sorted(choose_texts({"a": "A", "b": "B"}, 5)) == ["a", "b"]


def test_database_texts_are_the_greedy_choice():
    chosen = choose_texts(cmu_phones(candidate_texts()), TEXT_COUNT, REQUIRED)
    assert [s.text for s in database_sentences() if s.emotion == "neutral"] == chosen


def test_greedy_choice_beats_the_first_candidates():
    phones = cmu_phones(candidate_texts())
    covered = {pair for text in choose_texts(phones, TEXT_COUNT, REQUIRED) for pair in diphones(phones[text])}
    plain = {pair for text in candidate_texts()[:TEXT_COUNT] for pair in diphones(phones[text])}
    assert len(covered) > len(plain)


def test_texts_are_short_and_spoken_in_every_emotion():
    texts: dict[str, list[str]] = {}
    for spoken in database_sentences():
        texts.setdefault(spoken.emotion, []).append(spoken.text)
    assert sorted(texts) == ["anger", "happiness", "neutral", "sadness"]
    assert all(spoken == texts["neutral"] for spoken in texts.values())
    assert all(5 <= len(text.split()) <= 12 for text in texts["neutral"])


def test_demo_texts_are_in_no_database_sentence():
    demo = demo_sentences()
    assert sorted(s.emotion for s in demo) == ["anger", "happiness", "neutral", "sadness"]
    assert not {s.text for s in demo} & {s.text for s in database_sentences()}
