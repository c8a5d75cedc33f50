import re
import unicodedata

import pytest

from core.errors import UserFacingError
from core.speech.phone_names import is_ipa, phone_named, phones_named, table_rows
from core.speech.phoneme import PAU, PHONEMES, viseme_of

# CMUdict's 39 phones, from its published phone list, in our spelling
CMUDICT = {
    name: name.lower()
    for name in re.findall(
        r"\w+", "AA AE AH AO AW AY B CH D DH EH ER EY F G HH IH IY JH K L M N NG OW OY P R S SH T TH UH UW V W Y Z ZH"
    )
}
# IPA of the key words of Wells's lexical sets, British and American, and of the English consonants
IPA = {
    "iː": "iy", "ɪ": "ih", "ɛ": "eh", "e": "eh", "æ": "ae", "ɑː": "aa", "ɒ": "aa", "ɔː": "ao", "ʊ": "uh", "uː": "uw",
    "ʌ": "ah", "ɜː": "er", "ɝ": "er", "ɚ": "er", "ə": "ax", "eɪ": "ey", "aɪ": "ay", "ɔɪ": "oy", "əʊ": "ow",
    "oʊ": "ow", "aʊ": "aw", "tʃ": "ch", "dʒ": "jh", "t͡ʃ": "ch", "d͡ʒ": "jh", "ʃ": "sh", "ʒ": "zh", "θ": "th",
    "ð": "dh", "ŋ": "ng", "j": "y", "ɹ": "r", "r": "r", "ɡ": "g", "g": "g", "h": "hh", "l̩": "el", "n̩": "en",
    "m̩": "em", "ɫ": "l", "pʰ": "p", "t̪": "t", "ɹ̩": "er", "ə˞": "er", "ˈaɪ": "ay", "u": "uw", "w": "w",
}  # fmt: skip


@pytest.mark.parametrize("phone", PHONEMES)
def test_our_own_names_mean_themselves(phone):
    for name in (phone, phone.upper(), f" {phone} "):
        assert phone_named(name).phone == phone
        assert phone_named(name).exact


@pytest.mark.parametrize("stress", ["", "0", "1", "2"])
def test_cmudict_with_and_without_stress(stress):
    vowels = {name for name in CMUDICT if name[0] in "AEIOU"}
    for name, phone in CMUDICT.items():
        if stress and name not in vowels:
            continue
        expected = "ax" if (name, stress) == ("AH", "0") else phone
        match = phone_named(name + stress)
        assert (match.phone, match.exact) == (expected, True), name


@pytest.mark.parametrize(("name", "phone"), IPA.items())
def test_english_ipa(name, phone):
    for spelling in (name, unicodedata.normalize("NFD", name), unicodedata.normalize("NFC", name)):
        match = phone_named(spelling, ipa=True)
        assert (match.phone, match.exact) == (phone, True)


@pytest.mark.parametrize(
    "name", ["", " ", "SIL", "sil", "sp", "spn", "pau", "h#", "#", "<p:>", "<usb>", "[NOISE]", "+SPN+", "_", "<sil>"]
)
def test_every_kind_of_silence(name):
    match = phone_named(name)
    assert (match.phone, match.exact) == (PAU, True)


@pytest.mark.parametrize(
    ("name", "visemes"),
    [
        ("y", "uw uh ow"),  # French u: the lips are round
        ("ʏ", "uw uh"),
        ("ø", "uw ow ao"),
        ("œ", "ow ao"),
        ("ɲ", "n ng y"),
        ("ʎ", "l y"),
        ("x", "k hh"),
        ("ʁ", "g hh"),
        ("ç", "sh y hh"),
        ("c", "k t"),
        ("ʈ", "t"),
        ("ɸ", "f p"),
        ("β", "v b"),
        ("ɱ", "m"),
        ("ʋ", "v w"),
        ("ʔ", "hh"),
        ("t͡s", "s"),
        ("p͡f", "p f"),
        ("ɥ", "w"),
        ("ɯ", "iy uh ih"),
        ("a", "ae aa"),
        ("ɪə", "ih"),
        ("juː", "uw"),
    ],
)
def test_a_foreign_phone_takes_a_near_one_and_is_not_exact(name, visemes):
    match = phone_named(name, ipa=True)
    assert not match.exact
    assert viseme_of(match.phone) in {viseme_of(phone) for phone in visemes.split()}, match.phone


def test_lips_stay_closed_round_or_apart():
    """What a face shows of a foreign sound: closed lips stay closed, rounded vowels rounded, others not."""
    closed, rounded = {"b", "p", "m"}, {"uw", "uh", "ow", "ao"}
    for symbol, first, second, third, _ in table_rows("phone_features.tsv"):
        phone = phone_named(symbol, ipa=True).phone
        if (first, second) in {("plosive", "bilabial"), ("nasal", "bilabial")}:
            assert phone in closed, symbol
        if third == "rounded" and symbol not in "ɒɞɶ":
            assert phone in rounded, symbol
        if third == "unrounded":
            assert phone not in rounded, symbol


def test_y_is_a_glide_unless_the_file_is_in_ipa():
    assert phone_named("y").phone == "y"
    assert phones_named(["y", "uw"], ["a", "b"])[0] == ["y", "uw"]
    assert phones_named(["y", "ə"], ["a", "b"])[0] == ["uw", "ax"]
    assert not is_ipa(["š", "y"])
    assert not is_ipa(["AH0", "Y", "SIL"])


@pytest.mark.parametrize(
    ("name", "phone"),
    [("IY_B", "iy"), ("b-ih+n", "ih"), ("sil-b+ih", "b"), ("AX-H", "ax"), ("tcl", "t"), ("axr", "er")],
)
def test_dressed_up_names(name, phone):
    match = phone_named(name)
    assert (match.phone, match.exact) == (phone, True)


@pytest.mark.parametrize("name", ["hello", "%%", "ж", "中", "7", "ː", "˥", "AH3", "\0", "x" * 10_000, "😀"])
def test_what_is_no_phone_is_refused(name):
    with pytest.raises(UserFacingError, match="is not a phone name"):
        phone_named(name)


def test_one_warning_for_each_foreign_phone_and_strict_refuses_the_first():
    names = ["ʁ", "iː", "ʁ", "x"]
    places = [f"'a.lab', line {i}" for i in range(1, 5)]
    phones, warnings = phones_named(names, places)
    assert len(phones) == 4
    assert [("'ʁ'" in w, "line 1" in w) for w in warnings] == [(True, True), (False, False)]
    with pytest.raises(UserFacingError, match=r"line 1.*'ʁ'"):
        phones_named(names, places, strict=True)
    assert phones_named(["iː"], ["x"], strict=True) == (["iy"], [])


def test_the_tables_are_sound():
    names = [row[0] for row in table_rows("phone_names.tsv")]
    assert len(names) == len(set(names))
    for name, phone, exact, reason in table_rows("phone_names.tsv"):
        assert phone in PHONEMES and exact in ("yes", "no") and reason, name
    ours = [row[4] for row in table_rows("phone_features.tsv") if row[4] != "-"]
    assert len(ours) == len(set(ours))
    assert set(PHONEMES) - set(ours) == {"pau", "ay", "aw", "ey", "oy", "el", "em", "en"}
