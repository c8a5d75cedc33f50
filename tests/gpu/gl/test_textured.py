"""The style that paints the skin: a user's picture, or procedural skin, brows and hair."""

from dataclasses import replace

import numpy as np
import pytest

from core.face.look import Look
from gpu.gl.camera import Camera
from gpu.gl.face import FaceRenderer, Style
from gpu.gl.surfaces import KINDS, kind_of_triangles

FRONT = Camera.front(np.array([[-90.0, -90, -90], [90, 90, 90]]))


@pytest.fixture
def renderer(offscreen):
    made = FaceRenderer(offscreen.ctx)
    yield made
    made.release()


@pytest.fixture
def mapped(head):
    """The head with texture coordinates: u from its right to its left, v from below to above."""
    return replace(head, uv=((head.positions[:, :2] / 80.0 + 1.0) / 2.0).astype(np.float32))


def picture(offscreen, renderer, style=Style.TEXTURED):
    return offscreen.frame(lambda framebuffer: renderer.draw(framebuffer, FRONT, style)).astype(int)


def test_a_users_picture_gives_its_colours_where_the_coordinates_put_them(offscreen, renderer, mapped):
    quarters = np.zeros((64, 64, 3), np.uint8)
    quarters[:32, :32] = 40, 200, 40  # above, on the character's right, which the viewer sees on the left
    quarters[:32, 32:] = 40, 40, 210
    quarters[32:] = 200, 40, 40
    renderer.set_face(mapped)
    renderer.set_texture(quarters)
    seen = picture(offscreen, renderer)
    left, right, below = seen[45, 95], seen[45, 145], seen[130, 120]
    assert left.argmax() == 1
    assert left[1] > 1.5 * max(left[0], left[2])
    assert right.argmax() == 2
    assert below.argmax() == 0
    assert below[0] > 1.5 * below[1]


def test_plain_shading_leaves_the_picture_out_and_taking_it_away_brings_skin_back(offscreen, renderer, mapped):
    renderer.set_face(mapped)
    skin = picture(offscreen, renderer)
    renderer.set_texture(np.full((8, 8, 3), (20, 230, 20), np.uint8))
    assert picture(offscreen, renderer, Style.SHADED)[90, 120].argmax() == 0
    assert picture(offscreen, renderer)[90, 120].argmax() == 1
    renderer.set_texture(None)
    np.testing.assert_array_equal(picture(offscreen, renderer), skin)


def test_without_coordinates_a_picture_changes_nothing(offscreen, renderer, head):
    renderer.set_face(head)
    skin = picture(offscreen, renderer)
    renderer.set_texture(np.full((8, 8, 3), (20, 230, 20), np.uint8))
    np.testing.assert_array_equal(picture(offscreen, renderer), skin)


def test_what_is_no_picture_is_refused(renderer):
    for wrong in (np.zeros((4, 4, 4), np.uint8), np.zeros((4, 4, 3)), np.zeros((4, 4), np.uint8)):
        with pytest.raises(ValueError, match="a texture is uint8"):
            renderer.set_texture(wrong)


def test_procedural_skin_varies_about_the_plain_one(offscreen, renderer, head):
    renderer.set_face(head)
    inside = np.s_[105:150, 95:145]  # below the eyes
    plain, varied = picture(offscreen, renderer, Style.SHADED)[inside], picture(offscreen, renderer)[inside]
    assert np.abs(varied.mean(axis=(0, 1)) - plain.mean(axis=(0, 1))).max() < 12
    assert np.diff(varied[:, :, 0], axis=1).std() > 1.5 * np.diff(plain[:, :, 0], axis=1).std()


def test_a_look_decides_the_colour_of_the_skin(offscreen, renderer, head):
    renderer.set_face(replace(head, look=Look(skin=(0.2, 0.09, 0.05))))
    dark = picture(offscreen, renderer)[90, 120]
    renderer.set_face(head)
    assert (dark < picture(offscreen, renderer)[90, 120] - 30).all()


def test_hair_covers_what_lies_under_the_hairline_and_stands_off_the_scalp(offscreen, renderer, head):
    masks = {"hair": np.clip(head.positions[:, 1] - 30.0, -30.0, 30.0)}
    bald = replace(head, masks=masks, look=Look(hair_mm=0.0))
    haired = replace(head, masks=masks, look=Look(hair_mm=8.0, hair=(0.01, 0.01, 0.05)))
    renderer.set_face(bald)
    before = picture(offscreen, renderer)
    renderer.set_face(haired)
    after = picture(offscreen, renderer)
    top = np.flatnonzero(before[:, 120].sum(axis=1) > 150)[0]
    assert after[top + 6, 120].sum() < 0.6 * before[top + 6, 120].sum()
    np.testing.assert_allclose(after[120, 100:140], before[120, 100:140], atol=30)
    # the crown rises by about 8 mm, 6 px here
    assert np.abs(after[top - 4, 120] - before[top - 4, 120]).max() > 5


def test_each_triangle_belongs_to_one_surface(head):
    kind = kind_of_triangles(head, head.triangles)
    names = [KINDS[number] for number in np.unique(kind)]
    assert names == ["skin", "eyes"]
    eyes = np.isin(head.part[head.triangles[:, 0]], [1, 2])
    np.testing.assert_array_equal(kind == KINDS.index("eyes"), eyes)
