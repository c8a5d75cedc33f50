import itertools
import re

import numpy as np
import pytest

from core.errors import UserFacingError
from core.speech.phone_table import by_table, read_phone_table
from core.speech.phoneme import PHONEMES
from core.speech.timed_label import TimedLabel
from core.speech.transcript_files import read_transcript


def label(name, start_s=1.0, end_s=1.4):
    return TimedLabel(name, start_s, end_s, "'x', line 1")


def test_pinyin_is_a_table_of_our_phones():
    table, warnings = read_phone_table("pinyin")
    assert not warnings and all(phone in PHONEMES for phones in table.values() for phone in phones)
    parts = "b p m f d t n l g k h j q x zh ch sh r z c s a o e ai ei ao ou an en ang eng er ong i ia ie iao iu ian in"
    parts += " iang ing iong u ua uo uai ui uan un uang"
    assert set(re.split(" ", parts)) <= set(table)


def test_a_syllable_is_its_initial_and_its_final_without_its_tone():
    table, _ = read_phone_table("pinyin")
    found = by_table([label("zhong1"), label("Guo2"), label("shi4"), label("nü3"), label("pau")], table)
    assert [f.name for f in found] == ["jh", "uh", "ng", "g", "w", "ao", "sh", "ih", "n", "uw", "pau"]


def test_the_phones_of_a_name_share_its_time():
    table, _ = read_phone_table("pinyin")
    found = by_table([label("iang")], table)
    assert found[0].start_s == 1.0 and found[-1].end_s == 1.4
    np.testing.assert_allclose([f.end_s - f.start_s for f in found], 0.4 / 3)
    assert all(a.end_s == b.start_s for a, b in itertools.pairwise(found))


def test_a_table_of_ones_own_may_be_in_ipa_and_says_what_is_nearest(tmp_path):
    (tmp_path / "mine.tsv").write_text("# mine\nU1 y\nAI aɪ\nX x  # ach\n", encoding="utf-8")
    table, warnings = read_phone_table(tmp_path / "mine.tsv")
    assert table["AI"] == ("ay",) and table["X"][0] in PHONEMES
    assert len(warnings) == 1 and "'x'" in warnings[0]


@pytest.mark.parametrize(("text", "said"), [("a\n", "line 1"), ("a aa\nb ✗✗\n", "line 2"), ("# none\n", "no phone"),
                                            ("a aa\na iy\n", "twice")])  # fmt: skip
def test_a_bad_table_is_refused_by_its_line(tmp_path, text, said):
    (tmp_path / "bad.tsv").write_text(text)
    with pytest.raises(UserFacingError, match=said):
        read_phone_table(tmp_path / "bad.tsv")
    with pytest.raises(UserFacingError, match="no phone table"):
        read_phone_table(tmp_path / "missing.tsv")


def textgrid(names, tier):
    lines = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "0", f"{len(names) / 10}", "<exists>", "1",
             '"IntervalTier"', f'"{tier}"', "0", f"{len(names) / 10}", str(len(names))]  # fmt: skip
    for n, name in enumerate(names):
        lines += [f"{n / 10}", f"{(n + 1) / 10}", f'"{name}"']
    return "\n".join(lines)


@pytest.mark.parametrize("tier", ["phones", "shengyun"])
def test_a_mandarin_transcript_in_pinyin_runs_with_its_table(tmp_path, tier):
    (tmp_path / "a.TextGrid").write_text(textgrid(["", "n", "i3", "h", "ao3", "sh", "i4", "j", "ie4", ""], tier))
    transcript = read_transcript(tmp_path / "a.TextGrid", 1.0, table=read_phone_table("pinyin")[0])
    spoken = [u.phone for u in transcript.phonemes]
    assert spoken == ["pau", "n", "iy", "hh", "aw", "sh", "iy", "jh", "y", "eh", "pau"]


def test_a_mandarin_transcript_in_ipa_runs_without_a_table_and_says_what_is_nearest(tmp_path):
    names = ["", "tɕ", "i˥˩", "ʂ", "ʐ̩", "tʂʰ", "ɤ", "y", "ŋ", ""]
    (tmp_path / "a.TextGrid").write_text(textgrid(names, "phones"), encoding="utf-8")
    transcript = read_transcript(tmp_path / "a.TextGrid", 1.0)
    assert len(transcript.phonemes) == 10 and transcript.phonemes[2].phone == "iy"
    assert any("'ʂ'" in warning and "nearest" in warning for warning in transcript.warnings)
