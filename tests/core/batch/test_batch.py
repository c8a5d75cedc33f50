"""A journal keeps what is whole, and workers answer every call once."""

from __future__ import annotations

import time

import pytest

from core.batch.journal import Journal
from core.batch.workers import cores, dask_client, here
from core.errors import UserFacingError


def _squared(n: int) -> int:
    return n * n


def test_a_torn_last_line_is_dropped(tmp_path):
    path = tmp_path / "a" / "journal"
    with Journal(path, "kind 1") as journal:
        journal.add("one", size=1)
        journal.add("two", size=2)
    path.write_bytes(path.read_bytes()[:-5])
    with Journal(path, "kind 1") as journal:
        assert journal.entries == {"one": {"key": "one", "size": 1}}
        journal.add("three", size=3)
    with Journal(path, "kind 1") as journal:
        assert sorted(journal.entries) == ["one", "three"]


def test_a_journal_of_another_kind_is_begun_anew(tmp_path):
    path = tmp_path / "journal"
    path.write_text("my shopping list\nmilk\n")
    with Journal(path, "kind 2") as journal:
        assert journal.entries == {}


def test_a_journal_that_cannot_be_written_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UserFacingError, match="journal"):
        Journal(tmp_path / "file" / "journal", "kind 1")


@pytest.mark.parametrize("n_jobs", [1, 2])
def test_every_call_is_answered_once(n_jobs):
    calls = [(_squared, (n,)) for n in range(7)]
    assert sorted(cores(n_jobs)(calls)) == list(here(calls)) == [n * n for n in range(7)]


def _named_in(folder, n: int) -> int:
    (folder / str(n)).write_text("")
    time.sleep(0.05)
    return n


@pytest.mark.parametrize("times", range(3))
def test_work_left_half_way_begins_nothing_more(tmp_path, times):
    answers = cores(2)([(_named_in, (tmp_path, n)) for n in range(40)])
    next(answers)
    answers.close()
    begun = len(list(tmp_path.iterdir()))
    assert 1 <= begun <= 10
    # the same workers answer the next calls, and the left ones stay left
    assert sorted(cores(2)([(_squared, (n,)) for n in range(4)])) == [0, 1, 4, 9]
    assert len(list(tmp_path.iterdir())) == begun


def _refuses(n: int) -> int:
    raise UserFacingError(f"Number {n} is refused.")


def test_a_call_that_raises_ends_the_work_with_its_error():
    with pytest.raises(UserFacingError, match=r"Number \d+ is refused"):
        list(cores(2)([(_refuses, (n,)) for n in range(20)]))
    assert sorted(cores(2)([(_squared, (n,)) for n in range(3)])) == [0, 1, 4]


def test_a_scheduler_that_is_not_there_is_said():
    with (
        pytest.raises(UserFacingError, match=r"tcp://127\.0\.0\.1:1"),
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.setattr("core.batch.workers._CONNECT_S", 0.5)
        with dask_client("tcp://127.0.0.1:1", "Importing"):
            pass
