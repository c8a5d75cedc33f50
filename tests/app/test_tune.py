"""`efase tune` from the command line: what it stores, forgets, and refuses."""

from __future__ import annotations

import json
import shutil

import pytest

from core.motion.build import BuildSettings, build_database
from core.motion.database import open_database
from core.search.weight_files import read_weights


@pytest.fixture
def own_database(tmp_path, database_path):
    """A copy of a database that holds nothing out."""
    return shutil.copy(database_path, tmp_path / "own.h5")


@pytest.fixture
def held_out(tmp_path, tiny_corpus):
    path = tmp_path / "tunable.h5"
    build_database(tiny_corpus({"tune": ("s6", "s7")}), path, BuildSettings(rate_hz=60.0))
    return path


def test_tuning_is_stored_shown_used_and_forgotten(efase, held_out, speech_path, tmp_path, settings_folder):
    before = open_database(held_out)
    file = tmp_path / "weights.json"
    words = ["tune", "--db", held_out, "--starts", "3", "--jobs", "1", "-o", file, "--json"]
    code, out, err = efase(*words)
    assert code == 0, err
    answer = json.loads(out)
    assert answer["complete"] and answer["sentences"] == 2
    assert answer["total_error"] <= answer["untuned_total_error"]
    after = open_database(held_out)
    assert after.weights.as_dict() == answer["weights"] == json.loads(file.read_text())["weights"]
    assert after.content_hash == before.content_hash
    assert after.untuned_weights == before.weights
    assert "tuned on 2 sentences" in efase("info", held_out)[1]
    assert not list((tmp_path / "cache" / "tuning").iterdir())

    phones = ["--phones", speech_path.with_suffix(".lab"), "--db", held_out, "-o", tmp_path / "x.csv", "--json"]
    costs = {}
    for name in ("tuned", "default", str(file)):
        code, out, err = efase("synth", speech_path, *phones, "--weights", name)
        assert code == 0, err
        costs[name] = json.loads(out)["cost"]
    assert costs[str(file)] == costs["tuned"]

    code, out, _ = efase("tune", "--db", held_out, "--forget")
    assert code == 0 and "untuned" in out
    assert open_database(held_out).weights == before.weights
    assert "weights: untuned" in efase("info", held_out)[1]


def test_a_run_that_is_out_of_time_goes_on_where_it_was(efase, held_out, tmp_path, settings_folder):
    words = ["tune", "--db", held_out, "--starts", "40", "--jobs", "1", "--limit-s", "1", "--json"]
    first = json.loads(efase(*words)[1])
    assert not first["complete"]
    second = json.loads(efase(*words)[1])
    assert second["resumed"] > 0
    assert second["sentence_solves"] > first["sentence_solves"]


def test_weights_for_the_search_as_printed_change_nothing_else(efase, held_out, settings_folder):
    before = open_database(held_out)
    code, _, err = efase("tune", "--db", held_out, "--starts", "2", "--jobs", "1", "--as-printed")
    assert code == 0, err
    after = open_database(held_out)
    assert after.weights == before.weights
    assert after.tuning["as_printed"]["weights"] == after.paper_weights.as_dict()
    assert after.paper_weights == after.paper_weights.as_printed


@pytest.mark.parametrize(
    "words",
    [
        [], ["--method", "prayer"], ["--objective", "beauty"], ["--cluster", "nonsense://nowhere"],
        ["-o", "no/such/folder.json"],
    ],
)  # fmt: skip
def test_what_cannot_be_tuned_is_one_sentence(efase, own_database, held_out, settings_folder, words):
    database = held_out if words else own_database
    stored = open_database(database)
    code, out, err = efase("tune", "--db", database, "--starts", "2", *words)
    assert (code, out) == (2, "")
    assert err.startswith("efase: ") and err.count("\n") == 1
    assert open_database(database).weights == stored.weights


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"weights": 3}', '{"weights": {"pnt": -1}}', '{"weights": {"x": 1}}']
)
def test_files_that_hold_no_weights_are_refused(efase, held_out, speech_path, tmp_path, text):
    file = tmp_path / "strange.json"
    file.write_text(text)
    phones = ["--phones", speech_path.with_suffix(".lab"), "--db", held_out, "-o", tmp_path / "x.csv"]
    code, out, err = efase("synth", speech_path, *phones, "--weights", file)
    assert (code, out) == (2, "")
    assert "strange.json" in err and err.count("\n") == 1


def test_a_new_demo_database_comes_tuned(tiny_corpus, settings_folder, monkeypatch):
    from app import demo

    monkeypatch.setattr(demo, "demo_corpus", lambda progress: tiny_corpus())
    database = demo.demo_database()
    shipped, record = read_weights(demo._WEIGHTS)
    assert database.weights == shipped
    assert database.untuned_weights != shipped
    assert open_database(database.path).tuning["search"]["split"] == record["split"] == "tune"
    assert record["total_error"] < record["untuned_total_error"]
