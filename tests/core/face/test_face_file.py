from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.face import Face
from core.face.face_file import read_face, save_face, write_arrays
from core.face.look import Look


def small_face():
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    part = np.array([0, 0, 1, 2], np.uint8)
    uv = np.random.default_rng(0).random((4, 2), np.float32)
    return Face("tiny", positions, triangles, part, uv, {"chin": 2}, {"jawOpen": positions * 2}, "mine, CC0")


def test_what_is_saved_is_read_back(tmp_path):
    face = small_face()
    save_face(face, tmp_path / "new" / "face.npz")
    back = read_face(tmp_path / "new" / "face.npz")
    assert (back.name, back.credit, back.landmarks) == (face.name, face.credit, face.landmarks)
    for name in ("positions", "triangles", "part", "uv"):
        np.testing.assert_array_equal(getattr(back, name), getattr(face, name))
        assert getattr(back, name).dtype == getattr(face, name).dtype
    np.testing.assert_array_equal(back.units["jawOpen"], face.units["jawOpen"])
    assert [p.name for p in (tmp_path / "new").iterdir()] == ["face.npz"]


def test_a_face_without_texture_landmarks_and_units_comes_back_so(tmp_path):
    plain = Face("plain", *(getattr(small_face(), name) for name in ("positions", "triangles", "part")))
    save_face(plain, tmp_path / "f.npz")
    back = read_face(tmp_path / "f.npz")
    assert back.uv is None
    assert not back.landmarks
    assert not back.units


def test_look_and_masks_are_read_back(tmp_path):
    masks = {"hair": np.array([-3, 2, 1, 0], np.float32)}
    face = replace(small_face(), look=Look(skin=(0.1, 0.2, 0.3), hair_mm=4.0), masks=masks)
    save_face(face, tmp_path / "f.npz")
    back = read_face(tmp_path / "f.npz")
    assert back.look == face.look
    np.testing.assert_array_equal(back.masks["hair"], masks["hair"])


@pytest.mark.parametrize("length", [0, 10, 300, -1])
def test_a_truncated_file_is_one_sentence(tmp_path, length):
    path = tmp_path / "f.npz"
    save_face(small_face(), path)
    path.write_bytes(path.read_bytes()[:length])
    with pytest.raises(UserFacingError, match="not a readable face file"):
        read_face(path)


def test_pickles_are_refused(tmp_path):
    path = tmp_path / "f.npz"
    np.savez(path, format=np.int64(1), name=np.array([{"a": 1}], dtype=object))
    with pytest.raises(UserFacingError, match="not a readable face file"):
        read_face(path)


@pytest.mark.parametrize(
    "change",
    [
        {"triangles": np.array([[0, 1, 9]], np.int32)},
        {"part": np.array([0, 0, 0, 77], np.uint8)},
        {"positions": np.full((4, 3), np.nan, np.float32)},
        {"landmark_vertices": np.array([40])},
        {"units": np.zeros((1, 3, 3), np.float32)},
    ],
)
def test_arrays_that_do_not_belong_together_are_refused(tmp_path, change):
    path = tmp_path / "f.npz"
    save_face(small_face(), path)
    with np.load(path) as data:
        arrays = dict(data)
    write_arrays(path, **{**arrays, **change})
    with pytest.raises(UserFacingError, match="damaged"):
        read_face(path)


def test_another_version_says_so(tmp_path):
    path = tmp_path / "f.npz"
    save_face(small_face(), path)
    with np.load(path) as data:
        arrays = dict(data)
    write_arrays(path, **{**arrays, "format": np.int64(99)})
    with pytest.raises(UserFacingError, match="another version"):
        read_face(path)


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "f.npz"
    save_face(small_face(), path)
    before = path.read_bytes()

    class Unwritable:
        def __array__(self, *args, **kwargs):
            raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_arrays(path, positions=Unwritable())
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]
