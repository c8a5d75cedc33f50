"""`efase train iface`, and what is spoken by ear."""

from __future__ import annotations

import json

import numpy as np
import pytest
import soundfile

from core.iface import modern_training, paper_training
from core.iface.model_file import load_model
from core.iface.speech_features import N_FEATURES
from core.motion.build import BuildSettings, build_database
from core.motion.motion_files import read_motion
from core.motion.recording import Recording
from tests.core.iface.quick_training import QUICK_MODERN, QUICK_PAPER


@pytest.fixture(scope="module")
def audible_path(tmp_path_factory, tiny_corpus):
    """The tiny corpus without its sad sentences, with a hum to every other one."""
    folder, corpus = tmp_path_factory.mktemp("audible"), tiny_corpus()
    recordings = []
    for i, r in enumerate(r for r in corpus.recordings if r.emotion != "sadness"):
        times_s = np.arange(round(r.transcript.duration_s * 16_000)) / 16_000
        sound = 0.2 * np.sin(2 * np.pi * (120 + 20 * i) * times_s) * (np.sin(9 * times_s) > 0)
        soundfile.write(folder / f"{r.sentence}.wav", sound, 16_000)
        recordings.append(Recording(**{**vars(r), "audio": folder / f"{r.sentence}.wav"}))
    corpus = corpus.__class__(**{**vars(corpus), "recordings": recordings})
    build_database(corpus, folder / "audible.h5", BuildSettings(rate_hz=60.0))
    return folder / "audible.h5"


@pytest.fixture(autouse=True)
def quick(monkeypatch, settings_folder):
    monkeypatch.setattr(modern_training, "ModernSettings", lambda: QUICK_MODERN)
    monkeypatch.setattr(paper_training, "PaperSettings", lambda: QUICK_PAPER)


@pytest.mark.parametrize("variant", ["modern", "paper"])
def test_a_face_is_trained_written_and_told_and_the_same_seed_gives_the_same(efase, audible_path, tmp_path, variant):
    words = ("train", "iface", "--db", audible_path, "--variant", variant, "--seed", "3")
    faces = []
    for name in ("one.npz", "two.npz"):
        code, out, err = efase(*words, "--out", tmp_path / name, "--json")
        assert code == 0, err
        answer = json.loads(out)
        faces.append(load_model(tmp_path / name).face)
    assert answer["variant"] == variant and answer["seed"] == 3 and answer["look_ahead_ms"] == 100.0
    assert (answer["classes"] is None) == (variant == "modern")
    heard = np.random.default_rng(0).normal(size=(20, N_FEATURES))
    assert (faces[0].motion(heard, {}) == faces[1].motion(heard, {})).all()
    code, out, _ = efase(*words)
    assert code == 0 and f"the {variant} face of" in out and "cache" in out


def test_speech_is_animated_by_ear_without_anybody_asking_for_words(
    efase, audible_path, speech_path, tmp_path, monkeypatch
):
    def no_words(*_):
        raise AssertionError("nobody needs the words")

    monkeypatch.setattr("app.speech._recognised", no_words)
    code, _, err = efase("train", "iface", "--db", audible_path, "-o", tmp_path / "face.npz")
    assert code == 0, err
    words = ("synth", speech_path, "--db", audible_path, "--engine", "iface", "--json")
    code, out, err = efase(*words, "-o", tmp_path / "a.csv", "--emotion", "sadness")
    answer = json.loads(out)
    assert code == 0, err
    assert answer["engine"] == "iface" and answer["text"] == ""
    assert answer["warnings"] == ["The database 'tiny' has no captures of sadness, so it is not shown."]
    positions, _, rate_hz = read_motion(tmp_path / "a.csv")
    assert len(positions) == pytest.approx(soundfile.info(speech_path).duration * rate_hz, abs=1)
    code, _, err = efase(*words, "--model", tmp_path / "face.npz", "-o", tmp_path / "b.csv")
    assert code == 0, err
    np.testing.assert_allclose(read_motion(tmp_path / "b.csv")[0], positions, atol=1e-4)  # seed 0, as the default
    code, _, _ = efase(
        "synth", speech_path, "--db", audible_path, "--engine", "iface", "--phones", speech_path.with_suffix(".lab"),
        "-o", tmp_path / "said.TextGrid",
    )  # fmt: skip
    assert code == 0 and "aa" in (tmp_path / "said.TextGrid").read_text()


def test_what_cannot_be_trained_or_used_is_told_in_a_sentence(
    efase, audible_path, database_path, speech_path, tmp_path
):
    target = tmp_path / "face.npz"
    code, _, err = efase("train", "iface", "--db", audible_path, "--variant", "best", "-o", target)
    assert code == 2 and "no variant 'best'" in err
    code, _, err = efase("train", "iface", "--db", audible_path, "-o", tmp_path / "none" / "face.npz")
    assert code == 2 and "none" in err
    code, _, err = efase("train", "iface", "--db", database_path, "-o", target)
    assert code == 2 and "keeps no sound" in err and not target.exists()
    before = audible_path.read_bytes()
    code, _, err = efase("train", "iface", "--db", audible_path, "-o", audible_path)
    assert code == 2 and "end in .npz" in err and audible_path.read_bytes() == before
    target.write_text("no face")
    for engine, told in (("iface", "no file of a speaking face"), ("animeme", "takes no trained face")):
        code, _, err = efase(
            "synth", speech_path, "--db", audible_path, "--engine", engine, "--model", target, "-o", tmp_path / "c.csv"
        )
        assert code == 2 and told in err and not (tmp_path / "c.csv").exists()
