"""A place on a map is a frame of some node, whole or mixed."""

from __future__ import annotations

import numpy as np
import pytest

from app.panels.isomap.shown_map import ShownMap
from app.panels.map_pick import MapPick, node_of_frame
from core.motion.database import open_database


@pytest.fixture
def database(database_path):
    return open_database(database_path)


def test_every_frame_of_a_node_leads_back_to_it(database):
    nodes = database.nodes
    for row in range(len(nodes)):
        for frame in (nodes.start[row], nodes.stop[row] - 1):
            assert node_of_frame(nodes, frame) == row


def test_a_point_of_the_map_is_just_its_frame(database):
    shown = ShownMap.isomap(database, "aa")
    frames = shown.map.frames
    for place in (0, len(frames) // 2, len(frames) - 1):
        expected = database.frames[frames[place]]
        for picked in (MapPick.under(shown, shown.points[place]), MapPick.captured(shown, place)):
            assert picked.blend(database.frames) == pytest.approx(expected, abs=1e-4)
            assert picked.node == node_of_frame(database.nodes, frames[place])
            assert picked.inside


def test_far_from_the_map_the_nearest_frame_stands_in_and_the_caption_says_so(database):
    shown = ShownMap.isomap(database, "aa")
    picked = MapPick.under(shown, shown.points.max(axis=0) + 1000.0)
    assert not picked.inside
    assert picked.weights.tolist() == [1.0]
    assert picked.caption(database).startswith("nearest frame")


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_frame_in_use_lies_on_its_nodes_trajectory(database, share):
    nodes = database.nodes
    row = next(row for row in range(len(nodes)) if nodes[row].phone == "w")
    shown = ShownMap.isomap(database, "w")
    used = MapPick.of_node(database, row, share, shown)
    way = shown.trajectory(row)
    place = share * (len(way) - 1)
    expected = [np.interp(place, np.arange(len(way)), way[:, axis]) for axis in (0, 1)]
    assert used.at == pytest.approx(expected)
    first, last = database.frames[nodes.start[row]], database.frames[nodes.stop[row] - 1]
    if share in (0.0, 1.0):
        assert used.blend(database.frames) == pytest.approx(first if share == 0.0 else last)


def test_a_node_of_another_phone_is_used_but_not_on_the_map(database):
    row = next(row for row in range(len(database.nodes)) if database.nodes[row].phone == "w")
    shown = ShownMap.isomap(database, "aa")
    used = MapPick.of_node(database, row, 0.5, shown)
    assert used.at is None
    assert len(shown.trajectory(row)) == 0
    assert "w" in used.caption(database)
