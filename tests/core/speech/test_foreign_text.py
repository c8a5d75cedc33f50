import os
import shutil
import stat

import pytest

from core.errors import UserFacingError
from core.speech.foreign_text import espeak_pronunciations, foreign_words
from core.speech.phoneme import PHONEMES


@pytest.fixture
def says(tmp_path, monkeypatch):
    """Return a function that puts a stand-in for espeak-ng on the path, which answers every word the same."""

    def answer(ipa, code=0):
        program = tmp_path / "espeak-ng"
        program.write_text(f"#!/bin/sh\nprintf '%s\\n' '{ipa}'\nexit {code}\n", encoding="utf-8")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}/usr/bin{os.pathsep}/bin")

    return answer


def test_words_of_any_script_and_ideographs_one_by_one():
    assert foreign_words("Grüß Gott, 3 l'été — naïve!") == ["Grüß", "Gott", "3", "l'été", "naïve"]
    assert foreign_words("你好,世界。") == ["你", "好", "世", "界"]
    assert foreign_words("ni3 hao3") == ["ni3", "hao3"]
    assert foreign_words("...") == []


def test_ipa_becomes_our_phones_and_the_nearest_is_told_once(says):
    says("ɡ_ˈuː_t_ə_n y_ç_(en)_")
    lexicon, warnings = espeak_pronunciations(["Guten", "Guten", "Tag"], "de")
    assert set(lexicon) == {"Guten", "Tag"} and lexicon["Guten"][0][:5] == ("g", "uw", "t", "ax", "n")
    assert all(phone in PHONEMES for phone in lexicon["Tag"][0])
    assert len([w for w in warnings if "'ç'" in w]) == 1


def test_the_third_tone_of_mandarin_is_no_vowel(says):
    says("χ_ˈɑu2_ n_ˈiɜ_")
    lexicon, _ = espeak_pronunciations(["hao3"], "cmn-latn-pinyin")
    assert lexicon["hao3"][0][-1] == "iy"


def test_without_espeak_it_says_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UserFacingError, match="not installed"):
        espeak_pronunciations(["Tag"], "de")


@pytest.mark.parametrize(("ipa", "code", "said"), [("", 1, "no language"), ("", 0, "does not say")])
def test_a_language_or_a_word_that_it_does_not_know_is_refused(says, ipa, code, said):
    says(ipa, code)
    with pytest.raises(UserFacingError, match=said):
        espeak_pronunciations(["Tag"], "de")
    with pytest.raises(UserFacingError, match="not a language"):
        espeak_pronunciations(["Tag"], "-w/tmp/x")


@pytest.mark.skipif(shutil.which("espeak-ng") is None, reason="espeak-ng is not installed")
def test_the_real_one_says_german_french_and_pinyin():
    lexicon, _ = espeak_pronunciations(["Maschine", "Buch"], "de")
    assert [lexicon["Maschine"][0][i] for i in (0, 2, 3, 4)] == ["m", "sh", "iy", "n"]
    assert lexicon["Buch"][0][:2] == ("b", "uw")
    assert espeak_pronunciations(["ma1"], "cmn-latn-pinyin")[0]["ma1"][0][0] == "m"
