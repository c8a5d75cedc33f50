"""`efase db` as a user meets it."""

import json

import pytest

from core.motion.build import BuildSettings, build_database
from core.motion.curation import CurationList, Removal
from core.motion.database import open_database
from core.motion.database_lock import DatabaseLock
from tests.core.motion.growing import corpus_of

SETTINGS = BuildSettings(n_dims=6)


@pytest.fixture
def path(tmp_path):
    build_database(corpus_of(0, 1, held_out=(5,)), tmp_path / "db.h5", SETTINGS)
    return tmp_path / "db.h5"


def answered(efase, *words):
    code, out, err = efase("db", *words, "--json")
    assert (code, err) == (0, "")
    return json.loads(out)


def test_add_remove_and_compact(efase, path, tmp_path):
    build_database(corpus_of(2), tmp_path / "more.h5", SETTINGS)
    answer = answered(efase, "add", path, tmp_path / "more.h5")
    assert answer["added"] == ["s2"] and answer["sentences"] == 3
    assert answer["content_hash"] == open_database(path).content_hash != answer["content_before"]
    assert answered(efase, "remove", path, "s2", "s5")["removed"] == ["s2", "s5"]
    database = open_database(path)
    CurationList.of(database).change({database.nodes.name(0): Removal.now("")})
    assert answered(efase, "compact", path, "--drop-removed")["nodes"] == len(database.nodes) - 1


def test_merge_and_list(efase, path, tmp_path):
    answer = answered(efase, "merge", path, path, "-o", tmp_path / "c.h5", "--prefix", "again-")
    assert answer["added"] == ["again-s0", "again-s1"]
    listed = answered(efase, "list", tmp_path / "c.h5")
    assert [row["name"] for row in listed["sentences"]] == ["s0", "s1", "again-s0", "again-s1"]
    assert listed["held_out"] == {"s5": "test", "again-s5": "test"}
    code, out, _ = efase("db", "list", tmp_path / "c.h5")
    assert code == 0 and len(out.splitlines()) == 6


def test_in_words(efase, path, tmp_path):
    build_database(corpus_of(2), tmp_path / "more.h5", SETTINGS)
    code, out, err = efase("db", "add", path, tmp_path / "more.h5")
    assert code == 0 and "1 added" in out and "cover" in out and err == ""


def test_failures_are_one_sentence(efase, path, tmp_path):
    with DatabaseLock(path):
        code, out, err = efase("db", "remove", path, "s0")
    assert (code, out) == (2, "") and "open for writing elsewhere" in err and len(err.splitlines()) == 1
    code, out, err = efase("db", "add", path, tmp_path / "nowhere")
    assert (code, out) == (2, "") and len(err.splitlines()) == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["db.h5"]
