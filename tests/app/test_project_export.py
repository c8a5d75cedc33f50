"""`efase export` and `efase PROJECT.efase`, where something is wrong."""

from __future__ import annotations

import numpy as np
import pytest

from core.document.content import ProjectContent
from core.document.document import Document
from core.document.edits import SetSpeech
from core.document.parts import DatabaseReference, Speech
from core.document.project_file import ProjectFile, read_project
from core.motion.database import open_database
from core.motion.motion_files import read_motion
from core.rig.control_layer import laid_over
from core.search.compute import NumpyKernels
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.control_edits import NO_CONTROL_EDITS, ControlEdits, ControlKey
from core.synthesis.engine import SpeechInput
from core.synthesis.polish import NO_POLISH
from core.synthesis.registry import make_engine
from tests.core.document.random_edits import made_speech


@pytest.fixture(autouse=True)
def own_data(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))


@pytest.fixture
def project(tmp_path):
    """Return a function that saves a project, with speech and a database if they are asked for."""

    made = []

    def make(
        speaks: bool,
        database: DatabaseReference | None = None,
        engine: str = "search",
        controls: ControlEdits = NO_CONTROL_EDITS,
        holds: bool = False,
        speech: Speech | None = None,
    ):
        made.append(tmp_path / f"project{len(made)}.efase")
        path, document = made[-1], Document()
        if speaks:
            document.apply(SetSpeech.on(document, speech or made_speech(1)))
        document.database_reference, document.engine, document.controls = database, engine, controls
        document.holds = holds
        file = ProjectFile.create(path)
        file.save(ProjectContent.of(document), None if document.speech is None else document.speech.audio)
        file.close()
        return path

    return make


def test_what_is_missing_is_one_sentence_and_nothing_is_written(efase, project, tmp_path):
    out = tmp_path / "a.csv"
    cases = [
        (tmp_path / "none.efase", "There is no eFASE project"),
        (project(False), "has no speech yet"),
        (project(True), "names no motion database"),
        (project(True, DatabaseReference("tiny", "0", str(tmp_path / "gone.h5"))), "gone.h5"),
    ]
    for path, sentence in cases:
        code, _, said = efase("export", path, "-o", out)
        assert code == 2 and sentence in said and len(said.splitlines()) == 1
    assert "--db" in said
    assert not out.exists()


def test_another_database_can_be_named_and_the_difference_is_said(efase, project, tmp_path, database_path):
    path = project(True, DatabaseReference("tiny", "0", str(tmp_path / "gone.h5")))
    code, _, said = efase("export", path, "-o", tmp_path / "a.csv", "--db", database_path)
    assert code == 0 and "is not what it was" in said
    positions, _, rate_hz = read_motion(tmp_path / "a.csv")
    assert positions.shape[1:] == (14, 3) and rate_hz == 30.0
    assert len(positions) == pytest.approx(0.9 * 30, abs=1)


def test_a_project_beside_its_database_finds_it(efase, project, tmp_path, database_path):
    (tmp_path / "tiny.h5").write_bytes(database_path.read_bytes())
    path = project(True, DatabaseReference("tiny", "0", "somewhere/else/tiny.h5"))
    assert efase("export", path, "-o", tmp_path / "a.c3d")[0] == 0


def test_edits_of_the_control_curves_are_in_what_is_exported(efase, project, tmp_path, database_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    edits = NO_CONTROL_EDITS.with_keys("component01", (ControlKey(0.4, 9.0, 0.2),)).muting("component02", True)
    path = project(True, DatabaseReference("tiny", "0", str(database_path)), "animeme", edits)
    assert efase("export", path, "-o", tmp_path / "a.csv")[0] == 0
    positions, _, rate_hz = read_motion(tmp_path / "a.csv")
    database, speech = open_database(database_path), SpeechInput(made_speech(1).transcript)
    motion = make_engine("animeme", database, NumpyKernels()).synthesise(speech).motion
    shown = laid_over(motion, database, edits, NO_POLISH).at_rate(rate_hz, len(positions))
    assert np.allclose(positions, shown.positions, atol=1e-3)
    assert not np.allclose(positions, motion.at_rate(rate_hz, len(positions)).positions, atol=1.0)


def test_long_sounds_are_held_in_what_is_exported(efase, project, tmp_path, database_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    database, made = open_database(database_path), made_speech(1)
    spoken = [PhonemeUtterance(*said) for said in (("m", 0.0, 0.1), ("aa", 0.1, 0.8), ("pau", 0.8, 0.9))]
    transcript = Transcript.covering(spoken, (), 0.9)
    written = {}
    for holds in (False, True):
        path = project(
            True,
            DatabaseReference("tiny", "0", str(database_path)),
            "animeme",
            holds=holds,
            speech=Speech(made.audio, transcript, ""),
        )
        assert efase("export", path, "-o", tmp_path / "a.csv")[0] == 0
        written[holds], _, rate_hz = read_motion(tmp_path / "a.csv")
        motion = (
            make_engine("animeme", database, NumpyKernels()).synthesise(SpeechInput(transcript, holds=holds)).motion
        )
        assert np.allclose(written[holds], motion.at_rate(rate_hz, len(written[holds])).positions, atol=1e-3)
    assert not np.allclose(written[True], written[False], atol=0.1)


def test_a_file_alone_opens_the_window(efase, project, monkeypatch):
    opened = []
    monkeypatch.setattr("app.main.run_window", lambda path=None: opened.append(path) or 0)
    path = project(False)
    assert efase(path)[0] == 0
    assert efase()[0] == 0
    assert opened == [path, None]
    code, _, said = efase("gone.efase")
    assert code == 2 and "There is no file 'gone.efase'" in said
    assert efase("nonsense")[0] == 2


@pytest.mark.parametrize("engine", ["search-single", "search-paper", "phone-means"])
def test_a_project_is_exported_by_the_engine_that_it_chose(efase, project, tmp_path, database_path, engine):
    path = project(True, DatabaseReference("tiny", "0", str(database_path)), engine)
    assert efase("export", path, "-o", tmp_path / "a.csv", "--db", database_path)[0] == 0
    content, audio = read_project(path)
    database = open_database(database_path)
    question = SpeechInput(content.transcript, audio=audio)
    expected = make_engine(engine, database, NumpyKernels()).synthesise(question).motion.positions
    positions, _, _ = read_motion(tmp_path / "a.csv")
    # written at 30 frames a second with four decimals; the tiny database is captured at 60
    assert positions == pytest.approx(expected[::2][: len(positions)], abs=1e-3)


def test_an_engine_that_this_workstation_does_not_have_is_told(efase, project, tmp_path, database_path):
    path = project(True, DatabaseReference("tiny", "0", str(database_path)), "dream")
    code, _, said = efase("export", path, "-o", tmp_path / "a.csv", "--db", database_path)
    assert code == 2 and "no engine 'dream'" in said and not (tmp_path / "a.csv").exists()
