"""Weights move markers by their units, and nothing else moves."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.blendshape_drive import markers_of_blendshapes
from core.face.face import Face
from core.face.marker_placement import MarkerPlacement
from core.face.marker_units import load_marker_units, marker_units_of
from core.motion.blendshape_track import ARKIT_UNITS, BlendshapeTrack
from core.motion.readers.blendshape_files import read_blendshapes
from core.motion.shape_mapping import mapped, read_shape_mapping


def small_face() -> tuple[Face, MarkerPlacement]:
    chance = np.random.default_rng(1)
    units = {name: chance.normal(size=(10, 3)).astype(np.float32) for name in ("jawOpen", "mouthLeft", "cheekPuff")}
    positions = chance.normal(scale=50, size=(10, 3)).astype(np.float32)
    face = Face("small", positions, np.array([[0, 1, 2]], np.int32), np.zeros(10, np.uint8), units=units)
    placement = MarkerPlacement(("a", "b", "c"), np.array([2, 5, 7]), np.array([True, False, True]), {"origin": ("a",)})
    return face, placement


def track(weights, names) -> BlendshapeTrack:
    return BlendshapeTrack(np.asarray(weights, np.float32), names, 30.0)


def test_a_marker_is_where_its_vertex_goes():
    face, placement = small_face()
    weights = np.random.default_rng(2).uniform(0, 1, (6, 3))
    weights[4] = np.nan
    moving = track(weights, ("mouthLeft", "tongueOut", "jawOpen"))
    motion = markers_of_blendshapes(moving, marker_units_of(face, placement))
    for f in (0, 3, 5):
        by_hand = weights[f, 0] * face.units["mouthLeft"] + weights[f, 2] * face.units["jawOpen"]
        vertices = face.positions + by_hand
        np.testing.assert_allclose(motion.positions[f], (vertices - face.positions[2])[[2, 7]], atol=1e-4)
    assert motion.names == ("a", "c") and motion.rate_hz == 30.0
    assert np.isnan(motion.positions[4]).all()
    assert "tongueOut" in motion.notes[0]


def test_no_weight_is_the_rest_pose_of_the_actress():
    units = load_marker_units()
    motion = markers_of_blendshapes(track(np.zeros((2, 52)), ARKIT_UNITS), units)
    np.testing.assert_allclose(motion.positions[1], units.markers.rest[units.kept], atol=1e-4)
    everything = markers_of_blendshapes(track(np.zeros((2, 52)), ARKIT_UNITS), units, kept_only=False)
    assert everything.positions.shape == (2, 102, 3) and motion.positions.shape == (2, 90, 3)


def test_an_open_jaw_lowers_the_chin_and_leaves_the_forehead():
    units = load_marker_units()
    motion = markers_of_blendshapes(track([[0.0], [1.0]], ("jawOpen",)), units)
    moved = dict(zip(motion.names, motion.positions[1] - motion.positions[0]))
    chin = units.markers.landmarks["chin"]
    assert moved[chin][1] < -10.0
    assert np.abs(moved["forehead_mid"]).max() < 0.5


def test_shapes_that_no_unit_of_the_face_matches_are_refused():
    face, placement = small_face()
    strange = track(np.zeros((2, 1)), ("smirk",))
    with pytest.raises(UserFacingError, match="smirk") as caught:
        markers_of_blendshapes(strange, marker_units_of(face, placement))
    assert "maps" in caught.value.remedy


def test_facegood_opens_the_mouth_of_the_default_face_as_it_opens_its_own(shared_data):
    """Its own jaw weight against the gap between the lips' markers, which the mapping must carry over."""
    folder = shared_data("facegood")
    names = folder / "shirley_1015_bs_name.npy"
    own = read_blendshapes(folder / "bs_value" / "bs_value_1114_3_15.npy", names, 30.0)
    moving = mapped(own, read_shape_mapping(folder / "Voice2Face_blendshape2ARkit.xlsx"))
    units = load_marker_units()
    motion = markers_of_blendshapes(moving, units)
    row = {name: k for k, name in enumerate(motion.names)}
    upper, lower = (units.markers.landmarks[name] for name in ("upper_lip", "lower_lip"))
    gap_mm = motion.positions[:, row[upper], 1] - motion.positions[:, row[lower], 1]
    opened = own.weights[:, own.names.index("mouth_stretch_c")]
    assert np.corrcoef(gap_mm, opened)[0, 1] > 0.9
    assert np.ptp(gap_mm) > 5.0
    forehead = motion.positions[:, row["forehead_mid"]]
    assert np.ptp(forehead, axis=0).max() < 0.5
