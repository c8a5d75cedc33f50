import numpy as np
import pytest
import trimesh

from core.face.own_face_raster import covered_pixels
from core.face.own_face_surface import Surface, closest_bary


@pytest.fixture(scope="module")
def bumpy():
    ball = trimesh.creation.icosphere(subdivisions=2, radius=50.0)
    rng = np.random.default_rng(1)
    return ball.vertices * (1 + 0.08 * rng.normal(size=(len(ball.vertices), 1))), ball.faces


def brute_distance(points, corners):
    """Distance to a triangle by trying the plane and, densely, the edges."""
    best = np.full(len(points), np.inf)
    for a, b, c in corners:
        for start, stop in ((a, b), (b, c), (c, a)):
            way = stop - start
            t = np.clip((points - start) @ way / (way @ way), 0, 1)
            best = np.minimum(best, np.linalg.norm(points - start - t[:, None] * way, axis=1))
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        height = (points - a) @ normal
        foot = points - height[:, None] * normal
        inside = np.ones(len(points), bool)
        for start, stop in ((a, b), (b, c), (c, a)):
            inside &= np.cross(stop - start, foot - start) @ normal >= 0
        best = np.where(inside, np.minimum(best, np.abs(height)), best)
    return best


def test_the_nearest_place_is_as_near_as_any_triangle_has_one(bumpy):
    positions, triangles = bumpy
    points = np.random.default_rng(2).normal(scale=45.0, size=(120, 3))
    near = Surface(positions, triangles).nearest(points)
    np.testing.assert_allclose(near.distance, brute_distance(points, positions[triangles]), atol=0.02)
    at = np.einsum("nk,nkx->nx", near.bary, positions[triangles[near.triangle]])
    np.testing.assert_allclose(at, near.place, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(points - at, axis=1), near.distance, atol=1e-9)


def test_corners_edges_and_inside_of_one_triangle():
    triangle = np.array([[0.0, 0, 0], [4, 0, 0], [0, 4, 0]])
    points = np.array([[-1.0, -1, 3], [6, -1, 0], [-1, 9, 0], [2, -5, 1], [-2, 2, 0], [3, 3, 0], [1, 1, 7]])
    bary = closest_bary(points, np.tile(triangle, (len(points), 1, 1)))
    wanted = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [2, 0, 0], [0, 2, 0], [2, 2, 0], [1, 1, 0]]
    np.testing.assert_allclose(bary @ triangle, wanted, atol=1e-12)


def test_only_where_a_surface_ends_is_a_rim():
    grid = trimesh.creation.box((10, 10, 10))
    closed = Surface(grid.vertices, grid.faces)
    assert not closed.nearest(np.array([[5.0, 5, 5], [9, 0, 0], [5, 0, 5]])).at_rim.any()
    lid = np.flatnonzero((grid.vertices[grid.faces][:, :, 2] > 0).all(axis=1))
    opened = Surface(grid.vertices, np.delete(grid.faces, lid, axis=0))
    at_rim = opened.nearest(np.array([[0.0, 9, 5], [9, 0, 0], [2, 0, -9]])).at_rim
    np.testing.assert_array_equal(at_rim, [True, False, False])


def test_normals_look_out_and_the_flipped_surface_looks_in(bumpy):
    surface = Surface(*bumpy)
    outside = 90.0 * np.eye(3)
    assert (np.einsum("ij,ij->i", surface.nearest(outside).normal, outside) > 0).all()
    assert (np.einsum("ij,ij->i", surface.flipped().nearest(outside).normal, outside) < 0).all()


def test_pixels_are_covered_as_a_test_of_each_pixel_says():
    rng = np.random.default_rng(3)
    corners = rng.uniform(-5, 35, (12, 3, 2))
    owner, bary = covered_pixels(corners, 30, 20)
    for row in range(20):
        for column in range(30):
            middle = np.array([column + 0.5, row + 0.5])
            inside = []
            for t, (a, b, c) in enumerate(corners):
                mix = np.linalg.solve(np.vstack([np.array([a, b, c]).T, np.ones(3)]), [*middle, 1.0])
                if (mix > 1e-6).all():
                    inside.append(t)
            assert owner[row, column] == (inside[-1] if inside else -1)
            if inside:
                np.testing.assert_allclose(bary[row, column] @ corners[inside[-1]], middle, atol=1e-4)


def test_of_two_triangles_the_nearer_one_is_seen():
    big = np.array([[[0.0, 0], [10, 0], [0, 10]]] * 2)
    depth = np.array([[5.0, 5, 5], [4, 4, 9]])
    owner, _ = covered_pixels(big, 10, 10, depth)
    assert owner[1, 1] == 1  # there the tilted one is in front
    assert owner[8, 0] == 0
