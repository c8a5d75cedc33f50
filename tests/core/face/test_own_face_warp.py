import numpy as np
import pytest
from scipy.interpolate import RBFInterpolator
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.face.own_face_points import feature_points
from core.face.own_face_warp import LandmarkWarp, check_on_surface, doubtful_points, place_scan

# A head in mm, roughly: not our own table, so that the tests stand by themselves.
HEAD = {
    "outer_eye_right": (-42, 0, 10), "inner_eye_right": (-15, -3, 13), "inner_eye_left": (15, -3, 13),
    "outer_eye_left": (42, 0, 10), "nose_bridge": (0, 0, 25), "nose_tip": (0, -33, 42),
    "mouth_corner_right": (-23, -62, 22), "mouth_corner_left": (23, -62, 22), "lips_meet": (0, -62, 31),
    "chin": (0, -86, 24), "ear_lobe_right": (-70, -46, -62), "ear_lobe_left": (70, -46, -62),
}  # fmt: skip
HEAD = {key: np.array(place, float) for key, place in HEAD.items()}
TURN = Rotation.from_euler("xyz", [80, -25, 170], degrees=True).as_matrix()


def scanned(unit_mm=1.0, turn=TURN, shift=(900.0, -40.0, 3.0)):
    return {key: (turn @ place) / unit_mm + shift for key, place in HEAD.items()}


def test_every_point_is_met_exactly():
    rng = np.random.default_rng(0)
    source, target = rng.normal(scale=60, size=(20, 3)), rng.normal(scale=60, size=(20, 3))
    warp = LandmarkWarp.of(source, target)
    np.testing.assert_allclose(source + warp.displacement(source), target, atol=1e-8)


def test_the_warp_is_scipys_own():
    rng = np.random.default_rng(1)
    source = rng.normal(scale=60, size=(15, 3))
    target = source + rng.normal(scale=8, size=(15, 3))
    points = rng.normal(scale=90, size=(40, 3))
    theirs = RBFInterpolator(source, target - source, kernel="linear", degree=1)(points)
    np.testing.assert_allclose(LandmarkWarp.of(source, target).displacement(points), theirs, atol=1e-8)


def test_a_stretched_head_is_stretched_everywhere_alike():
    source = np.array(list(HEAD.values()))
    stretch = np.array([[1.2, 0.1, 0], [0, 0.9, 0], [0, 0, 1.1]])
    warp = LandmarkWarp.of(source, source @ stretch.T + 5.0)
    far = np.array([[0.0, 150, -200], [300, 0, 0]])
    np.testing.assert_allclose(far + warp.displacement(far), far @ stretch.T + 5.0, atol=1e-6)


def test_points_in_a_plane_leave_the_depth_of_the_head_alone():
    flat = np.column_stack([np.random.default_rng(2).normal(scale=50, size=(12, 2)), np.zeros(12)])
    warp = LandmarkWarp.of(flat, flat + np.array([3.0, 0, 0]))
    np.testing.assert_allclose(warp.displacement(np.array([[0.0, 0, -150]])), [[3.0, 0, 0]], atol=1e-8)


@pytest.mark.parametrize("unit_mm", [1.0, 10.0, 25.4, 100.0, 1000.0])
def test_a_scan_in_any_unit_and_posture_is_laid_on_the_generic_face_at_its_own_size(unit_mm):
    bigger = {key: 1.1 * place for key, place in scanned(unit_mm, shift=(0, 0, 0)).items()}
    placement = place_scan(bigger, HEAD)
    assert placement.scale == unit_mm
    np.testing.assert_allclose(placement.rotation, TURN.T, atol=1e-9)
    placed = placement(np.array(list(bigger.values())))
    middle = np.array(list(HEAD.values())).mean(axis=0)
    np.testing.assert_allclose(placed - middle, 1.1 * (np.array(list(HEAD.values())) - middle), atol=1e-6)


def test_a_scan_in_no_known_unit_takes_the_generic_faces_size():
    placement = place_scan(scanned(3.0), HEAD)
    assert placement.scale == pytest.approx(3.0)


def test_what_cannot_be_a_head_is_one_sentence():
    mirrored = {key.replace("left", "?").replace("right", "left").replace("?", "right"): p for key, p in HEAD.items()}
    with pytest.raises(UserFacingError, match="Left and right"):
        place_scan(mirrored, HEAD)
    lacking = {key: place for key, place in HEAD.items() if key not in ("chin", "nose_tip")}
    with pytest.raises(UserFacingError, match="lacks needed points: tip of the nose, chin"):
        place_scan(lacking, HEAD)
    with pytest.raises(UserFacingError, match="one place or on one line"):
        place_scan({key: np.array([place[0], 0, 0]) for key, place in HEAD.items()}, HEAD)
    with pytest.raises(UserFacingError, match="one place or on one line"):
        place_scan(dict.fromkeys(HEAD, np.ones(3)), HEAD)
    with pytest.raises(UserFacingError, match="generic face lie in one place"):
        place_scan(HEAD, dict.fromkeys(HEAD, np.full(3, 1e8)))
    with pytest.raises(UserFacingError, match=r"lips_meet and chin are at the same place|chin and lips_meet are"):
        place_scan({**HEAD, "chin": HEAD["lips_meet"]}, HEAD)
    with pytest.raises(UserFacingError, match="nose_tip lies 10% of the scan's size off"):
        check_on_surface(HEAD, {"nose_tip": 20.0, "chin": 1.0}, 200.0)


@pytest.mark.parametrize("key", sorted(HEAD))
def test_a_point_that_was_clicked_elsewhere_is_found(key):
    wrong = {**HEAD, key: HEAD[key] + [0, 45.0, 0]}
    assert doubtful_points(wrong, HEAD) == [key]


def test_faces_of_other_proportions_are_not_doubted():
    longer = {key: place * [1.1, 1.25, 0.9] for key, place in HEAD.items()}
    assert doubtful_points(longer, HEAD) == []


def test_the_guided_list_has_two_dozen_points_and_needs_few():
    keys = [point.key for point in feature_points()]
    assert 20 <= len(keys) == len(set(keys)) <= 30
    assert sum(point.is_needed for point in feature_points()) <= 10
    lefts = {key for key in keys if key.endswith("_left")}
    assert {key.replace("_left", "_right") for key in lefts} <= set(keys)
