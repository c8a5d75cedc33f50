"""A database from anywhere opens whole, or is refused in one sentence; what opens can be searched."""

from __future__ import annotations

import copy
import json
import shutil
import subprocess
import sys

import h5py
import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.database import open_database
from core.motion.recording import Recording
from core.search.compute import NumpyKernels
from core.search.engine import SearchEngine
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.engine import SpeechInput

SPEECH = Transcript.covering(
    [PhonemeUtterance(p, 0.1 * i, 0.1 * i + 0.1) for i, p in enumerate(("n", "ow", "zh"))], [], 0.5
)


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A small database that nothing is wrong with."""
    rng = np.random.default_rng(0)
    rest = rng.normal(size=(1, 4, 3)) * 40
    spoken = [PhonemeUtterance(p, 0.1 * i, 0.1 * i + 0.1) for i, p in enumerate(("pau", "n", "ow", "b", "pau"))]
    transcript = Transcript(tuple(spoken), (), 0.5)
    recordings = [
        Recording(f"s{s}", "neutral", (rest + rng.normal(size=(30, 4, 3))).astype(np.float32), tuple("abcd"), 60.0,
                  transcript)
        for s in range(2)
    ]  # fmt: skip
    path = tmp_path_factory.mktemp("database") / "sound.h5"
    build_database(Corpus("small", recordings, tuple("abcd")), path, BuildSettings(n_dims=3))
    return path


@pytest.fixture
def altered(sound, tmp_path):
    """Return a function that opens a copy after a change of the file; None is a refusal."""

    def opened(change):
        path = tmp_path / "altered.h5"
        shutil.copy(sound, path)
        with h5py.File(path, "r+") as file:
            change(file)
        try:
            return open_database(path)
        except UserFacingError as error:
            assert str(path) in str(error) and "\n" not in str(error)
            return None

    return opened


def numbers(path):
    with h5py.File(path) as file:
        found = {}
        file.visititems(lambda name, at: found.update({name: at[()]}) if isinstance(at, h5py.Dataset) else None)
    del found["sentences"]
    return found


def replaced(name, value):
    def change(file):
        del file[name]
        file[name] = value

    return change


def test_another_type_shape_or_size_of_any_dataset_is_refused(sound, altered):
    for name, array in numbers(sound).items():
        if name.endswith("triangles"):
            continue  # a map may have none, or some more
        for value in (array.ravel()[:1].sum(), array[None], np.concatenate([array, array]), array.astype(complex),
                      np.full(array.shape, b"x"), h5py.Empty("f4"), h5py.SoftLink(f"/{name}"), array[:0],
                      h5py.ExternalLink("other.h5", "/x")):  # fmt: skip
            assert altered(replaced(name, value)) is None, (name, value)
        assert altered(lambda file, name=name: file.__delitem__(name)) is None


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 3e38])
def test_numbers_that_are_no_motion_are_refused(sound, altered, value):
    for name, array in numbers(sound).items():
        if array.dtype.kind == "f" and (np.abs(value) != 3e38 or not name.startswith(("maps", "pca/variance"))):
            hurt = array.copy()
            with np.errstate(over="ignore"):
                hurt.flat[-1] = value
            assert altered(replaced(name, hurt)) is None, name


def test_indices_that_point_beyond_are_refused(sound, altered):
    for name, array in numbers(sound).items():
        if name.startswith("nodes/") or name.endswith(("/frames", "triangles")):
            for value in {np.iinfo(array.dtype).max, np.iinfo(array.dtype).min} - {0}:
                hurt = array.copy()
                hurt.flat[-1] = value
                if name != "nodes/order" or value < 0:
                    assert altered(replaced(name, hurt)) is None, (name, value)


@pytest.mark.parametrize(
    "name", ["frames/coefficients", "markers/rest", "nodes/start", "maps/n/embedding", "sentences"]
)
def test_promised_terabytes_and_foreign_bytes_are_not_read(altered, name):
    def promise(file):
        del file[name]
        file.create_dataset(name, shape=(10**12, 3), dtype="f4", chunks=(1000, 3))

    def bomb(file):
        del file[name]
        file.create_dataset(name, data=np.zeros((1_000_000, 3), "f4"), compression="gzip")

    def outside(file):
        del file[name]
        file.create_dataset(name, shape=(4, 3), dtype="f8", external=[("/dev/zero", 0, h5py.h5f.UNLIMITED)])

    assert [altered(change) for change in (promise, bomb, outside)] == [None] * 3


def test_sentences_that_make_no_sense_are_refused(sound, altered):
    with h5py.File(sound) as file:
        whole = json.loads(file["sentences"][()])
    for wrong in (
        {"name": None}, {"name": "s1"}, {"emotion": "rage"}, {"emotion": []}, {"frames": [0]}, {"frames": ["a", "b"]},
        {"frames": [-5, 10**30]}, {"duration_s": "x"}, {"duration_s": float("nan")}, {"phonemes": [["zz", 0, 1]]},
        {"phonemes": [[1]]}, {"phonemes": [["n", None, 0]]},
    ):  # fmt: skip
        entries = copy.deepcopy(whole)
        entries[0].update(wrong)
        assert altered(replaced("sentences", json.dumps(entries))) is None, wrong
    for text in ("[" * 100_000, "", "{}", "[1]", b"\xff\xfe"):
        assert altered(replaced("sentences", text)) is None, text[:5]


def test_attributes_that_make_no_sense_are_refused(altered):
    for name, value in (
        ("rate_hz", np.nan), ("rate_hz", 0.0), ("rate_hz", "x"), ("weights", "{"), ("weights", '{"pnt": -1}'),
        ("weights", '{"pnt": NaN}'), ("weights", "[" * 100_000), ("held_out", "5"), ("report", '{"a": NaN}'),
        ("version_major", np.inf), ("format", b"\xff"),
    ):  # fmt: skip
        assert altered(lambda file, name=name, value=value: file.attrs.__setitem__(name, value)) is None, (name, value)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows limits no file")
def test_a_disk_that_fills_up_is_one_sentence_and_leaves_nothing(sound, tmp_path):
    database, target = open_database(sound), tmp_path / "full.h5"
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (5000, 5000))\n"
        "import sys; from pathlib import Path; from core.media.swap_in import swapped_in\n"
        "from core.motion.database import open_database, write_database\n"
        "with swapped_in(sys.argv[2]) as beside: write_database(open_database(Path(sys.argv[1])), beside, {})\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(database.path), str(target)], capture_output=True, text=True)
    assert done.returncode == 1
    assert "UserFacingError" in done.stderr.strip().splitlines()[-1] and "File too large" in done.stderr
    assert list(tmp_path.iterdir()) == []


def search(path):
    database = open_database(path)
    json.dumps(database.summary(), allow_nan=False)
    motion = SearchEngine(database, NumpyKernels()).synthesise(SpeechInput(SPEECH)).motion
    assert np.isfinite(motion.positions).all()


def test_a_hundred_damaged_files_open_and_search_or_are_refused(sound, survives_damage):
    assert survives_damage(sound, search, 100) > 50


@pytest.mark.prove
def test_thousands_of_damaged_files_open_and_search_or_are_refused(sound, survives_damage):
    assert survives_damage(sound, search, 4000) > 2000
