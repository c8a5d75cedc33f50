"""A place on a map is a frame of some node, whole or mixed."""

from __future__ import annotations

import numpy as np
import pytest

from app.panels.map_pick import MapPick, node_of_frame, trajectory
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
    shown = database.maps["aa"]
    for place in (0, len(shown.frames) // 2, len(shown.frames) - 1):
        picked = MapPick.under(database, shown, shown.embedding[place])
        expected = database.frames[shown.frames[place]]
        assert picked.blend(database.frames) == pytest.approx(expected, abs=1e-4)
        assert picked.node == node_of_frame(database.nodes, shown.frames[place])
        assert picked.inside


def test_far_from_the_map_the_nearest_frame_stands_in_and_the_caption_says_so(database):
    shown = database.maps["aa"]
    point = shown.embedding.max(axis=0) + 1000.0
    picked = MapPick.under(database, shown, point)
    assert not picked.inside
    assert picked.weights.tolist() == [1.0]
    assert picked.caption(database).startswith("nearest frame")


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_the_frame_in_use_lies_on_its_nodes_trajectory(database, share):
    nodes = database.nodes
    row = next(row for row in range(len(nodes)) if nodes[row].phone == "w")
    used = MapPick.used(database, "w", row, share)
    way = trajectory(database, "w", row)
    place = share * (len(way) - 1)
    expected = [np.interp(place, np.arange(len(way)), way[:, axis]) for axis in (0, 1)]
    assert used.at == pytest.approx(expected)
    first, last = database.frames[nodes.start[row]], database.frames[nodes.stop[row] - 1]
    if share in (0.0, 1.0):
        assert used.blend(database.frames) == pytest.approx(first if share == 0.0 else last)


def test_a_node_of_another_phone_is_used_but_not_on_the_map(database):
    row = next(row for row in range(len(database.nodes)) if database.nodes[row].phone == "w")
    used = MapPick.used(database, "aa", row, 0.5)
    assert used.at is None
    assert len(trajectory(database, "aa", row)) == 0
    assert "w" in used.caption(database)
