"""A rig's poses, and films of them, on the characters that come with the workstation."""

import numpy as np
import pytest

from app.pictures import STYLES, FaceRig, frames
from core.face.default_face import FaceUnavailable, default_face
from core.face.face import PARTS
from core.face.marker_placement import ACTRESS_FILE, load_marker_file, marker_set_on
from core.face.marker_units import load_marker_units
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks


@pytest.fixture(scope="module")
def units():
    """How each unit moves the 90 kept markers."""
    stored = load_marker_units()
    return {name: moves[stored.kept] for name, moves in zip(stored.names, stored.moves)}


@pytest.fixture(scope="module")
def rig():
    return rig_of("default")


def actress_markers():
    return marker_set_on(default_face(), load_marker_file(ACTRESS_FILE))


def rig_of(name):
    try:
        return FaceRig.of(name, actress_markers())
    except FaceUnavailable as error:
        pytest.skip(f"needs the faces: {error}")


def part_at(face, positions, x, y):
    """The part that a viewer in front sees at a place, lashes aside."""
    lashes = np.array([name.startswith("lashes") for name in PARTS])
    triangles = face.triangles[~lashes[face.part[face.triangles[:, 0]]]]
    corners = positions[triangles].astype(float)
    near = (np.abs(corners[:, :, 0] - x).min(axis=1) < 25) & (np.abs(corners[:, :, 1] - y).min(axis=1) < 25)
    near &= corners[:, :, 2].max(axis=1) > -20
    a, b, c = corners[near].transpose(1, 0, 2)
    ab, ac, ap = (b - a)[:, :2], (c - a)[:, :2], np.array([x, y]) - a[:, :2]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    area[np.abs(area) < 1e-12] = np.inf
    u = (ap[:, 0] * ac[:, 1] - ap[:, 1] * ac[:, 0]) / area
    v = (ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0]) / area
    hit = (u >= 0) & (v >= 0) & (u + v <= 1) & np.isfinite(area)
    depth = np.where(hit, a[:, 2] + u * (b - a)[:, 2] + v * (c - a)[:, 2], -np.inf)
    return PARTS[face.part[triangles[np.flatnonzero(near)[depth.argmax()], 0]]]


def seen_in_mouth(rig, positions):
    left, right = (positions[rig.face.landmarks[f"mouth_corner_{side}"]] for side in ("left", "right"))
    middle, half = (left + right) / 2, (left[0] - right[0]) / 2
    places = [(x, y) for x in np.linspace(-0.8, 0.8, 9) * half for y in np.linspace(-14, 8, 23)]
    return {part_at(rig.face, positions, middle[0] + x + 0.013, middle[1] + y + 0.007) for x, y in places}


@pytest.mark.parametrize("name", ["default", "otto", "pip"])
@pytest.mark.parametrize(
    "pose",
    [
        {},
        {"jawOpen": 0.2, "mouthClose": 0.2},
        {"mouthPressLeft": 0.7, "mouthPressRight": 0.7},
        {"mouthSmileLeft": 0.4, "mouthSmileRight": 0.4, "mouthPressLeft": 0.4, "mouthPressRight": 0.4},
        {"mouthRollLower": 0.3, "mouthRollUpper": 0.3},
    ],
    ids=["rest", "closed jaw open", "pressed", "smiling m", "rolled"],
)
def test_lips_that_close_for_p_b_m_do_not_cross_and_hide_the_teeth(units, name, pose):
    rig = rig_of(name)
    displacements = sum((weight * units[unit] for unit, weight in pose.items()), np.zeros_like(units["jawOpen"]))
    positions = rig.pose(displacements)
    # the upper lip's inner rim stays over the lower lip's
    assert rig.lips.gaps(positions - rig.face.positions).min() > -0.6
    assert seen_in_mouth(rig, positions) <= {"skin", "mouth_socket"}


def test_an_open_mouth_shows_the_upper_teeth(rig, units):
    positions = rig.pose(0.5 * units["jawOpen"] + 0.3 * (units["mouthUpperUpLeft"] + units["mouthUpperUpRight"]))
    assert {"upper_teeth", "tongue"} <= seen_in_mouth(rig, positions)


def test_a_head_track_moves_teeth_and_eyes_rigidly_and_commutes_with_the_mouth(rig, units):
    displacements = 0.4 * units["jawOpen"]
    still = rig.pose(displacements)
    moved = rig.pose(displacements, head=(np.array([0.05, 0.1, 0.0]), np.array([0.0, 1.0, 0.0])))
    for part in ("upper_teeth", "lower_teeth", "eye_left"):
        at = rig.face.vertices_of(part)
        before = np.linalg.norm(still[at][:, None] - still[at][None], axis=2)
        after = np.linalg.norm(moved[at][:, None] - moved[at][None], axis=2)
        np.testing.assert_allclose(after, before, atol=1e-3)
        assert np.linalg.norm(moved[at] - still[at], axis=1).min() > 0.5


def test_without_tracks_a_pose_is_what_the_markers_make(rig, units):
    displacements = 0.4 * units["jawOpen"]
    np.testing.assert_array_equal(rig.pose(displacements), rig.deform(displacements))


def film(rig, tracks, style="face"):
    markers = actress_markers()
    positions = np.repeat(markers.rest[None].astype(np.float32), 40, axis=0)
    motion = MarkerMotion(positions, 30.0, markers)
    return np.array(list(frames(motion, rig, style, 96, 96, tracks=tracks)))


def test_tracks_move_the_film_and_none_keeps_it_still(rig):
    phones = ["aa", "b", "iy", "k", "l", "aa"]
    said = Transcript(tuple(PhonemeUtterance(p, 0.2 * k, 0.2 * k + 0.2) for k, p in enumerate(phones)), (), 1.2)
    still = film(rig, None)
    assert (still == still[0]).all()
    moving = film(rig, PoseTracks.of(said, 30.0, 40))
    assert np.abs(moving[20].astype(int) - moving[0]).max() > 40
    quiet = film(rig, PoseTracks.of(said, 30.0, 40, head=False, gaze=False))
    assert np.abs(quiet[20].astype(int) - quiet[0]).max() < 40


@pytest.mark.parametrize("style", STYLES)
def test_each_style_draws_something_of_its_own(rig, style):
    shown = film(rig, None, style)[0]
    assert np.ptp(shown) > 60
