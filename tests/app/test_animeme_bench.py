"""`efase bench animeme`: its object, its table and its plots, on a small database."""

# ruff: noqa: F811  pytest hands over fixtures by the names under which they are imported

from __future__ import annotations

import json
import xml.etree.ElementTree as ET

from app import animeme_bench
from core.animeme import comparison
from core.animeme.material import component_controls
from tests.core.evaluation.conftest import mouth_corpus, mouth_database  # noqa: F401


def test_it_measures_errors_and_times_and_draws_what_it_measured(mouth_database, monkeypatch, tmp_path):
    def first_two(database, *_):
        names, mapping = component_controls(database)
        return names[:2], lambda positions: mapping(positions)[:, :2]

    for kind in ("mouth_measures", "key_shape_controls"):  # these markers show no corners of the mouth
        monkeypatch.setattr(animeme_bench, kind, first_two)
    variants = {method: dict(list(found.items())[:1]) for method, found in comparison.METHODS.items()}
    monkeypatch.setattr(comparison, "METHODS", variants)
    answer = animeme_bench.bench_animemes(mouth_database, tmp_path / "plots", with_face=False)
    json.dumps(answer, allow_nan=False)
    for title in ("key lip shapes", "mouth"):
        methods = answer[title]["methods"]
        assert list(methods) == list(comparison.METHODS)
        assert methods["animeme"]["test_ratio"] == 1.0
        assert all(row["test"] > 0 and row["tried"] == 1 for row in methods.values())
    assert answer["speed"]["residual_converged"] <= answer["speed"]["residual"] * 1.001
    table = animeme_bench.as_table(answer)
    assert "| MMM |" in table and "first_curves_ms" in table
    plots = sorted(path.name for path in (tmp_path / "plots").iterdir())
    assert plots == ["animeme-key-lip-shapes-dominance.svg", "animeme-key-lip-shapes.svg",
                     "animeme-mouth-dominance.svg", "animeme-mouth.svg"]  # fmt: skip
    for name in plots:
        ET.parse(tmp_path / "plots" / name)
