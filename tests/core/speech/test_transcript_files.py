import codecs
from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from praatio import textgrid as praatio_textgrid

from core.errors import UserFacingError
from core.speech.textgrid import write_textgrid
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.speech.transcript_files import read_transcript

REPOSITORY = Path(__file__).resolve().parents[3]
DATA = REPOSITORY / "../shared/data"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="the shared test data is not beside the repository")

SHORT = '''File type = "ooTextFile"
Object class = "TextGrid"

0
1
<exists>
2
"IntervalTier"
"words"
0
1
3
0
0.2
""
0.2
0.8
"say ""no"""
0.8
1
""
"IntervalTier"
"phones"
0
1
4
0
0.2
"sil"
0.2
0.5
"N"
0.5
0.8
"OW1"
0.8
1
"sil"
'''
XWAVES = "separator ;\nnfields 1\n#\n 0.2 100 pau\n 0.5 100 n\n 0.8 100 ow\n 1.0 100 pau\n"
HTK = "0 2000000 sil\n2000000 5000000 n -12.5\n5000000 8000000 ow -3\n8000000 10000000 sil\n"
PLAIN = "# by hand\n0 0.2 pau\n0.2 0.5 n\n0.5 0.8 ow\n0.8 1 pau\n"
SPOKEN = (("pau", 0.0, 0.2), ("n", 0.2, 0.5), ("ow", 0.5, 0.8), ("pau", 0.8, 1.0))


def spoken(transcript):
    return tuple((u.phone, round(u.start_s, 6), round(u.end_s, 6)) for u in transcript.phonemes)


def read(tmp_path, content, name="a.lab", duration_s=1.0, **options):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_transcript(path, duration_s, **options)


@pytest.mark.parametrize("content", [SHORT, XWAVES, HTK, PLAIN, PLAIN.replace(" ", "\t"), PLAIN.replace(" ", ",")])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1"])
@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_every_format_encoding_and_line_end_says_the_same(tmp_path, content, encoding, newline):
    transcript = read(tmp_path, content.replace("\n", newline).encode(encoding))
    assert spoken(transcript) == SPOKEN
    assert transcript.duration_s == 1.0
    assert transcript.warnings == ()


def test_words_come_with_a_textgrid(tmp_path):
    assert read(tmp_path, SHORT).words == (WordUtterance('say "no"', 0.2, 0.8),)


@pytest.mark.parametrize("format_", ["long_textgrid", "short_textgrid"])
def test_what_praatio_writes_is_read(tmp_path, format_):
    grid = praatio_textgrid.Textgrid(0, 1)
    grid.addTier(praatio_textgrid.PointTier("pitch", [(0.1, "120"), (0.4, "99")], 0, 1))
    grid.addTier(praatio_textgrid.IntervalTier("Jane - words", [(0.2, 0.8, "no")], 0, 1))
    grid.addTier(praatio_textgrid.IntervalTier("Jane - phones", [(0.2, 0.5, "N"), (0.5, 0.8, "OW1")], 0, 1))
    path = tmp_path / "a.TextGrid"
    grid.save(str(path), format_, includeBlankSpaces=True)
    transcript = read_transcript(path, 1.0)
    assert spoken(transcript) == SPOKEN
    assert transcript.words == (WordUtterance("no", 0.2, 0.8),)


times = st.lists(st.integers(1, 4000), min_size=3, max_size=30, unique=True).map(sorted)


@given(times, st.data())
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_what_is_written_is_read_back_by_us_and_by_praatio(tmp_path, edges_ms, data):
    edges = [0.0, *(e / 1000 for e in edges_ms)]
    phones = st.sampled_from(["ae", "m", "el", "pau", "ax", "zh"])
    utterances = [PhonemeUtterance(data.draw(phones), a, b) for a, b in pairwise(edges)]
    utterances.append(PhonemeUtterance("ae", edges[-1], edges[-1] + 0.1))
    words = [WordUtterance('o"clock', edges[1], edges[2]), WordUtterance("née", edges[2], edges[3])]
    transcript = Transcript.covering(utterances, words, edges[-1] + 0.1)
    path = tmp_path / "a.TextGrid"
    write_textgrid(transcript, path)

    again = read_transcript(path, transcript.duration_s, strict=True)
    assert again.phones == transcript.phones
    assert [w.word for w in again.words] == ['o"clock', "née"]
    for one, two in zip((*again.phonemes, *again.words), (*transcript.phonemes, *transcript.words)):
        assert one.start_s == pytest.approx(two.start_s, abs=1e-8)
        assert one.end_s == pytest.approx(two.end_s, abs=1e-8)

    entries = praatio_textgrid.openTextgrid(str(path), includeEmptyIntervals=True).getTier("phones").entries
    assert [e.label for e in entries] == list(transcript.phones)
    assert entries[-1].end == pytest.approx(transcript.duration_s, abs=1e-8)


