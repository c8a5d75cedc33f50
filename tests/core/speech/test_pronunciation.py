import re
from difflib import SequenceMatcher

import pytest

from core.errors import UserFacingError
from core.speech.letter_to_sound import guess_phones
from core.speech.lexicon import read_lexicon
from core.speech.phone_names import table_rows
from core.speech.phoneme import PHONEMES
from core.speech.pronunciation import Pronouncer
from core.speech.schwa import phones_of_word
from core.speech.sphinx import SphinxAligner


@pytest.fixture(scope="module")
def dictionary():
    return SphinxAligner().dictionary


@pytest.fixture
def pronouncer(dictionary):
    return Pronouncer(dictionary, {"Zaphod": [("z", "ey", "f", "aa", "d")], "cat": [("m", "iy", "aw")]})


@pytest.mark.parametrize(
    ("word", "phones"),
    [
        ("Hello", "hh ax l ow"),
        ("the", "dh ax"),
        ("of", "ax v"),
        ("but", "b ax t"),
        ("cut", "k ah t"),
        ("mother", "m ah dh er"),
        ("another", "ax n ah dh er"),
        ("about", "ax b aw t"),
        ("button", "b ah t ax n"),
        ("production", "p r ax d ah k sh ax n"),
        ("ZAPHOD", "z ey f aa d"),
        ("cat", "m iy aw"),
        ("dogs'", "d ao g z"),
        ("'tis", "t ih z"),
        ("Zürich", "z uh r ih k"),
        ("googled", "g uw g ax l d"),
        ("selfies", "s eh l f iy z"),
        ("Zaphod's", "z ey f aa d z"),
        ("blogged", "b l ao g d"),
        ("nooooo", "n ow"),
        ("hello-the", "hh ax l ow dh ax"),
        ("brrrrr", "b er"),
    ],
)
def test_known_words_and_their_forms_need_no_warning(pronouncer, word, phones):
    pronunciation = pronouncer.pronounce(word)
    assert " ".join(pronunciation.variants[0]) == phones
    assert (pronunciation.word, pronunciation.warning) == (word, "")


def test_the_letter_z_and_other_words_keep_all_their_readings(pronouncer):
    assert set(pronouncer.pronounce("z").variants) == {("z", "iy"), ("z", "eh", "d")}
    assert {" ".join(v) for v in pronouncer.pronounce("the").variants} == {"dh ax", "dh iy"}


@pytest.mark.parametrize(
    ("word", "phones", "how"),
    [
        ("XKCD", "eh k s k ey s iy d iy", "its letters"),
        ("mp", "eh m p iy", "its letters"),
        ("hatrabbit", "hh ae t r ae b ax t", "the words in it"),
        ("blorf", "b l ao r f", "its spelling"),
        ("shreen", "sh r iy n", "its spelling"),
    ],
)
def test_unknown_words_are_guessed_with_a_warning_that_names_the_phones(pronouncer, word, phones, how):
    pronunciation = pronouncer.pronounce(word)
    assert " ".join(pronunciation.variants[0]) == phones
    assert f"'{word}'" in pronunciation.warning
    assert f"'{phones}'" in pronunciation.warning
    assert how in pronunciation.warning


@pytest.mark.parametrize("word", ["日本", "привет", "αβγ"])
def test_other_scripts_ask_for_a_lexicon(pronouncer, word):
    with pytest.raises(UserFacingError, match=f"'{word}' cannot be read") as caught:
        pronouncer.pronounce(word)
    assert "lexicon" in caught.value.remedy


def test_nine_guessed_phones_in_ten_are_the_dictionarys(dictionary):
    """Plain syllables and some longer words, guessed from their letters alone; ah and ax count as one."""
    starts, ends = "bcdfghlmnprst", ("t", "n", "ck", "ll", "st")
    words = [f"{a}{b}{c}" for a in starts for b in "aeiou" for c in ends]
    longer = "station nature knight phone machine running happily wonderful computer elephant dangerous"
    words += re.findall(r"\w+", longer)
    right = total = 0
    for word in words:
        known = [[p.lower() for p in phones] for phones in dictionary(word)]
        guess = [phone.replace("ax", "ah") for phone in guess_phones(word)]
        matches = [sum(b.size for b in SequenceMatcher(None, guess, k).get_matching_blocks()) / len(k) for k in known]
        if known:
            right, total = right + max(matches), total + 1
    assert total > 150
    assert right / total > 0.9


def test_guesses_are_made_of_our_phones():
    for _, letters, _, phones in table_rows("letter_to_sound.tsv"):
        assert letters.isalpha()
        assert set(phones.split()) <= set(PHONEMES) - {"pau"}, letters
    for letter in "abcdefghijklmnopqrstuvwxyz":
        assert set(guess_phones(letter * 2 + "a")) <= set(PHONEMES)
    assert guess_phones("") == ()


def test_only_ah_depends_on_the_word():
    arpabet = ["P", "R", "AH", "D", "AH", "K", "SH", "AH", "N"]
    assert [p.upper().replace("AX", "AH") for p in phones_of_word("production", arpabet)] == arpabet


def test_a_lexicon_in_any_phone_set(tmp_path):
    path = tmp_path / "names.dict"
    path.write_text("# names\nefase IY F EY S\nefase(2) iː f æ s\r\n\nDaenerys d ax n eh r ih s\n;;; end\n", "utf-8")
    assert read_lexicon(path) == {
        "efase": [("iy", "f", "ey", "s"), ("iy", "f", "ae", "s")],
        "daenerys": [("d", "ax", "n", "eh", "r", "ih", "s")],
    }


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "is empty"),
        ("# none\n", "holds no word"),
        ("a AH\nword\n", "line 2: 'word' has no phones"),
        ("word W sil D\n", "line 1: 'word' has no phones, or a silence"),
        ("word W %% D\n", "line 1: '%%' is not a phone name"),
    ],
)
def test_bad_lexicon_lines_are_named(tmp_path, content, says):
    path = tmp_path / "names.dict"
    path.write_text(content)
    with pytest.raises(UserFacingError) as caught:
        read_lexicon(path)
    assert says in caught.value.message
    assert "names.dict" in caught.value.message
