"""From a film to a database: efase track writes what efase import takes in, and says in one sentence what it cannot."""

import json

import numpy as np
import pytest

from core.media.audio import Audio
from core.motion.build import BuildSettings, build_database
from core.motion.corpus import Corpus
from core.motion.database import open_database
from core.motion.recording import Recording
from core.speech.transcript import PhonemeUtterance, Transcript
from core.tracking.face_model import FaceModel
from tests.core.tracking.bent_sheet import bent_markers, clicks_on, film_of, sheet_markers, speaking_sheet

PHONES = ("m", "aa", "iy", "w", "ah", "b")


def _recording(s: int) -> Recording:
    chance = np.random.default_rng(s)
    phones = [PHONES[i] for i in chance.permutation(6)]
    spoken = [PhonemeUtterance("pau", 0.0, 0.1)]
    spoken += [PhonemeUtterance(p, 0.1 + 0.1 * i, 0.2 + 0.1 * i) for i, p in enumerate(phones)]
    spoken.append(PhonemeUtterance("pau", 0.7, 0.8))
    t = np.arange(48)[:, None] / 60.0
    parameters = 5.0 * np.sin(2 * np.pi * (t * chance.uniform(0.8, 2.0, 3) + chance.uniform(size=3))) * (t > 0.1)
    markers = sheet_markers()
    positions = (markers.rest + bent_markers(parameters)).astype(np.float32)
    return Recording(f"s{s}", "neutral", positions, markers.names, 60.0, Transcript.covering(spoken, [], 0.8), "")


@pytest.fixture(scope="module")
def sheet_database(tmp_path_factory):
    path = tmp_path_factory.mktemp("sheet") / "sheet.h5"
    markers = sheet_markers()
    groups = {"upper_lip": ("upper_lip",), "lower_lip": ("lower_lip",), "lips": ("upper_lip", "lower_lip")}
    corpus = Corpus("sheet", [_recording(s) for s in range(8)], markers.names, groups, markers.landmarks, markers.rest)
    build_database(corpus, path, BuildSettings(rate_hz=60.0))
    return path


@pytest.fixture(scope="module")
def model(sheet_database):
    return FaceModel.of_database(open_database(sheet_database))


@pytest.fixture(scope="module")
def take(tmp_path_factory):
    """A film of the sheet with a hum, and what is said in it."""
    folder = tmp_path_factory.mktemp("take")
    hum = Audio((0.3 * np.sin(2 * np.pi * 140 * np.arange(15_360) / 16_000)).astype(np.float32), 16_000)
    film_of(speaking_sheet(noise=3.0), folder / "take.mp4", hum)
    lines = ["0.0 0.1 pau", *(f"{0.1 + 0.12 * i:.2f} {0.22 + 0.12 * i:.2f} {p}" for i, p in enumerate(PHONES)),
             "0.82 0.96 pau"]  # fmt: skip
    (folder / "capture.lab").write_text("\n".join(lines) + "\n")
    return folder


def _points(model):
    return ";".join(f"{x:.2f},{y:.2f}" for x, y in clicks_on(model).values())


def test_a_tracked_film_becomes_a_database(efase, settings_folder, take, sheet_database, model):
    capture = take / "capture.c3d"
    code, out, err = efase("track", take / "take.mp4", "--points", _points(model), "--db", sheet_database,
                           "--out", capture, "--json")  # fmt: skip
    assert (code, err) == (0, "")
    answer = json.loads(out)
    assert answer["outputs"] == [str(capture), str(take / "capture.wav")]
    assert (answer["frames"], answer["points"], answer["rate_hz"], answer["lost"]) == (24, 40, 25.0, 0)
    assert answer["trust"] > 0.7

    files = [capture, take / "capture.wav", take / "capture.lab"]
    code, out, err = efase("import", *files, "--markers-like", sheet_database, "-o", take / "own.h5", "--json")
    assert code == 0, err
    assert not json.loads(out)["failed"]
    made = open_database(take / "own.h5")
    assert made.markers.names == sheet_markers().names
    assert len(made.nodes) == len(PHONES)

    # the lips open as they did before the camera
    positions = made.pca.positions(made.frames.astype(float))
    upper, lower = (made.markers.names.index(name) for name in ("upper_lip", "lower_lip"))
    gap = positions[:, upper, 1] - positions[:, lower, 1]
    sheet = speaking_sheet()
    true = bent_markers(sheet.parameters)
    true_gap = np.interp(np.arange(len(gap)) / made.rate_hz, np.arange(24) / 25.0,
                         true[:, upper, 1] - true[:, lower, 1])  # fmt: skip
    inner = slice(12, -12)  # the ends of a resampled take are bent
    assert np.corrcoef(gap[inner], true_gap[inner])[0, 1] > 0.97


def test_saved_clicks_do_as_well(efase, settings_folder, take, sheet_database, model, tmp_path):
    from core.tracking.start_file import TrackingStart, write_start

    write_start(TrackingStart(clicks_on(model), {5: {"m3": (150.0, 100.0)}}), tmp_path / "start.json")
    code, out, _ = efase("track", take / "take.mp4", "--start", tmp_path / "start.json", "--db", sheet_database,
                         "-o", tmp_path / "points.csv")  # fmt: skip
    assert code == 0
    assert "24 frames of 40 points" in out


@pytest.mark.parametrize(
    ("words", "why"),
    [(["--points", "a,b"], "no points"), (["--points", "1,2;3,4;5,6"], "2 or 4 points"),
     (["--points", "1,2;3,nan"], "no points"), ([], "--points or --start"),
     (["--points", "10,10;900,10"], "outside"), (["--start", "none.json"], "none.json"),
     (["--points", "130,150;190,150", "--expression", "joy"], "'joy'")],
)  # fmt: skip
def test_what_cannot_be_tracked_is_one_sentence(efase, settings_folder, take, sheet_database, tmp_path, words, why):
    code, out, err = efase("track", take / "take.mp4", *words, "--db", sheet_database, "-o", tmp_path / "x.c3d")
    assert (code, out) == (2, "")
    assert why in err
    assert len(err.strip().splitlines()) == 1
    assert not (tmp_path / "x.c3d").exists()


def test_a_database_without_mouth_corners_is_told(efase, settings_folder, take, database_path, tmp_path):
    code, _, err = efase("track", take / "take.mp4", "--points", "1,2;30,4", "--db", database_path,
                         "-o", tmp_path / "x.c3d")  # fmt: skip
    assert code == 2
    assert "mouth corner right" in err
