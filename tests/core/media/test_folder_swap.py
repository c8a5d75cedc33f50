import os

import pytest

from core.errors import UserFacingError
from core.media.folder_swap import swapped_in_folder
from core.progress import Cancelled


def test_the_folder_is_there_when_all_is_written(tmp_path):
    with swapped_in_folder(tmp_path / "made") as folder:
        (folder / "a").write_text("x")
        assert not (tmp_path / "made").exists()
    assert (tmp_path / "made" / "a").read_text() == "x"
    assert os.listdir(tmp_path) == ["made"]


def test_an_empty_folder_is_filled(tmp_path):
    (tmp_path / "made").mkdir()
    with swapped_in_folder(tmp_path / "made") as folder:
        (folder / "a").write_text("x")
    assert (tmp_path / "made" / "a").exists()


@pytest.mark.parametrize("failure", [Cancelled, KeyboardInterrupt, SystemExit, ValueError])
def test_what_fails_leaves_nothing(tmp_path, failure):
    with pytest.raises(failure), swapped_in_folder(tmp_path / "made") as folder:
        (folder / "deep").mkdir()
        (folder / "deep" / "a").write_text("x")
        raise failure
    assert os.listdir(tmp_path) == []


def test_what_is_there_is_not_touched(tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine").write_text("x")
    (tmp_path / "file").write_text("x")
    for name, sentence in (("full", "is not empty"), ("file", "is not a folder"), ("no/where", "There is no folder")):
        with pytest.raises(UserFacingError, match=sentence), swapped_in_folder(tmp_path / name):
            pytest.fail("it was begun")
    assert sorted(os.listdir(tmp_path)) == ["file", "full"] and (tmp_path / "full" / "mine").exists()
