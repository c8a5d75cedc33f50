import numpy as np
import pytest

from core.face.skin_cache import cached_skin, skin_path
from core.face.skinning import MarkerSkin


@pytest.fixture(autouse=True)
def own_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    return tmp_path / "cache"


def refuse(*_args, **_kwargs):
    raise AssertionError("fitted again")


def test_the_second_time_it_is_read_and_deforms_alike(face, actress, monkeypatch):
    marker_set, vertices = actress
    first = cached_skin(face, vertices, marker_set)
    monkeypatch.setattr(MarkerSkin, "fit", refuse)
    second = cached_skin(face, vertices, marker_set)
    motion = face.units["jawOpen"][vertices]
    np.testing.assert_array_equal(first.deform(motion), second.deform(motion))


def test_anything_that_matters_makes_another_file(face, actress):
    marker_set, vertices = actress
    path = skin_path(face, vertices, marker_set, 0.5, 3.0)
    assert skin_path(face, vertices, marker_set, 0.5, 3.0) == path
    assert skin_path(face, vertices, marker_set, 0.6, 3.0) != path
    assert skin_path(face, vertices[::-1], marker_set, 0.5, 3.0) != path
    moved = type(face)(**{**vars(face), "positions": face.positions + np.float32(1)})
    assert skin_path(moved, vertices, marker_set, 0.5, 3.0) != path


@pytest.mark.parametrize("damage", [b"", b"PK\x03\x04 rubbish", None])
def test_a_damaged_file_is_made_again(face, actress, damage):
    marker_set, vertices = actress
    cached_skin(face, vertices, marker_set)
    (path,) = skin_path(face, vertices, marker_set, 0.45, 3.0).parent.iterdir()
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2] if damage is None else damage)
    again = cached_skin(face, vertices, marker_set)
    assert again.weights.shape == (len(face.positions), len(marker_set))
    assert path.read_bytes()[:2] == b"PK"
    assert [p.name for p in path.parent.iterdir()] == [path.name]


def test_a_cache_that_cannot_be_written_only_costs_time(face, actress, own_cache):
    marker_set, vertices = actress
    own_cache.write_text("a file where the folder should be")
    assert cached_skin(face, vertices, marker_set).weights.nnz > 0
