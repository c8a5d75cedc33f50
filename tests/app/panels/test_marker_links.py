"""Markers are joined to their neighbours, and lips may part."""

from __future__ import annotations

import numpy as np

from app.panels.marker_links import marker_links
from core.motion.marker_set import MarkerSet


def linked(points, **groups):
    names = tuple(f"m{i}" for i in range(len(points)))
    spelt = {group: tuple(f"m{i}" for i in members) for group, members in groups.items()}
    return {tuple(pair) for pair in marker_links(MarkerSet(names, np.asarray(points, float), spelt)).tolist()}


def test_markers_on_a_line_are_a_chain():
    assert linked([[0, 0, 0], [3, 0, 0], [1, 0, 0], [2, 0, 0]]) == {(0, 2), (2, 3), (1, 3)}


def test_a_square_has_sides_and_no_diagonals():
    assert linked([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]) == {(0, 1), (1, 2), (2, 3), (0, 3)}


def test_upper_and_lower_lip_are_not_joined():
    points = [[0, 0.1, 0], [1, 0.1, 0], [0, -0.1, 0], [1, -0.1, 0]]
    assert linked(points) == {(0, 1), (2, 3), (0, 2), (1, 3)}
    assert linked(points, upper_lip=[0, 1], lower_lip=[2, 3]) == {(0, 1), (2, 3)}


def test_a_set_too_large_for_it_has_no_links():
    assert linked(np.random.default_rng(1).normal(size=(400, 3))) == set()
