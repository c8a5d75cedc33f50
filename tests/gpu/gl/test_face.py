"""What is seen of a face, its wireframe and its markers."""

from dataclasses import replace

import numpy as np
import pytest

from core.face.face import PARTS, Face
from gpu.gl.camera import Camera
from gpu.gl.face import FaceRenderer, Style
from gpu.gl.face_arrays import FaceArrays

BOUNDS = np.array([[-90.0, -90, -90], [90, 90, 90]])
FRONT = Camera.front(BOUNDS)


@pytest.fixture
def renderer(offscreen):
    made = FaceRenderer(offscreen.ctx)
    yield made
    made.release()


def picture(offscreen, renderer, camera=FRONT, style=Style.SHADED, **settings):
    return offscreen.frame(lambda framebuffer: renderer.draw(framebuffer, camera, style, **settings)).astype(int)


def pixel(camera, point, width=240, height=180):
    """Column and row where a point is seen."""
    clip = camera.projection(width / height) @ camera.view(width / height) @ [*point, 1.0]
    return int((clip[0] / clip[3] + 1) / 2 * width), int((1 - clip[1] / clip[3]) / 2 * height)


def test_skin_is_warm_and_bright_on_a_dark_quiet_ground(offscreen, renderer, head):
    renderer.set_face(head)
    seen = picture(offscreen, renderer)
    x, y = pixel(FRONT, (0, 0, 80))
    red, green, blue = seen[y, x]
    assert red > green > blue > 60
    assert seen[2, 2].max() < 50
    assert np.ptp(seen[:20, :20], axis=(0, 1)).max() < 12


def test_every_pixel_is_opaque(offscreen, renderer, head):
    renderer.set_face(head)
    renderer.set_markers(np.array([[0.0, 0, 85]]))
    for style in Style:
        rgba = []

        def draw_and_read(framebuffer, style=style, rgba=rgba):
            renderer.draw(framebuffer, FRONT, style, show_markers=True)
            rgba.append(np.frombuffer(framebuffer.read(components=4), np.uint8).reshape(-1, 4))

        offscreen.frame(draw_and_read)
        assert (rgba[0][:, 3] == 255).all()


def test_an_eye_has_a_pupil_in_a_white_ball(offscreen, renderer, head):
    renderer.set_face(head)
    near = replace(FRONT, target_mm=(35.0, 20.0, 0.0)).zoomed(3)
    seen = picture(offscreen, renderer, near)
    x, y = pixel(near, (35, 19, 89))
    white, _ = pixel(near, (35 + 10.5, 20, 84))
    assert seen[y - 1 : y + 2, x - 1 : x + 2].mean() < 60
    assert seen[y, white].min() > 90


def test_without_a_face_the_markers_are_shown(offscreen, renderer):
    place = np.array([[20.0, -10, 30]])
    renderer.set_markers(place, colours=np.array([[0.2, 0.9, 0.3]]))
    seen = picture(offscreen, renderer)
    x, y = pixel(FRONT, place[0])
    assert seen[y, x, 1] > 120
    assert seen[y, x, 1] > 2 * seen[y, x, 0]


def test_markers_style_hides_the_face_and_shaded_hides_markers_unless_asked(offscreen, renderer, head):
    renderer.set_face(head)
    place = np.array([[0.0, -30, 76]])
    renderer.set_markers(place, colours=(0.1, 0.3, 1.0))
    x, y = pixel(FRONT, place[0])
    alone = picture(offscreen, renderer, style=Style.MARKERS)
    assert alone[y, x, 2] > alone[y, x, 0] + 60
    assert alone[y + 15, x].max() < 60
    bare = picture(offscreen, renderer)
    assert bare[y, x, 0] > bare[y, x, 2]
    both = picture(offscreen, renderer, show_markers=True)
    assert both[y, x, 2] > both[y, x, 0] + 60


def test_a_missing_marker_is_not_drawn_and_its_links_neither(offscreen, renderer):
    places = np.array([[-40.0, 0, 0], [40.0, 0, 0], [np.nan, 0, 0]])
    renderer.set_markers(places, links=np.array([[0, 2]]))
    seen = picture(offscreen, renderer, style=Style.MARKERS)
    x, y = pixel(FRONT, (0, 0, 0))
    assert seen[y - 3 : y + 4, x - 30 : x + 30].max() < 70
    renderer.set_markers(np.nan_to_num(places, nan=40.0))
    linked = picture(offscreen, renderer, style=Style.MARKERS)
    assert (linked - seen)[y - 3 : y + 4, x - 30 : x + 30].max() > 30


def test_the_number_of_markers_may_change(offscreen, renderer):
    for n in (3, 300, 0, 60):
        renderer.set_markers(np.random.default_rng(n).uniform(-60, 60, (n, 3)))
        bright = picture(offscreen, renderer, style=Style.MARKERS).max()
        assert (bright > 150) == (n > 0)


