"""A face comes back from its file as it was; a file that is no such thing is told in a sentence."""

from __future__ import annotations

import json

import numpy as np
import pytest

from core.errors import UserFacingError
from core.iface.model_file import FaceModel, load_model, save_model
from core.iface.speech_features import N_FEATURES


@pytest.fixture(scope="module")
def models(quick_faces, loud_database):
    names = loud_database.markers.names
    return {v: FaceModel(face, v, names, "loud mouths", "abc", 7) for v, face in quick_faces.items()}


def _changed(path, target, **changes):
    with np.load(path) as kept:
        arrays = dict(kept)
    head = json.loads(str(arrays["head"]))
    head |= changes.pop("head", {})
    np.savez(target, **{**arrays, "head": np.str_(json.dumps(head)), **changes})
    return target


@pytest.mark.parametrize("variant", ["modern", "paper"])
def test_what_is_read_moves_as_what_was_written(models, variant, tmp_path):
    model = models[variant]
    save_model(model, tmp_path / "face.npz")
    read = load_model(tmp_path / "face.npz")
    assert (read.variant, read.database, read.content_hash, read.seed) == (variant, "loud mouths", "abc", 7)
    assert read.markers == model.markers and read.face.expressions == model.face.expressions
    heard = np.random.default_rng(0).normal(8.0, 5.0, (40, N_FEATURES))
    for strengths in ({}, {"anger": 0.6}):
        assert (read.face.motion(heard, strengths) == model.face.motion(heard, strengths)).all()
    np.load(tmp_path / "face.npz", allow_pickle=False)


@pytest.mark.parametrize("variant", ["modern", "paper"])
def test_damage_anywhere_is_one_sentence_or_does_no_harm(models, variant, tmp_path):
    path = tmp_path / "face.npz"
    save_model(models[variant], path)
    whole, rng = path.read_bytes(), np.random.default_rng(1)
    for trial in range(60):
        bytes_ = bytearray(whole)
        if trial % 3 == 0:
            bytes_ = bytes_[: rng.integers(len(bytes_))]
        else:
            for place in rng.integers(len(bytes_), size=1 + trial % 4):
                bytes_[place] = rng.integers(256)
        path.write_bytes(bytes(bytes_))
        try:
            face = load_model(path).face
        except UserFacingError as error:
            assert "face.npz" in error.message
        else:
            assert np.isfinite(face.motion(np.zeros((3, N_FEATURES)), {})).all()


@pytest.mark.parametrize(
    "name", ["neutral", "silence", "units0_units", "units1_mean", "nets0_weights1", "ears0_offsets1"]
)
def test_arrays_that_do_not_belong_together_are_refused(models, name, tmp_path):
    path = tmp_path / "face.npz"
    save_model(models["modern"], path)
    with np.load(path) as kept:
        array = kept[name]
    for wrong in (array[:-1], np.full_like(array, np.nan), np.array("text"), array[None]):
        with pytest.raises(UserFacingError, match="damaged"):
            load_model(_changed(path, tmp_path / "wrong.npz", **{name: wrong}))


@pytest.mark.parametrize(
    ("head", "told"),
    [
        ({"format": "efase-animemes 1"}, "no speaking face"), ({"version": 1}, "another version"),
        ({"window": [3, 9]}, "damaged"), ({"window": [3]}, "damaged"), ({"variant": "other"}, "damaged"),
        ({"expressions": ["anger", "anger"]}, "damaged"), ({"markers": ["a"]}, "damaged"), ({"seed": None}, "damaged"),
        ({"window": [1, 3]}, "damaged"), ({"ears": []}, "damaged"), ({"ears": [["relu", 0]]}, "damaged"),
        ({"nets": []}, "damaged"), ({"nets": [["sine", 3]]}, "damaged"), ({"nets": [["relu", 10**9]]}, "damaged"),
    ],
)  # fmt: skip
def test_a_head_that_lies_is_refused(models, head, told, tmp_path):
    save_model(models["modern"], tmp_path / "face.npz")
    with pytest.raises(UserFacingError, match=told):
        load_model(_changed(tmp_path / "face.npz", tmp_path / "lies.npz", head=head))


@pytest.mark.parametrize("wrong", [lambda a: a[..., None], lambda a: a * np.inf, lambda a: a.astype(complex),
                                   lambda a: np.full(a.shape, 1e300), lambda a: a.astype("S4")])  # fmt: skip
def test_arrays_of_another_kind_are_refused(models, wrong, tmp_path):
    save_model(models["modern"], tmp_path / "face.npz")
    with np.load(tmp_path / "face.npz") as kept:
        offsets = kept["nets0_offsets0"]
    with np.errstate(invalid="ignore"):
        path = _changed(tmp_path / "face.npz", tmp_path / "changed.npz", nets0_offsets0=wrong(offsets))
    with pytest.raises(UserFacingError, match=r"changed\.npz"):
        load_model(path)


@pytest.mark.parametrize("place, bits", [(8, 1), (8, 64), (10, 1), (10, 2), (6, 200)])  # flags, packing, version
def test_an_archive_packed_in_an_unknown_way_is_told(models, place, bits, tmp_path):
    path = tmp_path / "face.npz"
    save_model(models["modern"], path)
    whole = bytearray(path.read_bytes())
    whole[whole.find(b"PK\x01\x02") + place] ^= bits
    path.write_bytes(bytes(whole))
    with pytest.raises(UserFacingError, match=r"face\.npz"):
        load_model(path)


@pytest.mark.parametrize("head", ["[" * 100_000, '{"format": "efase-iface", "version": 1, "axes": 1e999}'])
def test_a_head_without_end_or_bounds_is_told(head, tmp_path):
    np.savez(tmp_path / "face.npz", head=np.str_(head))
    with pytest.raises(UserFacingError, match=r"face\.npz"):
        load_model(tmp_path / "face.npz")


def test_other_files_and_places_are_told(models, tmp_path):
    with pytest.raises(UserFacingError, match="no speaking face at"):
        load_model(tmp_path / "none.npz")
    (tmp_path / "text.npz").write_text("hello")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    np.savez(tmp_path / "pickle.npz", head=np.array([{}], dtype=object))
    for name in ("text.npz", "other.npz", "pickle.npz"):
        with pytest.raises(UserFacingError, match="no file of a speaking face"):
            load_model(tmp_path / name)
    with pytest.raises(UserFacingError, match="cannot be written"):
        save_model(models["modern"], tmp_path / "no folder" / "face.npz")
