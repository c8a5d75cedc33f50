from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.face import own_face_photo
from core.face.face import PARTS
from core.face.own_face_photo import PhotoCamera, fit_camera, photo_texture, without_light
from core.face.own_face_points import generic_points
from core.face.own_face_raster import covered_pixels
from core.face.own_face_scan import Scan
from core.face.own_face_texture import (
    SkinTexels,
    distance_texture,
    heat,
    sampled,
    scan_colours,
    scan_texture,
    unwrapped,
)

SIZE = 192


@pytest.fixture(scope="module")
def uv(face):
    return unwrapped(face)


@pytest.fixture(scope="module")
def skin(face):
    return face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]


def paint(places):
    """A colour for every place: what a texture must bring back."""
    x, y, z = np.asarray(places, float).T
    return np.clip(np.column_stack([128 + x, 128 + 0.7 * y, 128 + 0.7 * z]), 0, 255)


def test_the_unwrapping_has_no_seams_and_is_the_same_on_both_sides(face, uv, skin):
    assert ((uv >= 0) & (uv <= 1)).all()
    edges = np.ptp(uv[skin], axis=1).max(axis=1)
    in_front = face.positions[skin].mean(axis=1)[:, 2] > -60
    assert edges[in_front].max() < 0.08
    # a place on the middle line is in the middle of the picture
    middle = np.abs(face.positions[:, 0]) < 0.01
    np.testing.assert_allclose(uv[middle, 0], 0.5, atol=1e-3)


def test_a_texture_shows_the_scans_colours_where_they_are(face, uv, skin):
    scan = Scan("s", face.positions.astype(float), skin.astype(int), colours=paint(face.positions).astype(np.uint8))
    texture = scan_texture(face, uv, scan, SIZE)
    seen = face.vertices_of("skin")
    seen = seen[(face.positions[seen, 2] > -20) & (face.positions[seen, 1] > -90)]
    at = np.stack([(1 - uv[seen, 1]) * SIZE - 0.5, uv[seen, 0] * SIZE - 0.5])
    off = np.abs(sampled(texture, at) - paint(face.positions[seen])).max(axis=1)
    assert np.median(off) < 3
    assert np.quantile(off, 0.95) < 12


def test_holes_of_a_scan_take_the_colours_around_them(face, uv, skin):
    hole = np.linalg.norm(face.positions[skin].mean(axis=1) - [45, -40, 10], axis=1) < 15
    grey = np.full((len(face.positions), 3), 90, np.uint8)
    texture = scan_texture(
        face, uv, Scan("s", face.positions.astype(float), skin[~hole].astype(int), colours=grey), SIZE
    )
    assert texture.min() == texture.max() == 90


def test_colours_of_a_picture_are_read_between_its_pixels_and_repeat():
    picture = np.zeros((4, 8, 3), np.uint8)
    picture[:, :, 0] = 20 * np.arange(8)
    picture[:, :, 1] = 50 * np.arange(4)[:, None]
    corner_uv = np.array([[[0.25, 0.5], [0.5, 0.5], [0.25, 0.75]]], np.float32)
    scan = Scan("s", np.zeros((3, 3)), np.array([[0, 1, 2]]), corner_uv, picture)
    colours = scan_colours(scan, np.zeros(3, int), np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1]]))
    np.testing.assert_allclose(colours[:, 0], [30, 70, 30])  # 8 u - 0.5 pixels from the left
    np.testing.assert_allclose(colours[:, 1], [75, 75, 25])  # v counts from below
    beyond = replace(scan, corner_uv=corner_uv + np.array([3.0, -2.0], np.float32))
    np.testing.assert_allclose(scan_colours(beyond, np.zeros(3, int), np.eye(3)), colours, atol=1e-3)
    nothing = replace(scan, corner_uv=np.full((1, 3, 2), np.nan, np.float32))
    assert np.isfinite(scan_colours(nothing, np.zeros(3, int), np.eye(3))).all()


def test_the_map_of_distances_is_green_near_red_far_and_grey_where_nothing_is_known(face, uv):
    far, near, unknown = heat(np.array([9.0, 0.0, np.nan]), 2.0)
    assert far[0] > 2 * far[1]
    assert near[1] > near[0]
    assert np.ptp(unknown) < 8
    to_scan = np.where(face.positions[:, 0] > 0, 5.0, 0.0)
    texture = distance_texture(face, uv, to_scan, 2.0, 64).astype(int)
    left, right = texture[32, 40], texture[32, 24]
    assert left[0] > left[1]
    assert right[1] > right[0]


