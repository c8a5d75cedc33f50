"""Outputs are whole or not there."""

from __future__ import annotations

import os

import pytest

from core.errors import UserFacingError
from core.media.swap_in import check_target, swapped_in


def test_a_name_as_long_as_the_system_allows_can_be_written(tmp_path):
    path = tmp_path / ("x" * 251 + ".avi")
    check_target(path)
    with swapped_in(path) as beside:
        beside.write_text("whole")
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_a_failure_leaves_what_was_there(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("before")
    with pytest.raises(ZeroDivisionError), swapped_in(path) as beside:
        beside.write_text("half")
        raise ZeroDivisionError
    assert path.read_text() == "before" and len(list(tmp_path.iterdir())) == 1


def test_targets_that_cannot_be_written_are_found_before_the_work(tmp_path):
    taken = tmp_path / "taken"
    taken.write_text("a file")
    (tmp_path / "folder.avi").mkdir()
    if hasattr(os, "mkfifo"):
        os.mkfifo(tmp_path / "pipe.avi")
        with pytest.raises(UserFacingError, match="is not a file"):
            check_target(tmp_path / "pipe.avi")
    for path, says in (
        (tmp_path / "folder.avi", "is a folder"),
        (tmp_path / "none" / "a.avi", "There is no folder"),
        (taken / "a.avi", "no folder"),
        (tmp_path / ("x" * 300 + ".avi"), "cannot be written"),
    ):
        with pytest.raises(UserFacingError, match=says):
            check_target(path)
    check_target(tmp_path / "none" / "deep" / "a.h5", folders_are_made=True)
    assert not (tmp_path / "none").exists()