def test_writing_leaves_nothing_half_done(tmp_path):
    transcript = Transcript.covering([PhonemeUtterance("ae", 0, 1)], [], 1.0)
    with pytest.raises(UserFacingError, match="cannot be written"):
        write_textgrid(transcript, tmp_path / "none" / "a.TextGrid")
    write_textgrid(transcript, tmp_path / "a.TextGrid")
    assert [p.name for p in tmp_path.iterdir()] == ["a.TextGrid"]


def test_a_phone_tier_without_a_name_is_found_by_what_it_holds(tmp_path):
    assert spoken(read(tmp_path, SHORT.replace('"phones"', '"tier 2"'))) == SPOKEN


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ("", "is empty"),
        ("  \n\n", "is empty"),
        (b"\x00\x01\x02\xff" * 40, "a.lab"),
        ("ooBinaryFile\x08TextGrid\0\0", "is not text"),
        ("hello world\n", "line 1: 'hello world' is not"),
        ("0 0.2 pau\n0.2 0.5\n", "line 2"),
        ("0 0.2 pau\n0.2 nan n\n", "line 2: 'nan' is not a time"),
        ("0 0.2 pau\n0.2 inf n\n", "line 2: 'inf' is not a time"),
        ("-1 0.2 n\n", "line 1: '-1' is not a time"),
        ("0 0.5 n\n0.4 1 ow\n", "line 2 starts at 0.4 s, before the one above it ends at 0.5 s"),
        ("0 0.5 n\n0.9 0.6 ow\n", "line 2 ends at 0.6 s, before it starts at 0.9 s"),
        ("#\n0.5 100 n\n0.4 100 ow\n", "line 3 ends at 0.4 s, before it starts at 0.5 s"),
        ("0 1 sil\n", "holds no phones"),
        ("#\n", "holds no phones"),
        ("0 1 %%\n", "line 1: '%%' is not a phone name"),
        ("0 0.5 n\n0.5 9 ow\n", "ends at 9.00 s, after the sound, which lasts 1.00 s"),
        ("0 0.1 pau\n0.1 0.5 n\n", "ends at 0.50 s, before the sound, which lasts 1.00 s"),
        ("0 1000000 sil\n1000000 5000000 n\n", "ends at 0.50 s, before the sound"),
        (SHORT.replace("0\n1\n", "0\n0.5\n").replace("0.8\n1\n", "0.4\n0.5\n"), "interval"),
        (SHORT.replace('"OW1"', '"%%"'), "tier 'phones', interval 3: '%%' is not a phone name"),
        (SHORT.replace('"N"', '"sil"').replace('"OW1"', '""'), "holds no phones"),
        (SHORT.replace('"phones"', '"x"').replace('"OW1"', '"%%"'), "has no tier of phones; it has 'words', 'x'"),
        (SHORT.replace('0.5\n"N"', '0.1\n"N"'), "interval 2 ends at 0.1 s, before it starts"),
        (SHORT.replace('0.5\n"N"', '0.7\n"N"'), "interval 3 starts at 0.5 s, before the one above"),
        (SHORT.replace('0.5\n"N"', 'nan\n"N"'), "interval 2: 'nan' is not a time"),
        (SHORT.replace('0.5\n"N"', '--undefined--\n"N"'), "interval 2: '--undefined--' is not a time"),
        (SHORT[: SHORT.index('"OW1"')], "breaks off at tier 'phones', interval 3"),
        (SHORT.replace('"phones"\n0\n1\n4', '"phones"\n0\n1\n4000000'), "possible number of entries"),
        (SHORT.replace("<exists>\n2", "<exists>\n2e9"), "possible number of entries"),
        (SHORT.replace("<exists>\n2", "<exists>\n0"), "no tier of intervals"),
        (SHORT.replace("TextGrid", "Pitch 1"), "is not a Praat TextGrid"),
    ],
)
def test_bad_transcripts_are_one_sentence_naming_the_place(tmp_path, content, says):
    with pytest.raises(UserFacingError) as caught:
        read(tmp_path, content)
    assert says in caught.value.message
    assert "a.lab" in caught.value.message
    assert "\n" not in caught.value.message


