import numpy as np
import pytest
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra

from core.face.geodesic import components, seam_partners, surface_distances


def plane(n, slit=False):
    """Return a square of (n+1)² vertices one apart; with a slit, the middle row is doubled except at its ends."""
    x, y = np.meshgrid(np.arange(n + 1.0), np.arange(n + 1.0))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    i = np.arange(x.size).reshape(x.shape)
    upper = i.copy()
    if slit:
        row = n // 2
        inner = slice(3, n - 2)
        positions = np.concatenate([positions, positions[i[row, inner]] + np.array([0, 0.01, 0])])
        upper[row, inner] = np.arange(x.size, len(positions))
    quads = []
    for r in range(n):
        low = upper if slit and r >= n // 2 else i
        high = i
        for c in range(n):
            quads.append((low[r, c], low[r, c + 1], high[r + 1, c + 1], high[r + 1, c]))
    quads = np.array(quads)
    return positions, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]), i


def along_edges(positions, triangles, source):
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    length = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1)
    edges, first = np.unique(np.sort(edges, axis=1), axis=0, return_index=True)
    graph = coo_matrix((length[first], tuple(edges.T)), shape=(len(positions),) * 2)
    return dijkstra(graph, directed=False, indices=source)


def test_on_a_plane_it_is_the_straight_distance():
    positions, triangles, i = plane(50)
    source = i[25, 25]
    found = surface_distances(positions, triangles, [source])[0]
    straight = np.linalg.norm(positions - positions[source], axis=1)
    far = straight > 4
    assert np.abs(found[far] / straight[far] - 1).max() < 0.06
    # the sum of edge lengths, the paper's measure, is much further off on this grid
    assert np.abs(along_edges(positions, triangles, source)[far] / straight[far] - 1).max() > 0.2


def test_on_a_sphere_it_is_the_great_circle():
    ball = trimesh.creation.icosphere(subdivisions=4, radius=50.0)
    found = surface_distances(ball.vertices, ball.faces, [0])[0]
    cosine = ball.vertices @ ball.vertices[0] / 50.0**2
    arc = 50.0 * np.arccos(np.clip(cosine, -1, 1))
    assert np.abs(found[1:] / arc[1:] - 1).max() < 0.02


def test_a_way_is_never_shorter_than_straight_nor_longer_than_along_the_edges(face):
    used = face.part == 0
    triangles = face.triangles[used[face.triangles].all(axis=1)]
    source = face.landmarks["chin"]
    found = surface_distances(face.positions, triangles, [source])[0]
    straight = np.linalg.norm(face.positions - face.positions[source], axis=1)
    edges = along_edges(face.positions, triangles, source)
    near = np.isfinite(edges) & (straight > 5) & (edges < 150)
    assert near.sum() > 500
    assert (found[near] >= straight[near] * (1 - 1e-6)).all()
    # the heat method is smooth, not exact
    assert (found[near] < 1.05 * edges[near]).all()
    assert np.median(found[near] / edges[near]) < 0.99


def test_an_opening_lengthens_the_way_across_it():
    positions, triangles, i = plane(30, slit=True)
    above, below = i[16, 15], i[14, 15]
    found = surface_distances(positions, triangles, [below])[0]
    around = 2 * np.hypot(13, 1)  # by the end of the slit, 13 columns away
    assert found[above] == pytest.approx(around, rel=0.12)


def test_no_way_is_infinitely_far_and_the_source_is_at_zero():
    positions, triangles, _ = plane(6)
    two = np.concatenate([positions, positions + np.array([0, 0, 5.0])])
    both = np.concatenate([triangles, triangles + len(positions)])
    found = surface_distances(two, both, [0, len(positions) + 3])
    assert np.isinf(found[0, len(positions) :]).all()
    assert np.isinf(found[1, : len(positions)]).all()
    assert found[0, 0] == 0
    assert found[1, len(positions) + 3] == 0
    assert np.isfinite(found[0, : len(positions)]).all()


def test_a_texture_seam_is_no_opening_but_touching_lips_are():
    positions, triangles, i = plane(8)
    left, right = positions[:, 0] <= 4, positions[:, 0] >= 4
    halves = []
    for side in (left, right):
        halves.append(triangles[side[triangles].all(axis=1)])
    torn = np.concatenate([halves[0], halves[1] + len(positions)])
    doubled = np.concatenate([positions, positions])
    found = surface_distances(doubled, torn, [i[4, 0]])[0]
    assert found[len(positions) + i[4, 8]] == pytest.approx(8, rel=0.06)
    assert len(np.unique(components(len(doubled), torn)[np.unique(torn)])) == 2

    lips = np.concatenate([triangles, triangles[:, ::-1] + len(positions)])
    np.testing.assert_array_equal(seam_partners(doubled, lips), np.arange(len(doubled)))


def test_a_degenerate_triangle_does_no_harm():
    positions, triangles, i = plane(10)
    broken = np.concatenate([triangles, [[0, 0, 1], [5, 6, 6]]])
    expected = surface_distances(positions, triangles, [i[5, 5]])
    np.testing.assert_allclose(surface_distances(positions, broken, [i[5, 5]]), expected, rtol=1e-6)