TRUE = PhotoCamera(
    Rotation.from_euler("yx", [18, -7], degrees=True).as_matrix(), np.array([12.0, 20.0, -900.0]), 2100.0,
    np.array([400.0, 500.0]), 0.0,
)  # fmt: skip


def test_the_camera_is_found_that_sees_the_points(face):
    places = generic_points(face)
    seen = TRUE.seen(np.array(list(places.values())))[0]
    found = fit_camera(places, dict(zip(places, seen)), (800, 1000))
    assert found.error_px < 1.0
    everywhere = face.positions[::50].astype(float)
    np.testing.assert_allclose(found.seen(everywhere)[0], TRUE.seen(everywhere)[0], atol=6.0)
    noisy = dict(zip(places, seen + np.random.default_rng(0).normal(scale=2.0, size=seen.shape)))
    off = np.linalg.norm(fit_camera(places, noisy, (800, 1000)).seen(everywhere)[0] - TRUE.seen(everywhere)[0], axis=1)
    assert np.median(off) < 4.0


def test_points_that_no_camera_sees_are_one_sentence(face):
    places = generic_points(face)
    seen = dict(zip(places, TRUE.seen(np.array(list(places.values())))[0]))
    with pytest.raises(UserFacingError, match="has 3 of the points, and 6 are needed"):
        fit_camera(places, dict(list(seen.items())[:3]), (800, 1000))
    with pytest.raises(UserFacingError, match="chin lies outside of the photo"):
        fit_camera(places, {**seen, "chin": np.array([-4.0, 20])}, (800, 1000))
    shuffled = dict(zip(seen, np.random.default_rng(0).permutation(list(seen.values()))))
    with pytest.raises(UserFacingError, match="No camera sees the points"):
        fit_camera(places, shuffled, (800, 1000))


def test_a_photo_is_laid_where_the_camera_saw_it_and_mirrored_where_it_did_not(face, uv, skin, monkeypatch):
    # these colours change with the place as light does
    monkeypatch.setattr(own_face_photo, "without_light", lambda colours, normals, sure: colours)
    turned = turned_camera(50)  # from the character's left, so that the right cheek is hidden
    width, height = 400, 500
    at, depth = turned.seen(face.positions.astype(float))
    owner, bary = covered_pixels(at[skin], width, height, depth[skin])
    places = np.einsum("hwk,hwkx->hwx", bary, face.positions[skin[owner]])
    # a colour that is the same on both sides, as a face's is
    photo = np.where(owner[..., None] >= 0, paint(np.abs(places.reshape(-1, 3))).reshape(places.shape), 0)
    texture = photo_texture(face, uv, photo.astype(np.uint8), turned, SIZE)
    for key in ("cheek_left", "cheek_right", "nose_tip"):
        vertex = face.landmarks[key]
        place = np.array([[(1 - uv[vertex, 1]) * SIZE - 0.5], [uv[vertex, 0] * SIZE - 0.5]])
        np.testing.assert_allclose(sampled(texture, place)[0], paint(np.abs(face.positions[vertex][None]))[0], atol=14)
    assert texture.min() > 10  # nothing of the ground behind the head


def test_the_light_of_a_photo_goes_and_dark_brows_stay():
    rng = np.random.default_rng(4)
    normals = rng.normal(size=(8000, 3))
    normals[:, 2] = np.abs(normals[:, 2])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = 0.35 + 0.65 * np.clip(normals @ [0.6, 0.5, 0.62], 0, 1)
    skin = np.array([180.0, 130.0, 110.0])
    brow = rng.random(8000) < 0.08
    colours = light[:, None] * np.where(brow[:, None], 0.3 * skin, skin)
    flat = without_light(colours, normals, np.ones(8000))
    spread = [np.log(c[~brow]).std(axis=0).max() for c in (colours, flat)]
    assert spread[1] < 0.5 * spread[0]
    assert np.median(flat[brow]) < 0.45 * np.median(flat[~brow])
    np.testing.assert_array_equal(without_light(colours, normals, np.zeros(8000)), colours)


def turned_camera(degrees):
    turn = Rotation.from_euler("y", -degrees, degrees=True).as_matrix()
    return PhotoCamera(turn, np.array([0.0, 40.0, -1000.0]), 1100.0, np.array([200.0, 250.0]), 0.0)


def test_every_pixel_of_the_skin_knows_its_place(face, uv):
    texels = SkinTexels(face, uv, 96)
    middle = texels.mixed(uv.astype(float)) * 96
    np.testing.assert_allclose(middle, np.column_stack([texels.columns + 0.5, 96 - texels.rows - 0.5]), atol=0.02)