def test_a_textgrid_that_ends_before_or_after_the_sound_says_both_times(tmp_path):
    for duration_s, relation in ((3.0, "before"), (0.5, "after")):
        with pytest.raises(UserFacingError) as caught:
            read(tmp_path, SHORT, duration_s=duration_s)
        assert f"ends at 1.00 s, {relation} the sound, which lasts {duration_s:.2f} s" in caught.value.message
    for duration_s in (0.8, 1.2):
        assert read(tmp_path, SHORT, duration_s=duration_s).phonemes[-1].end_s == duration_s


def test_a_label_file_may_leave_out_the_last_silence(tmp_path):
    assert spoken(read(tmp_path, XWAVES, duration_s=3.0))[-1] == ("pau", 0.8, 3.0)
    assert read(tmp_path, XWAVES, duration_s=3.0).warnings == ()
    transcript = read(tmp_path, "0.2 0.5 n\n0.5 0.8 ow\n", duration_s=3.0)
    assert spoken(transcript) == (("pau", 0, 0.2), ("n", 0.2, 0.5), ("ow", 0.5, 0.8), ("pau", 0.8, 3.0))
    assert "taken as silence" in transcript.warnings[0]


def test_a_foreign_phone_warns_or_in_strict_mode_is_refused(tmp_path):
    transcript = read(tmp_path, "0 0.5 ʁ\n0.5 0.6 iː\n0.6 1 ʁ\n")
    assert transcript.phones[1] == "iy"
    assert len(transcript.warnings) == 1 and "'ʁ'" in transcript.warnings[0]
    with pytest.raises(UserFacingError, match="line 1: the phone 'ʁ' is not in our set"):
        read(tmp_path, "0 0.5 ʁ\n0.5 1 iː\n", strict=True)


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(UserFacingError, match=r"no transcript '.*none\.lab'"):
        read_transcript(tmp_path / "none.lab", 1.0)
    with pytest.raises(UserFacingError, match="is not a file"):
        read_transcript(tmp_path, 1.0)


@given(st.sampled_from([SHORT, XWAVES, HTK, PLAIN]), st.lists(st.tuples(st.integers(0, 600), st.binary(max_size=3))))
@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_damaged_files_give_a_transcript_or_a_sentence(tmp_path, content, cuts):
    raw = bytearray(content.encode())
    for at, piece in cuts:
        raw[at : at + 2] = piece
    try:
        transcript = read(tmp_path, bytes(raw))
    except UserFacingError:
        return
    edges = [(u.start_s, u.end_s) for u in transcript.phonemes]
    assert edges[0][0] == 0 and edges[-1][1] == 1.0
    assert all(a[1] == b[0] for a, b in pairwise(edges))


@pytest.mark.parametrize("encoding", [codecs.BOM_UTF16_BE + SHORT.encode("utf-16-be"), SHORT.encode("utf-16-be")])
def test_big_endian_utf16(tmp_path, encoding):
    assert spoken(read(tmp_path, encoding)) == SPOKEN


@needs_data
def test_the_recordings_of_praatio():
    folder = DATA / "praatio-speech"
    mary = read_transcript(folder / "mary.TextGrid", 1.869687)
    assert " ".join(mary.phones) == "pau m ax r iy r ow l d th ax b ao r l pau"
    assert [w.word for w in mary.words] == ["mary", "rolled", "the", "barrel"]
    assert mary.words[0].start_s == pytest.approx(0.31542, abs=1e-5)
    bobby = read_transcript(folder / "bobby_phones.TextGrid", 1.194625)
    assert " ".join(bobby.phones).startswith("pau b aa b iy r ih")
    assert "'PT'" in bobby.warnings[0]
    with pytest.raises(UserFacingError, match="no tier of phones; it has 'word', 'phrase'"):
        read_transcript(folder / "bobby_words.TextGrid", 1.194625)


@needs_data
def test_a_sample_of_grid_is_read_as_praatio_reads_it():
    for path in sorted((DATA / "grid-s1/textgrid").glob("*.TextGrid"))[::40]:
        grid = praatio_textgrid.openTextgrid(str(path), includeEmptyIntervals=True)
        transcript = read_transcript(path, grid.maxTimestamp, strict=True)
        spoken_words = [e.label for e in grid.getTier("words").entries if e.label]
        assert [w.word for w in transcript.words] == spoken_words
        expected = [e for e in grid.getTier("phones").entries if e.label != "SIL"]
        ours = [u for u in transcript.phonemes if u.phone != "pau"]
        assert [u.start_s for u in ours] == pytest.approx([e.start for e in expected], abs=1e-3)
        assert [u.phone for u in ours] == [e.label.lower() for e in expected]
