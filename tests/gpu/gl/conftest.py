"""A small head to draw, and a context to draw it in."""

import numpy as np
import pytest

from core.face.face import PARTS, Face
from gpu.gl.offscreen import OffscreenRenderer


def ball(centre, radius, n_rings=24):
    """A closed sphere of quads cut in two, its poles up and down, facing outwards."""
    ring, turn = np.meshgrid(
        np.linspace(0, np.pi, n_rings + 1), np.linspace(0, 2 * np.pi, 2 * n_rings + 1), indexing="ij"
    )
    points = np.stack([np.sin(ring) * np.sin(turn), np.cos(ring), np.sin(ring) * np.cos(turn)], -1).reshape(-1, 3)
    across = 2 * n_rings + 1
    a = (np.arange(n_rings)[:, None] * across + np.arange(2 * n_rings)).ravel()
    triangles = np.concatenate([np.stack([a, a + across, a + across + 1], 1), np.stack([a, a + across + 1, a + 1], 1)])
    return (points * radius + centre).astype(np.float32), triangles.astype(np.int32)


def make_head() -> Face:
    """A skin ball of 80 mm with two eyeballs that stand out of it."""
    pieces = [("skin", (0, 0, 0), 80.0), ("eye_left", (35, 20, 75), 14.0), ("eye_right", (-35, 20, 75), 14.0)]
    positions, triangles, part, n = [], [], [], 0
    for name, centre, radius in pieces:
        points, corners = ball(centre, radius)
        positions.append(points)
        triangles.append(corners + n)
        part.append(np.full(len(points), PARTS.index(name), np.uint8))
        n += len(points)
    return Face("ball", np.concatenate(positions), np.concatenate(triangles), np.concatenate(part))


@pytest.fixture(scope="session")
def head():
    return make_head()


@pytest.fixture(scope="module")
def offscreen():
    with OffscreenRenderer(240, 180) as renderer:
        yield renderer
