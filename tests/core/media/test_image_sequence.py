"""Numbered pictures come back bit by bit, and a failed run leaves none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from core.errors import UserFacingError
from core.media.image_sequence import numbered, write_images
from core.media.picture import read_picture

PICTURES = np.random.default_rng(8).integers(0, 256, (5, 33, 47, 3), dtype=np.uint8)


@pytest.mark.parametrize(("name", "expected"), [
    ("shot.png", "shot.0007.png"), ("shot.###.png", "shot.007.png"), ("shot_%05d.png", "shot_00007.png"),
    ("%d.png", "7.png"), ("####.png", "0007.png"),
])  # fmt: skip
def test_numbers_stand_where_the_name_says(name, expected):
    assert numbered(Path(name), 7) == Path(expected)


def test_pictures_come_back_as_they_were(tmp_path):
    written = write_images(tmp_path / "p.##.png", PICTURES, len(PICTURES), first_number=98)
    assert [path.name for path in written] == ["p.98.png", "p.99.png", "p.100.png", "p.101.png", "p.102.png"]
    for path, picture in zip(written, PICTURES):
        assert np.array_equal(read_picture(path), picture)


def test_a_run_that_fails_leaves_nothing_and_what_was_there_before_stays(tmp_path):
    (tmp_path / "p.0009.png").write_bytes(b"mine")

    def breaks_off():
        yield from PICTURES[:3]
        raise RuntimeError

    with pytest.raises(RuntimeError):
        write_images(tmp_path / "p.png", breaks_off(), 5)
    assert [path.name for path in tmp_path.iterdir()] == ["p.0009.png"]


def test_a_missing_folder_is_said_before_anything_is_drawn(tmp_path):
    def never():
        raise AssertionError("drawn in vain")
        yield

    with pytest.raises(UserFacingError, match="no folder"):
        write_images(tmp_path / "no" / "p.png", never(), 1)
