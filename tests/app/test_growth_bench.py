import json

import pytest

from app.demo import demo_database
from app.growth_bench import as_table, bench_growth, draw


@pytest.fixture(scope="module")
def answer():
    return bench_growth(demo_database(), sizes=(300, 900), phonemes=(5, 14))


def test_a_row_for_each_size_and_length_with_bounds_that_close(answer):
    assert [(r["nodes"], r["phonemes"]) for r in answer["rows"]] == [(300, 5), (300, 14), (900, 5), (900, 14)]
    for row in answer["rows"]:
        gaps = [gap for _, gap, _ in row["rounds"]]
        assert row["optimal"] and row["gap"] == 0.0 and gaps[-1] < 1e-6
        assert row["first_gap"] == gaps[0] and row["first_s"] <= row["seconds"]
        assert row["gap_60s"] == min(gaps)
        assert row["index_mb"] > 0 and row["peak_mb"] > 0
    assert json.loads(json.dumps(answer)) == answer
    assert len(as_table(answer).splitlines()) == 5


def test_out_of_time_the_row_keeps_the_gap_it_has():
    (row,) = bench_growth(demo_database(), sizes=(900,), phonemes=(14,), limit_s=0.0)["rows"]
    assert not row["optimal"] and row["gap"] == pytest.approx(row["first_gap"], abs=1e-4)


def test_both_pictures_show_lines(answer, tmp_path, qapp):
    from PySide6.QtGui import QImage

    for path in draw(answer, tmp_path):
        image = QImage(str(path))
        colours = {image.pixelColor(x, y).name() for x in range(0, image.width(), 2) for y in range(image.height())}
        assert image.width() == 1000 and len(colours) > 10
    assert sorted(p.name for p in tmp_path.iterdir()) == ["search-gap.png", "search-growth.png"]
