"""The benches of size and of maps measure what they say, on something small."""

from __future__ import annotations

import pytest

from app.map_bench import agreement_as_table, bench_agreement, bench_large
from app.size_bench import as_table, bench_build, bench_use
from core.motion.build import BuildSettings, build_database
from core.motion.database import open_database
from tests.core.motion.growing import corpus_of


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    path = tmp_path_factory.mktemp("source") / "db.h5"
    return build_database(corpus_of(*range(6)), path, BuildSettings(n_dims=8))


def test_a_large_database_is_built_and_used(source, tmp_path):
    path = tmp_path / "large.h5"
    build = bench_build(source, 2 * len(source.frames), path)
    made = open_database(path)
    assert (build["frames"], build["nodes"]) == (len(made.frames), len(made.nodes))
    assert sum(build["stages_s"].values()) == pytest.approx(build["seconds"], rel=0.2)
    assert build["cpu_s"] > 0 and build["peak_mb"] > 50
    use = bench_use(path)
    assert 0 < use["open_s"] < 60 and len(use["maps"]) == 3
    assert use["maps"][0]["frames"] == build["largest_map_frames"]
    table = as_table({"build": build, "use": use})
    assert f"{build['frames']} frames" in table and "first synthesis" in table


def test_agreement_compares_every_way_with_the_full_one(source):
    answer = bench_agreement(source, 400)
    full = [row for row in answer["rows"] if row["way"] == "full"]
    assert len(full) == 4 and all(row["disparity"] < 1e-12 for row in full)
    assert any(row["way"].endswith("placed") and 0 < row["disparity"] < 0.9 for row in answer["rows"])
    assert len(agreement_as_table(answer).splitlines()) == len(answer["rows"]) + 1


def test_one_large_map_is_as_large_as_asked_for(source):
    answer = bench_large(source, 1500)
    assert answer["frames"] == 1500 and answer["seconds"] > 0
