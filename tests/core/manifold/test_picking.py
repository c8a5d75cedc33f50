import numpy as np
import pytest
from scipy.interpolate import LinearNDInterpolator

from core.manifold.isomap import PhonemeMap, delaunay_triangles
from core.manifold.picking import pick


@pytest.fixture
def square():
    rng = np.random.default_rng(3)
    points = np.concatenate([[[0, 0], [1, 0], [0, 1], [1, 1]], rng.uniform(size=(40, 2))]).astype(np.float32)
    rows = np.arange(44) + 1000
    return PhonemeMap(rows, points, points, delaunay_triangles(points), 0, 0, 0.0)


def test_inside_equals_linear_interpolation(square):
    values = np.zeros((1044, 3))
    values[1000:] = np.random.default_rng(4).normal(size=(44, 3))
    reference = LinearNDInterpolator(square.embedding.astype(float), values[1000:])
    for point in np.random.default_rng(5).uniform(0.05, 0.95, (50, 2)):
        found = pick(square, point)
        assert found.inside
        assert found.weights.sum() == pytest.approx(1.0)
        assert found.blend(values) == pytest.approx(reference(point)[0], abs=1e-9)


def test_a_captured_point_gives_its_own_frame(square):
    for n in range(44):
        found = pick(square, square.embedding[n])
        assert found.nearest == n
        at = found.frames.tolist().index(1000 + n)
        assert found.weights[at] == pytest.approx(1.0, abs=1e-6)


def test_outside_the_nearest_frame_stands_in_and_says_so(square):
    found = pick(square, [1.5, 1.5])
    assert not found.inside
    assert found.frames.tolist() == [1003]


def test_a_map_without_triangles_can_be_picked():
    line = np.array([[0, 0], [1, 0]], np.float32)
    found = pick(PhonemeMap(np.array([7, 9]), line, line, delaunay_triangles(line), 0, 0, 0.0), [0.9, 0.2])
    assert (found.frames.tolist(), found.inside) == ([9], False)
