"""Vertex normals agree with a plain sum over triangles."""

import numpy as np

from gpu.gl.normals import VertexNormals


def test_a_random_mesh_agrees_with_the_plain_sum():
    chance = np.random.default_rng(0)
    rest = chance.normal(size=(40, 3)).astype(np.float32)
    triangles = np.array([chance.choice(40, 3, replace=False) for _ in range(90)])
    normals = VertexNormals(triangles, rest)
    moved = (rest + chance.normal(scale=0.3, size=rest.shape)).astype(np.float32)
    plain = np.zeros((40, 3))
    for a, b, c in triangles:
        plain[[a, b, c]] += np.cross(moved[b] - moved[a], moved[c] - moved[a])
    np.testing.assert_allclose(normals(moved), plain, atol=1e-4)


def test_a_ball_points_outwards_also_along_its_seam(head):
    positions, triangles = head.positions, head.triangles
    skin = head.vertices_of("skin")
    normals = VertexNormals(triangles, positions)(positions)[skin]
    length = np.linalg.norm(normals, axis=1)
    outwards = np.einsum("ij,ij->i", normals, positions[skin]) / length / 80
    assert outwards.min() > 0.997


def test_a_vertex_without_triangles_has_no_normal():
    rest = np.eye(4, 3, dtype=np.float32)
    assert not VertexNormals(np.array([[0, 1, 2]]), rest)(rest)[3].any()
