"""The bench measures the same thing on every backend; its times are not judged here."""

import numpy as np
import pytest

from app.bench import BACKENDS, as_table, bench_search, utterance
from app.demo import demo_database
from core.errors import UserFacingError
from core.search.transitions import TransitionCosts

ASKED_FOR = {
    "phonemes", "nodes", "backend", "device", "cold_s", "pin_s", "refresh_s", "paint_s", "prices_s", "build_s",
    "fraction_of_bandwidth", "speedup_vs_reference", "optimal", "gap", "peak_mb",
}  # fmt: skip
EDITS = ("pin_s", "second_pin_s", "refresh_s", "paint_s", "prices_s")


@pytest.fixture(scope="module")
def answer():
    return bench_search(demo_database(), n_nodes=300, phonemes=(14, 24), repeats=2)


def test_every_backend_answers_the_same_question(answer):
    rows = answer["rows"]
    assert [(row["backend"], row["phonemes"]) for row in rows] == [(b, t) for b in BACKENDS for t in (14, 24)]
    assert not any(row["missing"] for row in rows)
    for length in (14, 24):
        costs = [row["cost"] for row in rows if row["phonemes"] == length]
        assert costs == pytest.approx([costs[0]] * len(costs), rel=1e-5)
    assert all(row["optimal"] and row["nodes"] == 300 and row["gap"] == 0.0 for row in rows)
    assert answer["machine"]["read_gb_per_s"] > 0
    assert len(as_table(answer).splitlines()) == 2 + len(rows)


def test_every_row_has_every_figure_that_its_way_has(answer):
    for row in answer["rows"]:
        assert set(row) >= ASKED_FOR
        assert row["repeats"] == 2 and isinstance(row["software"], bool) and row["device"]
        assert min(row[name] for name in ("cold_s", "build_s", "speedup_vs_reference", "peak_mb")) > 0
        plain = row["backend"] in ("reference", "numpy32")
        assert [row[name] is None for name in EDITS] == [plain] * len(EDITS)
        assert plain or min(row[name] for name in EDITS) > 0
        assert (row["fraction_of_bandwidth"] is None) == (row["backend"] == "relaxation")


def test_bytes_are_those_of_the_passes_over_the_matrix(answer):
    for row in answer["rows"]:
        steps, size = row["phonemes"] - 1, 300 * 300 * 4
        expected = {"reference": 2 * steps * size, "middle": (steps + 1) // 2 * size, "relaxation": None}
        assert row["bytes_moved"] == expected.get(row["backend"], steps * size)


def test_beyond_the_memory_budget_only_the_relaxation_is_measured(monkeypatch):
    others = TransitionCosts.__init__.__defaults__[1:]
    monkeypatch.setattr("core.search.transitions.TransitionCosts.__init__.__defaults__", (1, *others))
    answer = bench_search(demo_database(), 200, (5,), ("opencl", "relaxation"), repeats=1)
    assert "memory budget" in answer["rows"][0]["missing"]
    assert answer["rows"][1]["cold_s"] > 0 and answer["rows"][1]["pin_s"] is None


def test_an_unknown_backend_is_refused():
    with pytest.raises(UserFacingError, match="abacus"):
        bench_search(demo_database(), backends=["abacus"])


def test_utterances_have_the_length_asked_for_and_no_double_silence():
    for length in (1, 14, 63, 300):
        request = utterance(length)
        assert request.n_slots == length
        assert not ((request.phonemes[1:] == 0) & (request.phonemes[:-1] == 0)).any()
        assert np.array_equal(request.emotions.sum(axis=1), np.ones(length))
