"""Files that are named alike belong together; what lacks is said."""

from __future__ import annotations

import pytest

from core.errors import UserFacingError
from core.importing.survey import survey


@pytest.fixture
def lay(tmp_path):
    """Return a function that writes files of no content, or of the text given."""

    def write(**files):
        for name, text in files.items():
            path = tmp_path / name.replace("__", "/").replace("_DOT_", ".")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text or "-")
        return tmp_path

    return write


def test_files_are_put_together_by_their_stem(lay):
    folder = lay(a_DOT_c3d="", a_DOT_wav="", a_DOT_TextGrid="", b_DOT_csv="", sound__b_DOT_flac="",
                 b_DOT_txt="Hello there.", c_DOT_trc="", d_DOT_wav="", notes_DOT_pdf="")  # fmt: skip
    found = survey([folder])
    assert [s.plan.name for s in found.sentences] == ["a", "b", "c"]
    a, b, c = (s.plan for s in found.sentences)
    assert a.audio.endswith("a.wav")
    assert a.transcript.endswith("a.TextGrid")
    assert b.audio.endswith("b.flac")
    assert b.text == "Hello there."
    assert [s.missing for s in found.sentences] == [(), (), ("audio", "transcript")]
    assert c.audio is None
    assert [s.plan.name for s in found.motionless] == ["d"]
    assert [name.rsplit("/", 1)[-1] for name in found.unused] == ["notes.pdf"]


def test_a_text_with_times_is_a_transcript(lay):
    folder = lay(a_DOT_c3d="", a_DOT_wav="", a_DOT_txt="0.0 0.2 pau\n0.2 0.4 aa\n")
    assert survey([folder]).sentences[0].plan.transcript.endswith("a.txt")


def test_emotions_are_read_from_names(lay):
    folder = lay(take1_angry_DOT_c3d="", sad__take2_DOT_c3d="", take3_DOT_c3d="", happy__take4_neutral_DOT_c3d="")
    emotions = {s.plan.name: s.plan.emotion for s in survey([folder]).sentences}
    assert emotions == {"take1_angry": "anger", "take2": "sadness", "take3": "neutral", "take4_neutral": "neutral"}


def test_of_one_capture_in_two_formats_the_first_kind_is_taken(lay):
    found = survey([lay(a_DOT_c3d="", a_DOT_csv="")])
    assert len(found.sentences) == 1
    assert found.sentences[0].plan.motion.endswith(".c3d")
    assert len(found.unused) == 1


def test_a_corpus_folder_describes_itself(lay):
    folder = lay(
        corpus_DOT_csv="sentence,emotion,text,motion\ns2,sad,Well.,in/x.c3d\ns1,anger,,\n",
        markers_DOT_csv="marker,kept,groups,landmark\nnose,1,origin;rigid,nose_tip\nhat,0,,\n",
        in__x_DOT_c3d="", s2_DOT_wav="", s1_DOT_c3d="", s1_DOT_lab="",
    )  # fmt: skip
    found = survey([folder])
    assert [(s.plan.name, s.plan.emotion, s.plan.text) for s in found.sentences] == [("s2", "sadness", "Well."),
                                                                                    ("s1", "anger", "")]  # fmt: skip
    assert found.sentences[0].plan.motion.endswith("x.c3d")
    plan = found.plan("mine")
    assert plan.markers == {"nose": "nose"}
    assert plan.origin == "nose"
    assert plan.landmarks == {"nose_tip": "nose"}


def test_points_of_pictures_keep_the_order_of_their_archive(shared_data):
    found = survey([shared_data("grid-s1")])
    assert len(found.sentences) == 480
    assert found.with_scale
    plan = found.plan("grid")
    assert plan.sentences[0].take == plan.sentences[0].name != min(s.name for s in plan.sentences)
    assert not plan.mending.faults
    assert len(plan.markers) == 148


def test_nothing_to_import_is_said(lay, tmp_path):
    with pytest.raises(UserFacingError, match="neither motion nor sound"):
        survey([lay(readme_DOT_md="")])
    with pytest.raises(UserFacingError, match="absent"):
        survey([tmp_path / "absent"])
