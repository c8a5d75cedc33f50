"""Held-out sentences leave no trace in the database but their recordings, which come back as they were captured."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace

import h5py
import numpy as np
import pytest
import soundfile

from core.errors import UserFacingError
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.database import open_database
from core.motion.recording import Recording
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

NAMES = tuple("abcde")
SETTINGS = BuildSettings(n_dims=3)


def recording(s, rate_hz=60.0):
    rng = np.random.default_rng(s)
    positions = np.random.default_rng(99).normal(size=(1, 5, 3)) * 40 + rng.normal(size=(30, 5, 3))
    phones = ("pau", "n", "ow", "b", "pau")
    spoken = tuple(PhonemeUtterance(p, 0.1 * i, 0.1 * i + 0.1) for i, p in enumerate(phones))
    transcript = Transcript(spoken, (WordUtterance("nob", 0.1, 0.4),), 0.5)
    return Recording(f"s{s}", "anger" if s % 2 else "neutral", positions.astype(np.float32), NAMES, rate_hz, transcript,
                     f"nob {s}")  # fmt: skip


@pytest.fixture(scope="module")
def corpus(tmp_path_factory):
    path = tmp_path_factory.mktemp("sound") / "hum.wav"
    soundfile.write(path, 0.1 * np.sin(np.arange(8000) / 9), 16_000)
    recordings = [recording(s, 30.0 if s == 5 else 60.0) for s in range(6)]
    recordings[4].positions[3:5, 1] = np.nan
    recordings[4] = replace(recordings[4], audio=path)
    held_out = {"tune": ("s4",), "test": ("s5", "s2")}
    return Corpus("small", recordings, ("c", "a", "b", "e"), held_out=held_out, with_scale=True)


@pytest.fixture(scope="module")
def database(corpus, tmp_path_factory):
    path = tmp_path_factory.mktemp("database") / "small.h5"
    build_database(corpus, path, SETTINGS)
    return open_database(path)


def test_a_database_is_the_same_as_one_that_never_met_the_held_out_sentences(corpus, database, tmp_path):
    apart = {"s2", "s4", "s5"}
    fewer = replace(corpus, recordings=[r for r in corpus.recordings if r.sentence not in apart], held_out={})
    other = build_database(fewer, tmp_path / "fewer.h5", SETTINGS)
    assert other.content_hash == database.content_hash
    assert other.weights == database.weights
    assert other.maps.keys() == database.maps.keys()
    for phone, phoneme_map in other.maps.items():
        assert np.array_equal(phoneme_map.embedding, database.maps[phone].embedding)
    assert {s.name for s in database.sentences} == {"s0", "s1", "s3"}
    assert np.array_equal(other.markers.rest, database.markers.rest)
    assert database.summary()["held_out"] == {"tune": 1, "test": 2}


def test_the_recordings_come_back_as_captured(corpus, database):
    columns = [NAMES.index(name) for name in corpus.kept_markers]
    by_name = {r.sentence: r for r in corpus.recordings}
    for split, names in corpus.held_out.items():
        again = database.held_out_recordings(split)
        assert [r.sentence for r in again] == list(names)
        for back in again:
            given = by_name[back.sentence]
            assert np.array_equal(back.positions, given.positions[:, columns], equal_nan=True)
            assert back.marker_names == corpus.kept_markers
            assert (back.rate_hz, back.emotion, back.text) == (given.rate_hz, given.emotion, given.text)
            assert back.transcript == given.transcript
    assert database.with_scale is True
    assert len(database.audio_bytes("s4")) > 100 and database.audio_bytes("s5") is None


def test_the_fold_that_was_never_held_out_is_one_sentence(corpus, database, tmp_path):
    for of in (database, build_database(replace(corpus, held_out={}), tmp_path / "all.h5", SETTINGS)):
        with pytest.raises(UserFacingError, match="holds out no sentences for 'verify'") as failure:
            of.held_out_recordings("verify")
        assert "--hold-out" in failure.value.remedy


def test_impossible_holdings_are_refused(corpus, tmp_path):
    everything = {"test": tuple(r.sentence for r in corpus.recordings)}
    for held_out, says in (({"test": ("s9",)}, "no sentence 's9' to hold out"), (everything, "nothing is left")):
        with pytest.raises(UserFacingError, match=says):
            build_database(replace(corpus, held_out=held_out), tmp_path / "x.h5", SETTINGS)
    assert not list(tmp_path.iterdir())


def test_a_file_of_before_still_opens(database, tmp_path):
    path = tmp_path / "older.h5"
    shutil.copy(database.path, path)
    with h5py.File(path, "r+") as file:
        del file["held_out"], file.attrs["with_scale"]
        file.attrs.update(version_minor=0, held_out="{}")
    older = open_database(path)
    assert older.content_hash == database.content_hash
    assert (older.with_scale, older.held_out) == (False, {})


@pytest.fixture
def altered(database, tmp_path):
    """Return a function that says whether a copy is refused after a change, on opening or on reading what it holds."""

    def refused(change):
        path = tmp_path / "altered.h5"
        shutil.copy(database.path, path)
        with h5py.File(path, "r+") as file:
            change(file)
        try:
            copy = open_database(path)
            for split in copy.held_out:
                copy.held_out_recordings(split)
        except UserFacingError as error:
            assert str(path) in str(error) and "\n" not in str(error)
            return True
        return False

    return refused


def replaced(name, value):
    def change(file):
        del file[name]
        file[name] = value

    return change


def test_hostile_recordings_are_refused(database, altered):
    with h5py.File(database.path) as file:
        positions, rates_hz = file["held_out/positions"][()], file["held_out/rates_hz"][()]
        sentences = json.loads(file["held_out/sentences"][()])
    far, endless = positions.copy(), positions.copy()
    far[0, 0, 0], endless[0, 0, 0] = 3e38, np.inf
    links = (h5py.SoftLink("/frames/coefficients"), h5py.ExternalLink("other.h5", "/x"), h5py.Empty("f4"))
    for value in (far, endless, positions[:, :3], positions[:50], positions.astype(float), positions.ravel(), *links):
        assert altered(replaced("held_out/positions", value)), value
    for value in (rates_hz[:1], rates_hz * 0, rates_hz * np.nan, rates_hz.astype("f4"), 60.0):
        assert altered(replaced("held_out/rates_hz", value)), value
    for wrong in ({"name": "s9"}, {"name": "s5"}, {"name": None}, {"frames": [-1, 4]}, {"frames": [0, 10**9]},
                  {"emotion": "rage"}, {"phonemes": [["zz", 0, 1]]}, {"duration_s": None}):  # fmt: skip
        entries = [{**sentences[0], **wrong}, *sentences[1:]]
        assert altered(replaced("held_out/sentences", json.dumps(entries))), wrong
    for text in ("", "{}", "[" * 100_000, b"\xff"):
        assert altered(replaced("held_out/sentences", text)), text[:5]
    for text in ("5", "[]", '{"test": 5}', '{"test": [5]}', '{"test": ["s9"]}'):
        assert altered(lambda file, text=text: file.attrs.__setitem__("held_out", text)), text
    assert altered(lambda file: file.__delitem__("held_out"))
    assert not altered(lambda file: None)


def test_promised_terabytes_are_not_read(altered):
    def promise(file):
        del file["held_out/positions"]
        file.create_dataset("held_out/positions", shape=(10**12, 4, 3), dtype="f4", chunks=(1000, 4, 3))

    assert altered(promise)


def test_a_hundred_damaged_files_give_their_recordings_or_are_refused(database, survives_damage):
    def read(path):
        opened = open_database(path)
        for split in opened.held_out:
            for back in opened.held_out_recordings(split) if opened.held_out[split] else ():
                assert not np.isinf(back.positions).any()

    assert survives_damage(database.path, read, 100) > 30
