import numpy as np
import pytest

from core.face.clip import clip_mesh


def grid(n):
    """Return a square of side 1 in the plane z = 0 as (n+1)² vertices and 2n² triangles."""
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    i = np.arange(x.size).reshape(x.shape)
    a, b, c, d = i[:-1, :-1].ravel(), i[:-1, 1:].ravel(), i[1:, 1:].ravel(), i[1:, :-1].ravel()
    return positions, np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


def normals(positions, triangles):
    a, b, c = positions[triangles].transpose(1, 0, 2)
    return np.cross(b - a, c - a) / 2


@pytest.mark.parametrize("direction", [(1.0, 0.3), (-0.2, 1.0), (0.5, 0.5)])
def test_what_a_line_leaves_of_a_square_has_the_right_area_and_faces_the_same_way(direction):
    positions, triangles = grid(7)
    inside = 0.61 - positions[:, :2] @ direction
    kept, cut, _ = clip_mesh(triangles, positions, inside)
    areas = normals(cut, kept)
    assert (areas[:, 2] > 0).all()
    rng = np.random.default_rng(0)
    sample = rng.random((400_000, 2))
    expected = (sample @ direction <= 0.61).mean()
    assert areas[:, 2].sum() == pytest.approx(expected, abs=0.004)


def test_new_vertices_lie_on_the_cut_and_carry_what_varies_linearly():
    positions, triangles = grid(5)
    carried = np.concatenate([positions, positions[:, :1] * 3 - positions[:, 1:2]], axis=1)
    kept, cut, source = clip_mesh(triangles, carried, 0.37 - positions[:, 0])
    new = source < 0
    assert new.any()
    np.testing.assert_allclose(cut[new, 0], 0.37, atol=1e-12)
    np.testing.assert_allclose(cut[:, 3], cut[:, 0] * 3 - cut[:, 1], atol=1e-12)
    np.testing.assert_array_equal(cut[~new], carried[source[~new]])
    assert (np.diff(source[~new]) > 0).all()
    assert kept.max() == len(cut) - 1
