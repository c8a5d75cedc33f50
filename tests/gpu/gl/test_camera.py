"""The camera keeps its box in view and turns as an animator expects."""

import itertools

import numpy as np
import pytest

from core.face.face import Face
from gpu.gl.camera import Camera, portrait_bounds

BOUNDS = np.array([[-60.0, -120.0, -90.0], [80.0, 100.0, 40.0]])


def on_screen(camera: Camera, points, aspect: float) -> np.ndarray:
    """Normalised device coordinates, (n, 3)."""
    points = np.column_stack([points, np.ones(len(points))])
    clip = points @ (camera.projection(aspect) @ camera.view(aspect)).T
    return clip[:, :3] / clip[:, 3:]


@pytest.mark.parametrize("aspect", [0.4, 1.0, 4 / 3, 3.0])
def test_the_front_of_the_box_fills_the_picture_without_being_cut(aspect):
    camera = Camera.front(BOUNDS)
    corners = np.array([[x, y, (BOUNDS[0, 2] + BOUNDS[1, 2]) / 2] for x, y in itertools.product(*BOUNDS[:, :2].T)])
    reach = np.abs(on_screen(camera, corners, aspect)[:, :2]).max()
    assert 0.85 < reach < 1.0


@pytest.mark.parametrize("azimuth_deg", range(0, 360, 45))
def test_nothing_of_the_box_is_clipped_by_depth_from_any_side(azimuth_deg):
    corners = np.array(list(itertools.product(*BOUNDS.T)))
    for zoom in (0.2, 1.0, 3.0):
        depth = on_screen(Camera.front(BOUNDS).orbited(azimuth_deg, 20).zoomed(zoom), corners, 1.5)[:, 2]
        assert (np.abs(depth) < 1).all()


def test_left_is_left_and_up_is_up():
    front = on_screen(Camera.front(BOUNDS), [[0, 0, 0], [30, 0, 0], [0, 30, 0]], 1.0)
    assert front[1, 0] > front[0, 0]  # the character's left is the picture's right
    assert front[2, 1] > front[0, 1]
    side = on_screen(Camera.side(BOUNDS), [[0, 0, 0], [0, 0, 30]], 1.0)
    assert side[1, 0] < side[0, 0]
    above = on_screen(Camera.front(BOUNDS).orbited(0, 60), [[0, 0, 0], [0, 0, 30]], 1.0)
    assert above[1, 1] < above[0, 1]


def test_zoom_doubles_and_pan_moves_the_picture():
    camera = Camera(half_mm=(50, 50, 1))
    one, two = (on_screen(c, [[10.0, 0, 0]], 1.0)[0, 0] for c in (camera, camera.zoomed(2)))
    assert two == pytest.approx(2 * one)
    assert on_screen(camera.panned(0.5, 0), [[0.0, 0, 0]], 1.0)[0, 0] < -0.4


def test_orbiting_never_tips_over_and_zoom_stays_in_reach():
    camera = Camera().orbited(350, 500).orbited(20, 0).zoomed(1e9)
    assert camera.elevation_deg < 90
    assert camera.azimuth_deg == pytest.approx(10)
    assert camera.zoom == 40


def test_the_view_is_a_rigid_motion():
    rotation = Camera().orbited(33, -21).view()[:3, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1)


def test_a_portrait_leaves_the_shoulders_out():
    positions = np.array(
        [[40, 0, 0], [-40, 0, 0], [0, -90, 10], [200, -300, 0], [-200, -300, 0], [0, 90, -60]], np.float32
    )
    marks = {"outer_eye_left": 0, "outer_eye_right": 1, "chin": 2}
    part, triangles = np.zeros(6, np.uint8), np.zeros((0, 3), np.int32)
    low, high = portrait_bounds(Face("bust", positions, triangles, part, landmarks=marks))
    assert low[0] > -100
    assert -200 < low[1] < -90
    assert high[1] == 90
    whole = portrait_bounds(Face("bust", positions, triangles, part))
    np.testing.assert_array_equal(whole, [positions.min(0), positions.max(0)])
