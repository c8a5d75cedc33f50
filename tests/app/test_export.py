"""What is written is the span that was asked for, in every form."""

from __future__ import annotations

import ezc3d
import numpy as np
import pytest

from app.export import VideoSettings, background_colour, check_outputs, export, frame_rate, span_of_time
from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.picture import read_picture
from core.media.video import probe
from core.motion.marker_set import MarkerSet
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.speech.transcript_files import read_transcript
from core.synthesis.marker_motion import MarkerMotion

NAMES = ("a", "b", "c", "d")
REST = np.array([[-40, 0, 0], [40, 0, 0], [0, 40, 0], [0, -40, 10]], float)
SPEECH = Transcript.covering(
    [PhonemeUtterance("pau", 0.0, 0.4), PhonemeUtterance("m", 0.4, 1.2), PhonemeUtterance("aa", 1.2, 2.0)],
    [WordUtterance("ma", 0.4, 2.0)], 2.0,
)  # fmt: skip


@pytest.fixture(scope="module")
def spoken():
    ramp = np.arange(241)[:, None, None] / 120.0  # one millimetre a second
    motion = MarkerMotion((REST + ramp).astype(np.float32), 120.0, MarkerSet(NAMES, REST))
    return motion, Audio(np.sin(np.arange(32_000) / 9).astype(np.float32), 16_000)


def settings(span=None, **more):
    return VideoSettings(frame_rate("25"), 64, 64, "markers", span_s=span, **more)


def test_markers_of_a_span_begin_where_it_begins(spoken, tmp_path):
    export(*spoken, None, tmp_path / "x.c3d", settings((0.5, 1.5)))
    points = ezc3d.c3d(str(tmp_path / "x.c3d"))["data"]["points"]
    assert points.shape[2] == 25
    assert points[0, 0] - REST[0, 0] == pytest.approx(0.52 + np.arange(25) / 25, abs=1e-3)


def test_a_film_of_a_span_has_its_sound_and_its_first_frame_number(spoken, tmp_path):
    export(*spoken, None, tmp_path / "x.avi", settings((0.48, 1.48), start_frame=100))
    facts = probe(tmp_path / "x.avi")
    assert facts.n_frames == 25
    assert facts.audio_duration_s == pytest.approx(1.0, abs=1e-3)
    assert facts.timecode == "00:00:04:12"


def test_pictures_are_numbered_from_the_first_frame_and_stand_on_the_background(spoken, tmp_path):
    green = background_colour("#00ff00")
    export(*spoken, None, tmp_path / "x.png", settings((0.0, 0.1), start_frame=7, background=green))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x.0007.png", "x.0008.png", "x.0009.png"]
    assert read_picture(tmp_path / "x.0008.png")[0, 0].tolist() == [0, 255, 0]


def test_a_transcript_of_a_span_starts_at_zero(spoken, tmp_path):
    export(*spoken, None, tmp_path / "x.TextGrid", settings((1.0, 1.5)), transcript=SPEECH)
    read = read_transcript(tmp_path / "x.TextGrid", 0.5)
    assert [(u.phone, round(u.start_s, 6), round(u.end_s, 6)) for u in read.phonemes] == [
        ("m", 0.0, 0.2), ("aa", 0.2, 0.5),
    ]  # fmt: skip
    assert [w.word for w in read.words] == ["ma"]


def test_a_span_without_a_frame_is_said(spoken, tmp_path):
    with pytest.raises(UserFacingError, match="no frame"):
        export(*spoken, None, tmp_path / "x.avi", settings((5.0, 6.0)))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("text", ["", "3", "2-1", "a-b", "-1-2", "1-1", "nan-2", "1-inf"])
def test_what_is_no_stretch_of_time_is_said(text):
    with pytest.raises(UserFacingError, match="stretch of time"):
        span_of_time(text)


@pytest.mark.parametrize("text", ["green", "#12345", "00ff00", "#gggggg"])
def test_what_is_no_colour_is_said(text):
    with pytest.raises(UserFacingError, match="colour"):
        background_colour(text)


def test_an_unknown_suffix_names_the_known_ones(tmp_path):
    with pytest.raises(UserFacingError, match="suffix") as caught:
        check_outputs([tmp_path / "x.gif"])
    assert "TextGrid" in caught.value.remedy
