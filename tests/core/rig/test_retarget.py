"""Marker motion made of known controls comes back as those controls, on the characters that are on this machine."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.default_face import FaceUnavailable, character_face
from core.face.marker_placement import ACTRESS_FILE, load_marker_file, marker_set_on
from core.rig.control_track import ControlTrack
from core.rig.key_poses import default_poses
from core.rig.retarget import controls_of_motion
from core.rig.rig import Rig, posed
from core.synthesis.marker_motion import MarkerMotion
from tests.core.rig.small_rigs import small_rig

SPOKEN = ("jawOpen", "mouthFunnel", "mouthPucker", "mouthSmileLeft", "mouthSmileRight", "mouthLowerDownLeft",
          "mouthLowerDownRight", "browInnerUp")  # fmt: skip


@pytest.fixture(scope="module")
def face():
    try:
        return character_face("default", download=False)
    except FaceUnavailable as error:
        pytest.skip(f"needs the faces: {error}")


def markers_moved_by(face, track):
    placement = load_marker_file(ACTRESS_FILE)
    markers = marker_set_on(face, placement)
    vertices = placement.vertices[placement.kept]
    moved = posed(Rig.of(face), track)[:, vertices] - face.positions[vertices]
    return MarkerMotion((markers.rest + moved).astype(np.float32), 60.0, markers)


def test_controls_are_found_again_under_the_markers_that_they_moved(face):
    values = np.random.default_rng(4).uniform(0, 0.7, (30, len(SPOKEN)))
    motion = markers_moved_by(face, ControlTrack(SPOKEN, values, 60.0))
    found = controls_of_motion(motion, face)
    assert found.rate_hz == 60.0 and not found.beyond()
    again = markers_moved_by(face, found)
    # units that look alike at the markers may share; what they do to the markers is what counts
    assert np.linalg.norm(again.positions - motion.positions, axis=2).max() < 0.5
    assert np.abs(found.arranged(SPOKEN).values - values)[:, :3].mean() < 0.05


def test_key_lip_shapes_are_posed_as_they_were_captured(face):
    values = np.eye(3)[:, [0, 1, 2, 2, 2, 2, 2, 2]] * 0.6
    values[:, 3:] = 0
    motion = markers_moved_by(face, ControlTrack(SPOKEN, values, 60.0))
    lips = motion.markers.group("lips")
    poses = default_poses(face, motion.markers, lips, motion.displacements[:, lips])
    for n, unit in enumerate(SPOKEN[:3]):
        assert poses.controls[poses.values[n].argmax()] == unit


def test_a_face_without_shapes_is_refused(face):
    from dataclasses import replace

    sheet = small_rig().face
    motion = markers_moved_by(face, ControlTrack(SPOKEN, np.zeros((1, len(SPOKEN))), 60.0))
    with pytest.raises(UserFacingError, match="no shapes"):
        controls_of_motion(motion, replace(sheet, units={}))
