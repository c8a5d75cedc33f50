import numpy as np
import pytest
import trimesh

from core.face.own_face_display import MOST_TRIANGLES, SHOWN_MM, Clickable, ShownScan
from core.face.own_face_scan import Scan


@pytest.fixture(scope="module")
def ball():
    return trimesh.creation.icosphere(subdivisions=3, radius=10.0)


def test_a_ray_stops_at_the_first_surface_that_it_meets(ball):
    clickable = Clickable(ball.vertices, ball.faces)
    rng = np.random.default_rng(0)
    for _ in range(40):
        goal = rng.normal(scale=4.0, size=3)
        eye = rng.normal(size=3)
        eye *= 60 / np.linalg.norm(eye)
        ray = (goal - eye) / np.linalg.norm(goal - eye)
        hit = clickable.hit(eye, ray[None])
        assert np.linalg.norm(np.cross(hit - eye, ray)) < 1e-3
        # a chord of a sphere, entered at the near end; facets lie a little inside of it
        along = -eye @ ray
        entry = along - np.sqrt(100 - (eye @ eye - along**2))
        assert np.linalg.norm(hit - eye) == pytest.approx(entry, abs=0.35)


def test_a_ray_beside_everything_meets_nothing(ball):
    clickable = Clickable(ball.vertices, ball.faces)
    assert clickable.hit(np.array([0, 0, 60.0]), np.array([[0, 1.0, 0]])) is None
    assert clickable.hit(np.array([0, 0, 60.0]), np.array([[0, 0, 1.0]])) is None


def test_a_click_through_a_slit_takes_its_edge():
    # two plates with a slit of 0.2 between them, and a wall 50 behind
    plates = [trimesh.creation.box((20, 10, 0.1)).apply_translation((0, y, 0)) for y in (5.1, -5.1)]
    wall = trimesh.creation.box((40, 40, 0.1)).apply_translation((0, 0, -50))
    whole = trimesh.util.concatenate([*plates, wall])
    clickable = Clickable(whole.vertices, whole.faces)
    eye, goals = np.array([0, 0, 100.0]), np.array([[0, 0, 0], [0, 0.5, 0], [0, -0.5, 0], [0, 3, 0]])
    rays = (goals - eye) / np.linalg.norm(goals - eye, axis=1, keepdims=True)
    assert clickable.hit(eye, rays)[2] == pytest.approx(-49.95, abs=0.01)
    np.testing.assert_allclose(clickable.hit(eye, rays, 5.0), [0, 0.5, 0.05], atol=0.01)
    # a wall no deeper than a slit may be is what was meant
    assert clickable.hit(eye, rays, 60.0)[2] == pytest.approx(-49.95, abs=0.01)


@pytest.mark.parametrize("unit", [0.001, 1.0, 40.0])
def test_shown_places_go_back_to_where_they_came_from(ball, unit):
    turn = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
    scan = Scan("ball", unit * (ball.vertices + np.array([500, 0, 3])), ball.faces)
    shown = ShownScan.of(scan, turn)
    assert np.ptp(shown.face.positions, axis=0).max() == pytest.approx(SHOWN_MM, rel=1e-5)
    places = scan.positions[::7]
    np.testing.assert_allclose(shown.original(shown.shown(places)), places, rtol=1e-6)
    np.testing.assert_allclose(shown.shown(places), shown.face.positions[::7], atol=1e-3)
    away = shown.shown(places)
    normals = shown.normals_at(away)
    assert (np.einsum("ij,ij->i", normals, away) > 0.9 * np.linalg.norm(away, axis=1)).all()


def test_a_fine_scan_is_shown_coarser_and_keeps_its_form():
    n = 420
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    positions = np.column_stack([x.ravel(), y.ravel(), 0.3 * np.sin(3 * x.ravel())])
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate([np.column_stack([corner, corner + 1, corner + n]),
                                np.column_stack([corner + 1, corner + n + 1, corner + n])])  # fmt: skip
    shown = ShownScan.of(Scan("sheet", positions, triangles))
    assert 20_000 < len(shown.face.triangles) <= MOST_TRIANGLES
    back = shown.original(shown.face.positions)
    np.testing.assert_allclose(back[:, 2], 0.3 * np.sin(3 * back[:, 0]), atol=1e-5)


def test_a_textured_scan_is_split_at_its_seams(ball):
    uv = np.random.default_rng(0).random((len(ball.faces), 3, 2)).astype(np.float32)
    shown = ShownScan.of(Scan("ball", ball.vertices, ball.faces, uv, np.zeros((4, 4, 3), np.uint8)))
    np.testing.assert_array_equal(shown.face.uv[shown.face.triangles], uv)
    np.testing.assert_allclose(shown.original(shown.face.positions[shown.face.triangles]),
                               ball.vertices[ball.faces], atol=1e-4)  # fmt: skip