def test_a_moved_vertex_moves_in_the_picture_and_back(offscreen, renderer, head):
    renderer.set_face(head)
    rest = picture(offscreen, renderer)
    renderer.set_positions(head.positions * np.float32(0.8))
    small = picture(offscreen, renderer)
    assert ((rest > 60).sum() - (small > 60).sum()) > 0.2 * (rest > 60).sum()
    renderer.set_positions(head.positions)
    np.testing.assert_array_equal(picture(offscreen, renderer), rest)


def test_an_inside_out_mesh_looks_the_same(offscreen, renderer, head):
    renderer.set_face(head)
    right = picture(offscreen, renderer)
    renderer.set_face(Face("turned", head.positions, head.triangles[:, ::-1], head.part))
    assert np.abs(picture(offscreen, renderer) - right).mean() < 1


def test_the_wireframe_shows_quads_without_their_diagonals(offscreen, renderer):
    side = np.array([[-60, -60, 0], [60, -60, 0], [60, 60, 0], [-60, 60, 0]], np.float32)
    renderer.set_face(Face("plate", side, np.array([[0, 1, 2], [0, 2, 3]], np.int32), np.zeros(4, np.uint8)))
    seen = picture(offscreen, renderer, style=Style.WIREFRAME).sum(axis=2)
    x, y = pixel(FRONT, (0, 0, 0))
    top = pixel(FRONT, (0, 60, 0))[1]
    assert seen[top - 2 : top + 3, x].max() > 2 * seen[y, x]
    assert seen[y - 8 : y + 9, x - 8 : x + 9].max() < 1.2 * seen[y, x]


def test_lips_are_redder_where_given(offscreen, renderer, head):
    lips = (head.positions[:, 1] < -20).astype(np.float32) * (head.part == PARTS.index("skin"))
    renderer.set_face(head, lips)
    painted = picture(offscreen, renderer)
    renderer.set_face(head)
    plain = picture(offscreen, renderer)
    x, y = pixel(FRONT, (0, -50, 62))
    assert painted[y, x, 1] / painted[y, x, 0] < plain[y, x, 1] / plain[y, x, 0] - 0.1
    x, y = pixel(FRONT, (0, 30, 74))
    np.testing.assert_array_equal(painted[y, x], plain[y, x])


def test_wrong_shapes_are_refused(renderer, head):
    with pytest.raises(ValueError, match="set_face"):
        renderer.set_positions(head.positions)
    renderer.set_face(head)
    with pytest.raises(ValueError, match="shape"):
        renderer.set_positions(head.positions[1:])
    with pytest.raises(ValueError, match="shape"):
        renderer.set_markers(np.zeros(3))


def test_a_released_renderer_leaves_the_context_to_the_next(offscreen, head):
    pictures = []
    for _ in range(3):
        made = FaceRenderer(offscreen.ctx)
        made.set_face(head)
        pictures.append(picture(offscreen, made))
        made.release()
    np.testing.assert_array_equal(pictures[0], pictures[2])
    assert offscreen.ctx.error == "GL_NO_ERROR"


def _drawn(offscreen, head, new_at_most=None, arrays=None):
    """Return what each call drew until one was whole."""
    renderer, told, pictures = FaceRenderer(offscreen.ctx), [], []
    renderer.set_face(head, arrays=arrays)
    camera = Camera.front(np.stack([head.positions.min(axis=0), head.positions.max(axis=0)]))

    def draw(frame):
        told.append(renderer.draw(frame, camera, Style.TEXTURED, new_at_most=new_at_most))

    while not told or not told[-1]:
        pictures.append(offscreen.frame(draw))
    renderer.release()
    return pictures


def test_a_shader_at_a_time_ends_in_the_same_picture(offscreen, head):
    """Until then the picture holds the backdrop alone, so nobody sees half a face."""
    (at_once,), (*before, at_last) = _drawn(offscreen, head), _drawn(offscreen, head, new_at_most=1)
    assert (at_last == at_once).all()
    assert before and all((picture == before[0]).all() for picture in before)
    assert (before[0] != at_once).any()


def test_arrays_worked_out_elsewhere_draw_the_same(offscreen, head):
    (own,), (given,) = _drawn(offscreen, head), _drawn(offscreen, head, arrays=FaceArrays.of(head))
    assert (own == given).all()


def test_lines_over_a_picture_are_of_one_colour_and_leave_the_rest(offscreen, renderer, head):
    renderer.set_face(head)
    before, colour = picture(offscreen, renderer), np.array([40.0, 230.0, 120.0])

    def over(framebuffer):
        renderer.draw(framebuffer, FRONT, Style.SHADED)
        renderer.draw_lines_over(framebuffer, FRONT, tuple(colour / 255))

    seen = offscreen.frame(over).astype(int)
    changed = np.abs(seen - before).max(axis=2) > 3
    inside = np.zeros_like(changed)
    inside[4:176, 40:200] = True  # the ball, not the studio
    assert 0.03 < changed[inside].mean() < 0.9 and not changed[~inside].any()
    way = colour - before[changed]
    share = ((seen[changed] - before[changed]) * way).sum(axis=1) / (way**2).sum(axis=1)
    np.testing.assert_allclose(seen[changed], before[changed] + share[:, None] * way, atol=3)
    assert (picture(offscreen, renderer) == before).all()  # nothing of it stays behind
