import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.binding import bind
from core.face.characters import CHARACTERS, character_names
from core.face.default_face import FaceUnavailable, character_face
from core.face.eyelids import Eyelids
from core.face.face import PARTS
from core.face.makehuman import LANDMARKS


@pytest.fixture(scope="module")
def faces():
    try:
        return {name: character_face(name) for name in CHARACTERS}
    except FaceUnavailable as error:
        pytest.skip(f"needs the faces: {error}")


def test_there_are_five_with_a_line_each_and_the_default_first():
    names = character_names()
    assert len(names) == 5
    assert next(iter(names)) == "default"
    assert all(line and "\n" not in line for line in names.values())


def test_they_share_triangles_parts_and_landmarks(faces):
    first = faces["default"]
    for face in faces.values():
        np.testing.assert_array_equal(face.triangles, first.triangles)
        np.testing.assert_array_equal(face.part, first.part)
        assert face.landmarks == first.landmarks
        assert set(face.landmarks) == set(LANDMARKS)
        assert set(face.units) == set(first.units)


def test_no_two_have_the_same_shape(faces):
    shapes = list(faces.values())
    for k, one in enumerate(shapes):
        for other in shapes[k + 1 :]:
            skin = one.vertices_of("skin")
            assert np.linalg.norm(one.positions[skin] - other.positions[skin], axis=1).mean() > 2.0


def test_markers_sit_on_the_same_vertices_of_all(faces, actress):
    marker_set, vertices = actress
    for face in faces.values():
        np.testing.assert_array_equal(bind(face, marker_set), vertices)


@pytest.mark.parametrize("name", CHARACTERS)
def test_at_rest_the_lips_touch_and_do_not_cross(faces, name):
    face = faces[name]
    upper, lower = (face.positions[face.landmarks[lip]] for lip in ("upper_lip", "lower_lip"))
    assert -0.1 < upper[1] - lower[1] < 3.0


@pytest.mark.parametrize("name", CHARACTERS)
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_blink_hides_the_eyeball(faces, actress, name, side):
    face = faces[name]
    marker_set, vertices = actress
    lids = Eyelids.of(face, vertices, marker_set)
    moved = np.zeros_like(face.positions)
    for lid in lids.lids:
        moved[lid.marker] = lid.blink_there
    lids.apply(moved)
    closed = face.positions + moved
    ball = face.positions[face.vertices_of(f"eye_{side}")]
    centre, radius = (ball.min(axis=0) + ball.max(axis=0)) / 2, np.ptp(ball[:, 0]) / 2

    def seen(positions):
        places = np.array([[x, y] for x in np.linspace(-0.6, 0.6, 9) for y in np.linspace(-0.6, 0.6, 17)]) * radius
        return np.mean([part_at(face, positions, centre[:2] + place) == f"eye_{side}" for place in places])

    assert seen(face.positions) > 0.1
    assert seen(closed) == 0.0


def part_at(face, positions, place):
    """The part that a viewer in front sees at (x, y), lashes aside."""
    lash = np.isin(face.part, [PARTS.index(name) for name in PARTS if name.startswith("lashes")])
    triangles = face.triangles[~lash[face.triangles[:, 0]]]
    corners = positions[triangles].astype(float)
    near = (corners[:, :, :2].min(axis=1) <= place).all(axis=1) & (corners[:, :, :2].max(axis=1) >= place).all(axis=1)
    near &= corners[:, :, 2].max(axis=1) > 0
    a, b, c = corners[near].transpose(1, 0, 2)
    ab, ac, ap = (b - a)[:, :2], (c - a)[:, :2], place - a[:, :2]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    area[np.abs(area) < 1e-12] = np.inf
    u = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / area
    v = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / area
    hit = (u >= 0) & (v >= 0) & (u + v <= 1) & np.isfinite(area)
    rows = np.flatnonzero(near)[hit]
    depth = (a[:, 2] + u * (b - a)[:, 2] + v * (c - a)[:, 2])[hit]
    return PARTS[face.part[triangles[rows[depth.argmax()], 0]]]


def test_an_unknown_name_is_one_sentence():
    with pytest.raises(UserFacingError, match="no character 'nobody'"):
        character_face("nobody")
