"""The bench measures the same thing on every backend; its times are not judged here."""

import numpy as np
import pytest

from app.bench import BACKENDS, as_table, bench_search, utterance
from app.demo import demo_database
from core.errors import UserFacingError


def test_every_backend_answers_the_same_question():
    answer = bench_search(demo_database(), n_nodes=300, phonemes=(14, 24), repeats=1)
    rows = answer["rows"]
    assert [(row["backend"], row["phonemes"]) for row in rows] == [(b, t) for b in BACKENDS for t in (14, 24)]
    assert not any("missing" in row for row in rows)
    for length in (14, 24):
        costs = [row["cost"] for row in rows if row["phonemes"] == length]
        assert costs == pytest.approx([costs[0]] * len(costs), rel=1e-5)
    assert all(row["optimal"] and row["nodes"] == 300 and row["gap"] == 0.0 for row in rows)
    for row in rows:
        assert row["speedup_vs_reference"] > 0
        if row["backend"] in ("numpy", "opencl", "glsl", "relaxation"):
            assert min(row[name] for name in ("pin_s", "refresh_s", "paint_s", "prices_s", "build_s")) > 0
    assert answer["machine"]["read_gb_per_s"] > 0
    assert len(as_table(answer).splitlines()) == 2 + len(rows)


def test_an_unknown_backend_is_refused():
    with pytest.raises(UserFacingError, match="abacus"):
        bench_search(demo_database(), backends=["abacus"])


def test_utterances_have_the_length_asked_for_and_no_double_silence():
    for length in (1, 14, 63, 300):
        request = utterance(length)
        assert request.n_slots == length
        assert not ((request.phonemes[1:] == 0) & (request.phonemes[:-1] == 0)).any()
        assert np.array_equal(request.emotions.sum(axis=1), np.ones(length))
