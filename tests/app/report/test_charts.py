"""Plots are well-formed SVG whose points lie where their numbers say, whatever names they carry."""

from __future__ import annotations

import itertools
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from app.report.charts import Line, Spot, line_chart, rounded_span, spot_chart, ticks

SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.parametrize(
    ("span", "expected"),
    [((0, 7), [0, 1, 2, 3, 4, 5, 6, 7]), ((0.0, 0.31), [0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3]),
     ((-300, 400), [-300, -200, -100, 0, 100, 200, 300, 400]), ((2, 2), [2])],
)  # fmt: skip
def test_ticks_are_round_numbers_within_the_span(span, expected):
    assert ticks(*span) == pytest.approx(expected)


@pytest.mark.parametrize("span", [(0.1, 6.7), (-13.2, 4.9), (5, 5), (0, 0), (1e-6, 2e-6), (1e5, 1.3e5)])
def test_a_span_is_widened_to_ticks(span):
    low, high = rounded_span(*span)
    assert low <= span[0] and high >= span[1] and high > low
    inside = ticks(low, high)
    assert inside[0] == pytest.approx(low, abs=1e-9 * (high - low))
    assert inside[-1] == pytest.approx(high, abs=1e-6 * (high - low))


def test_a_line_runs_from_axis_to_axis_as_its_numbers_do():
    line = Line("up", np.array([0.0, 1.0, 2.0]), np.array([0.0, 5.0, 10.0]))
    root = ET.fromstring(line_chart("t", [line], ("s", "mm")))
    points = [tuple(map(float, p.split(","))) for p in root.find(f"{SVG}polyline").get("points").split()]
    (x0, y0), (x1, y1), (x2, y2) = points
    assert x0 < x1 < x2 and y0 > y1 > y2
    assert (x1, y1) == pytest.approx(((x0 + x2) / 2, (y0 + y2) / 2))
    labels = {text.text: (float(text.get("x")), float(text.get("y"))) for text in root.iter(f"{SVG}text")}
    assert labels["0"][0] == pytest.approx(x0, abs=60) and labels["10"][1] == pytest.approx(y2 + 4)


def test_spots_stand_where_their_numbers_say_and_the_band_is_behind():
    spots = [Spot("near", 1.0, 1.0), Spot("far", 2.0, 0.0, hollow=True)]
    root = ET.fromstring(spot_chart("t", spots, ("mm", "ratio"), (0.8, 1.25, "alive")))
    near, far = [(float(c.get("cx")), float(c.get("cy"))) for c in root.iter(f"{SVG}circle")]
    band = root.findall(f"{SVG}rect")[1]
    top, height = float(band.get("y")), float(band.get("height"))
    assert top < near[1] < top + height < far[1]
    assert near[0] < far[0]
    assert "near" in {text.text for text in root.iter(f"{SVG}text")}


def test_labels_of_spots_that_touch_do_not_lie_on_each_other():
    spots = [Spot(name, 1.0, 1.0) for name in "abc"]
    root = ET.fromstring(spot_chart("t", spots, ("mm", "ratio"), (0.8, 1.25, "alive")))
    heights = sorted(float(t.get("y")) for t in root.iter(f"{SVG}text") if t.text in "abc" and t.text)
    assert all(b - a >= 12 for a, b in itertools.pairwise(heights))


def test_names_cannot_break_the_picture():
    name = '<script>alert("x")</script> & "quotes"'
    line = Line(name, np.array([0.0, 1.0]), np.array([3.0, 3.0]))
    for svg in (
        line_chart(name, [line], (name, name), [(0.0, 1.0, name)]),
        spot_chart(name, [Spot(name, 1.0, 0.0)], (name, name), (0.8, 1.25, name)),
    ):
        assert name in {text.text for text in ET.fromstring(svg).iter(f"{SVG}text")}
        assert "<script" not in svg
