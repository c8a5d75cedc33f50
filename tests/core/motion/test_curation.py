"""A database's list of removed nodes, as several windows see it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from core import sqlite_file
from core.errors import UserFacingError
from core.motion.curation import CurationList, Removal, curation_path

REPOSITORY = Path(__file__).resolve().parents[3]


@pytest.fixture
def path(tmp_path):
    return tmp_path / "motion.h5.curation"


def test_nothing_is_removed_before_there_is_a_list(path):
    assert CurationList(path).read() == {}
    assert not path.exists()


def test_every_window_reads_what_the_others_wrote(path):
    one, other = CurationList(path), CurationList(path)
    why = Removal.now("a spike at its end")
    assert one.change({"s1:3": why, "s2:0": why}) == other.read() == {"s1:3": why, "s2:0": why}
    later = Removal("ada", "2026-01-02T03:04:05+00:00", "frozen ✓")
    assert other.change({"s9:1": later}, ["s1:3"]) == one.read() == {"s2:0": why, "s9:1": later}
    one.change({}, ["s2:0", "s9:1", "never:0"])
    assert other.read() == {}


def test_who_when_and_why_are_remembered(path, monkeypatch):
    monkeypatch.setattr("getpass.getuser", lambda: "ada")
    removal = Removal.now("swap")
    assert (removal.who, removal.why) == ("ada", "swap")
    assert removal.at.endswith("+00:00") and len(removal.at) == 25

    def nobody():
        raise KeyError("uid")

    monkeypatch.setattr("getpass.getuser", nobody)
    assert Removal.now("").who == "someone"


def test_the_history_keeps_what_was_restored(path):
    curation = CurationList(path)
    curation.change({"s1:3": Removal("ada", "t", "spike")})
    curation.change({}, ["s1:3"])
    import sqlite3
    from contextlib import closing

    with closing(sqlite3.connect(path)) as connection:
        rows = connection.execute("SELECT node, done, why FROM history ORDER BY id").fetchall()
    assert rows == [("s1:3", "removed", "spike"), ("s1:3", "restored", "")]


def test_the_list_lies_beside_its_database_and_the_demos_in_the_data_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("EFASE_CACHE_DIR", str(tmp_path / "cache"))
    monkeypatch.setenv("EFASE_DATA_DIR", str(tmp_path / "data"))
    mine = SimpleNamespace(path=tmp_path / "mine.h5", name="mine")
    demo = SimpleNamespace(path=tmp_path / "cache" / "demo-1234.h5", name="synthetic actress")
    made_anew = SimpleNamespace(path=tmp_path / "cache" / "demo-5678.h5", name="synthetic actress")
    assert curation_path(mine) == tmp_path / "mine.h5.curation"
    assert (
        curation_path(demo) == curation_path(made_anew) == tmp_path / "data" / "curation" / "synthetic-actress.curation"
    )
    CurationList.of(demo).change({"a:1": Removal.now("x")})
    assert set(CurationList.of(made_anew).read()) == {"a:1"}


@pytest.mark.parametrize("content", [b"nonsense", b"SQLite format 3\0" + bytes(200)])
def test_a_broken_or_foreign_list_is_one_sentence(path, content):
    path.write_bytes(content)
    for act in (CurationList(path).read, lambda: CurationList(path).change({"a:1": Removal("", "", "")})):
        with pytest.raises(UserFacingError, match="curation"):
            act()
    assert path.read_bytes() == content


def test_a_list_that_was_about_to_be_made_is_made(path):
    path.touch()
    assert CurationList(path).read() == {}
    assert set(CurationList(path).change({"a:1": Removal("", "", "")})) == {"a:1"}


def test_a_list_that_cannot_be_written_says_so_and_what_happens_then(path, monkeypatch):
    CurationList(path).change({"a:1": Removal("", "", "")})
    connected = sqlite_file._connected
    monkeypatch.setattr(sqlite_file, "_connected", lambda p, mode, more="": connected(p, "ro", more))
    with pytest.raises(UserFacingError, match="read-only") as refusal:
        CurationList(path).change({"b:2": Removal("", "", "")})
    assert "this project only" in refusal.value.remedy
    assert set(CurationList(path).read()) == {"a:1"}


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere")
def test_a_read_only_folder_is_noticed_before(path):
    path.parent.chmod(0o500)
    try:
        assert not CurationList(path).can_be_written
    finally:
        path.parent.chmod(0o700)


def test_windows_that_write_at_once_lose_nothing(path):
    code = (
        "import sys; from pathlib import Path; from core.motion.curation import *\n"
        "for i in range(20): CurationList(Path(sys.argv[1])).change({f'{sys.argv[2]}:{i}': Removal('', '', '')})"
    )
    windows = [subprocess.Popen([sys.executable, "-c", code, str(path), f"s{k}"], cwd=REPOSITORY) for k in range(3)]
    assert [window.wait(60) for window in windows] == [0, 0, 0]
    assert set(CurationList(path).read()) == {f"s{k}:{i}" for k in range(3) for i in range(20)}
