"""Openness to light: whole on a ball, little at the bottom of a well."""

import numpy as np

from gpu.gl.normals import VertexNormals
from gpu.gl.occlusion import openness


def test_a_ball_is_open_everywhere(offscreen, head):
    skin = head.vertices_of("skin")
    triangles = head.triangles[(head.triangles < len(skin)).all(axis=1)]
    positions = head.positions[skin]
    light = openness(offscreen.ctx, positions, VertexNormals(triangles, positions)(positions), triangles)
    assert light.min() > 0.9
    assert light.max() <= 1.0


def test_the_bottom_of_a_well_sees_less_the_deeper_it_is(offscreen):
    turn = np.linspace(0, 2 * np.pi, 33)
    light = []
    for depth in (5.0, 20.0, 60.0):
        rims = [np.stack([10 * np.cos(turn), np.full(33, y), 10 * np.sin(turn)], 1) for y in (0.0, depth)]
        points = np.concatenate([*rims, [[0.0, 0.0, 0.0]]]).astype(np.float32)
        k = np.arange(32)
        wall = np.concatenate([np.stack([k, k + 1, k + 33], 1), np.stack([k + 1, k + 34, k + 33], 1)])
        floor = np.stack([np.full(32, 66), k, k + 1], 1)
        up = np.tile([0.0, 1.0, 0.0], (67, 1))
        light.append(openness(offscreen.ctx, points, up, np.concatenate([wall, floor]), 400)[66])
    assert light[0] > light[1] > light[2]
    # a floor of radius r at depth d sees sin² of the rim's angle of a cosine-weighted sky
    for seen, depth in zip(light, (5.0, 20.0, 60.0), strict=True):
        assert abs(seen - 100 / (100 + depth**2)) < 0.03
