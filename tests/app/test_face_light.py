"""The light of a face is worked out once, and a cache that is damaged is as good as none."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from app.face_light import FaceLight, light_path


@dataclass(frozen=True)
class Shape:
    """As much of a face as its light depends on."""

    positions: np.ndarray
    triangles: np.ndarray
    part: np.ndarray


def shape(seed: int) -> Shape:
    rng = np.random.default_rng(seed)
    return Shape(rng.normal(size=(9, 3)), rng.integers(0, 9, (4, 3)), np.zeros(9, int))


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path))


def test_another_start_finds_the_light_of_that_face_and_of_no_other():
    face, light = shape(0), np.linspace(0, 1, 9, dtype=np.float32)
    FaceLight().keep(face, light)
    assert FaceLight().of(shape(0)).tolist() == light.tolist()
    assert FaceLight().of(shape(1)) is None


@pytest.mark.parametrize("damage", [b"", b"no array", "short", "beyond"])
def test_a_damaged_cache_is_as_good_as_none(damage):
    face = shape(0)
    FaceLight().keep(face, np.zeros(9, np.float32))
    path = light_path(face)
    if isinstance(damage, bytes):
        path.write_bytes(damage)
    else:
        np.save(path, np.zeros(8, np.float32) if damage == "short" else np.full(9, 2.0, np.float32))
    assert FaceLight().of(shape(0)) is None
