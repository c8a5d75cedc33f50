"""Film strips: the right moments, the right rows, words under them."""

from __future__ import annotations

import json

import av
import numpy as np
import pytest

from app import strips
from app.strips import StripRow, StripSettings, even_times_s, film_strip, moments
from core.errors import UserFacingError
from core.motion.marker_set import MarkerSet
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.synthesis.marker_motion import MarkerMotion

SAID = Transcript.covering(
    [PhonemeUtterance("m", 0.2, 0.6), PhonemeUtterance("aa", 0.6, 1.0)], [WordUtterance("ma", 0.2, 1.0)], 1.4
)


def clock(rate_hz, offset=0.0):
    """A motion whose first marker tells the time by its x."""
    positions = np.zeros((round(1.4 * rate_hz) + 1, 4, 3), np.float32)
    positions[:, 0, 0] = np.arange(len(positions)) / rate_hz + offset
    return MarkerMotion(positions, rate_hz, MarkerSet(tuple("abcd"), 30 * np.eye(4, 3)))


@pytest.fixture
def shown(monkeypatch):
    """What is drawn: the motion that the cells are pictures of, and the grid that they are laid out in."""
    seen = {}

    def frames(motion, rig, style, width, height, progress, tracks, background):
        seen.update(motion=motion, tracks=tracks, style=style)
        return iter([np.full((height, width, 3), 10 + n, np.uint8) for n in range(len(motion.positions))])

    def grid(rows, title, ground):
        seen.update(rows=rows, title=title, ground=ground)
        return rows[0].cells[0]

    monkeypatch.setattr(strips, "frames", frames)
    monkeypatch.setattr(strips, "picture_grid", grid)
    return seen


def test_even_moments_are_spread_over_what_is_said():
    np.testing.assert_allclose(even_times_s(SAID, 4), [0.3, 0.5, 0.7, 0.9])
    assert moments(SAID, StripSettings(times_s=(0.9, 0.3))) == (0.3, 0.9)


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        (StripSettings(times_s=(0.3, 1.5)), "1.5 s lies outside the speech, which lasts 1.40 s"),
        (StripSettings(count=0), "1 to 40 moments, not 0"),
        (StripSettings(times_s=(0.1,) * 41), "not 41"),
    ],
)
def test_moments_that_there_are_not_are_told(settings, sentence):
    with pytest.raises(UserFacingError, match=sentence):
        moments(SAID, settings)


def test_every_row_shows_its_motion_at_the_moments_whatever_its_rate(shown):
    rows = [StripRow("one", clock(100.0)), StripRow("other", clock(30.0, 5.0))]
    film_strip(rows, None, SAID, StripSettings(times_s=(0.05, 0.4, 0.81)))
    np.testing.assert_allclose(shown["motion"].positions[:, 0, 0], [0.05, 0.4, 0.81, 5.05, 5.4, 5.81], atol=1e-5)
    assert [row.label for row in shown["rows"]] == ["one", "other"]
    assert [cell[0, 0, 0] for row in shown["rows"] for cell in row.cells] == [10, 11, 12, 13, 14, 15]
    assert shown["tracks"].head is None and len(shown["tracks"].tongue) == 6


def test_phones_words_and_times_stand_under_the_last_row(shown):
    film_strip([StripRow("", clock(30.0))] * 2, None, SAID, StripSettings(times_s=(0.1, 0.4, 0.8), title="T"))
    assert list(shown["rows"][0].captions) == [] and shown["title"] == "T"
    assert list(shown["rows"][1].captions) == ["–", "m", "aa"]
    assert list(shown["rows"][1].notes) == ["0.10 s", "0.40 s ma", "0.80 s ma"]


def size_of(path):
    with av.open(str(path)) as container:
        frame = next(container.decode(video=0))
        return frame.width, frame.height


def test_the_command_draws_a_row_for_each_engine_and_emotion(
    efase, tmp_path, database_path, speech_path, settings_folder
):
    out = tmp_path / "strip.png"
    words = ("strip", speech_path, "--phones", speech_path.with_suffix(".lab"), "--db", database_path, "-o", out,
             "--engine", "search", "--engine", "static", "--emotion", "neutral", "--emotion", "anger",
             "--times", "0.2,0.5,0.9", "--style", "markers", "--size", "64x80", "--json")  # fmt: skip
    code, said, err = efase(*words)
    answer = json.loads(said)
    assert (code, err) == (0, "") and answer["times_s"] == [0.2, 0.5, 0.9]
    assert answer["rows"] == [
        "Constrained search, neutral", "Constrained search, anger", "Still face, neutral", "Still face, anger"
    ]  # fmt: skip
    assert list(size_of(out)) == answer["size"] and answer["size"][0] > 3 * 64 and answer["size"][1] > 4 * 80
    assert sorted(p.name for p in tmp_path.iterdir() if p.suffix) == ["strip.png"]


@pytest.mark.parametrize(
    ("more", "sentence"),
    [
        (("--times", "0.2,99"), "99 s lies outside the speech"),
        (("--times", "soon"), "'soon' is not a time"),
        (("--times", "1", "--count", "3"), "choose one of them"),
        (("--captured",), "holds no capture of these words"),
        (("--engine", "magic"), "no engine 'magic'"),
        (("--style", "oil"), "no style 'oil'"),
        (("--size", "9x9"), "not a picture size"),
    ],
)
def test_what_cannot_be_is_one_sentence(efase, tmp_path, database_path, speech_path, settings_folder, more, sentence):
    code, said, err = efase("strip", speech_path, "--phones", speech_path.with_suffix(".lab"), "--db", database_path,
                            "-o", tmp_path / "strip.png", *more)  # fmt: skip
    assert (code, said) == (2, "") and sentence in err and len(err.strip().splitlines()) == 1
    assert not (tmp_path / "strip.png").exists()
