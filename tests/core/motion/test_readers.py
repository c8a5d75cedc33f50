"""Tracked points of video, laid out like GRID: real ones, and damaged ones."""

import shutil

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.build import build_database
from core.motion.readers.corpus_folder import read_corpus


@pytest.fixture
def small_grid(shared_data, tmp_path):
    """The first four clips of GRID in a folder of their own."""
    source = shared_data("grid-s1")
    folder = tmp_path / "grid"
    for name in ("audio", "textgrid"):
        (folder / name).mkdir(parents=True)
    with np.load(source / "tracks.npz") as archive:
        arrays = dict(archive)
    clips, start = arrays["clips"][:4], arrays["start"][:5]
    np.savez(folder / "tracks.npz", **{**arrays, "clips": clips, "start": start, "xyz64": arrays["xyz64"][: start[-1]]})
    for clip in clips:
        shutil.copy(source / "audio" / f"{clip}.flac", folder / "audio")
        shutil.copy(source / "textgrid" / f"{clip}.TextGrid", folder / "textgrid")
    return folder


def test_grid_clips_become_a_stabilised_database(small_grid, tmp_path):
    corpus = read_corpus(small_grid)
    assert [r.positions.shape[0] for r in corpus.recordings] == [75] * 4
    database = build_database(corpus, tmp_path / "grid.h5")
    rest = database.markers.rest
    left, right = (rest[database.markers.landmark(name)] for name in ("outer_eye_left", "outer_eye_right"))
    assert np.linalg.norm(left - right) == pytest.approx(90.0)
    assert left[0] > right[0], "x points to the actor's left"
    chin, nose = (rest[database.markers.landmark(name)] for name in ("chin", "nose_tip"))
    assert nose[1] > chin[1], "y points up"
    assert nose[2] > (left[2] + right[2]) / 2, "z points to the camera"
    face = database.pca.positions(database.frames[::10])
    rigid = database.markers.group("rigid")
    moved = np.linalg.norm(face[:, rigid] - rest[rigid], axis=2)
    assert np.median(moved) < 0.6, "forehead and temples stand still"
    lips = [database.markers.names.index(name) for name in ("MP013", "MP014")]
    gap = face[:, lips[0], 1] - face[:, lips[1], 1]
    assert 5 < gap.max() - gap.min() < 25
    assert {u.emotion for u in database.sentences} == {"neutral"}


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda f: (f / "tracks.npz").write_bytes(b""), "no readable archive"),
        (lambda f: (f / "tracks.npz").write_bytes((f / "tracks.npz").read_bytes()[:5000]), "no readable archive"),
        (lambda f: np.savez(f / "tracks.npz", xyz64=np.zeros((3, 2, 3), np.int16)), "has no array 'start'"),
        (lambda f: alter(f, start=np.array([0, 5, 4, 9, 10])), "do not fit"),
        (lambda f: alter(f, fps=np.array(-1.0)), "frames a second"),
        (lambda f: alter(f, clips=np.array([None] * 4, object)), "no readable archive"),
        (lambda f: shutil.rmtree(f / "audio"), ".flac"),
        (lambda f: shutil.rmtree(f / "textgrid"), ".TextGrid"),
    ],
)
def test_damaged_track_folders_are_one_sentence(small_grid, damage, words):
    damage(small_grid)
    with pytest.raises(UserFacingError, match=words):
        read_corpus(small_grid)


def alter(folder, **changes):
    with np.load(folder / "tracks.npz") as archive:
        arrays = {**archive, **changes}
    np.savez(folder / "tracks.npz", allow_pickle=True, **arrays)


def test_a_folder_that_is_no_corpus_is_refused(tmp_path):
    with pytest.raises(UserFacingError, match=r"no corpus\.csv"):
        read_corpus(tmp_path)
    with pytest.raises(UserFacingError, match="no corpus folder"):
        read_corpus(tmp_path / "missing")
