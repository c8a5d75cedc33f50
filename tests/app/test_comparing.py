"""`efase compare`: figures, curves and films of two engines, and one sentence for what cannot be compared."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

from core.evaluation.known_capture import known_capture
from core.evaluation.side_by_side import CAPTURED, SideBySide
from core.media.audio import load_audio
from core.motion.database import open_database
from core.search.compute import NumpyKernels
from core.synthesis.engine import SpeechInput
from core.synthesis.registry import make_engine


@pytest.fixture
def compare(efase, mouth_database_path, held_out_speech_path, settings_folder):
    def run(*words, speech=held_out_speech_path):
        phones = held_out_speech_path.with_suffix(".TextGrid")
        return efase("compare", speech, "--phones", phones, "--db", mouth_database_path, *words)

    return run


def made_here(path, speech_path, names):
    """The same comparison, from the engines themselves."""
    database = open_database(path)
    recording = database.held_out_recordings("test")[1]
    said = recording.transcript
    question = SpeechInput(said, audio=load_audio(speech_path))
    motions = [None if name == CAPTURED else make_engine(name, database, NumpyKernels()).synthesise(question).motion
               for name in names]  # fmt: skip
    truth = known_capture(database, recording.text, said.duration_s).truth
    return SideBySide.of(names, tuple(motions), said, truth)


def test_figures_and_curves_are_those_of_the_engines(compare, mouth_database_path, held_out_speech_path, tmp_path):
    code, out, _ = compare("--engines", "search-single", "animeme", "-o", tmp_path / "curves.csv", "--json")
    answer = json.loads(out)
    wanted = made_here(mouth_database_path, held_out_speech_path, ("search-single", "animeme"))
    assert code == 0 and answer["captured"] == {"sentence": "s7", "held_out": True}
    assert [(f["of"], f["standard"]) for f in answer["figures"]] == list(wanted.pairs)
    for found, agreement in zip(answer["figures"], wanted.agreements):
        for measure in ("rms_mm", "lip_mean_mm", "gap_r", "velocity_variance_ratio"):
            assert found[measure] == pytest.approx(getattr(agreement, measure), rel=1e-3, abs=1e-3)
    rows = list(csv.DictReader((tmp_path / "curves.csv").read_text().splitlines()))
    gap = next(c.values_mm for c in wanted.courses if (c.measure, c.of) == ("lip gap", "animeme"))
    np.testing.assert_allclose([float(row["lip_gap_animeme_mm"]) for row in rows], gap, atol=1e-2)


def test_the_capture_beside_an_engine_and_words_for_people(compare):
    code, out, _ = compare("--engines", "captured", "phone-means")
    assert code == 0
    assert "phone-means – captured" in out and "held out" in out and "animeme" not in out


def test_a_film_shows_each_motion_in_its_half(compare, tmp_path):
    import av

    film = tmp_path / "both.avi"
    code, _, _ = compare("--engines", "static", "search-single", "-o", film, "--style", "markers", "--size", "320x200")
    assert code == 0
    with av.open(str(film)) as container:
        pictures = np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]).astype(int)
    with av.open(str(film)) as container:
        sound = sum(frame.samples for frame in container.decode(audio=0))
    assert pictures.shape == (42, 200, 320, 3)  # 1.4 s at 30 frames a second
    assert sound == pytest.approx(1.4 * 16_000, abs=2)
    still, moving = (np.abs(np.diff(half, axis=0)).max(axis=(1, 2, 3)) for half in np.split(pictures, 2, axis=2))
    assert still.max() < 12 < 60 < np.median(moving)
    assert all(half[:, :20].max() > 150 for half in np.split(pictures, 2, axis=2))  # their titles


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--engines", "search", "search"), "with itself"),
        (("--engines", "search", "telepathy"), "no engine 'telepathy'"),
        (("-o", "curves.xlsx"), "curves.xlsx"),
        (("--face", "cast"), "cast"),
        (("-o", "nowhere/curves.csv"), "no folder"),
    ],
)
def test_what_cannot_be_compared_is_one_sentence(compare, words, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, errors = compare(*words)
    assert code == 2 and out == "" and said in errors and len(errors.strip().splitlines()) == 1
    assert list(tmp_path.glob("*.csv")) == []


def test_speech_that_was_not_captured_has_no_capture_to_compare(efase, mouth_database_path, speech_path, tmp_path):
    phones = speech_path.with_suffix(".lab")
    common = ("compare", speech_path, "--phones", phones, "--db", mouth_database_path)
    code, _, errors = efase(*common, "--engines", "captured", "static", "-o", tmp_path / "a.csv")
    assert code == 2 and "was not captured" in errors and not (tmp_path / "a.csv").exists()
    code, out, _ = efase(*common, "--engines", "phone-means", "static", "--json")
    assert code == 0 and json.loads(out)["captured"] is None and len(json.loads(out)["figures"]) == 1
    before = speech_path.read_bytes()
    code, _, errors = efase(*common, "-o", phones.with_suffix(".csv"), "--engines", "static", "x")
    assert code == 2 and speech_path.read_bytes() == before
