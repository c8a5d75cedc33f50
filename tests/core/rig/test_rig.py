import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.face import Face
from core.rig.control_names import control_mixing
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig, fitted, posed, poses
from tests.core.rig.small_rigs import random_track, small_rig


def test_vertices_are_the_neutral_face_and_the_sum_of_shapes_by_their_controls():
    rig = small_rig()
    track = random_track(rig.names)
    by_hand = np.array([rig.neutral + sum(w * d for w, d in zip(row, rig.deltas)) for row in track.values])
    np.testing.assert_allclose(posed(rig, track), by_hand, atol=1e-4)
    np.testing.assert_array_equal(np.stack(list(poses(rig, track))), posed(rig, track))


def test_at_rest_the_face_is_neutral_to_the_bit():
    rig = small_rig()
    assert (posed(rig, ControlTrack(rig.names, np.zeros((2, 3)), 30.0)) == rig.neutral).all()


def test_blocks_do_not_show(monkeypatch):
    rig = small_rig()
    track = random_track(rig.names, n_frames=50)
    whole = posed(rig, track)
    monkeypatch.setattr("core.rig.rig.BLOCK_BYTES", 3 * rig.neutral.nbytes)
    np.testing.assert_allclose(posed(rig, track), whole, atol=1e-4)


def test_controls_come_in_any_order_and_spelling():
    rig = small_rig()
    track = random_track(rig.names)
    spelt = ControlTrack(("BS.MouthSmile_R", "JawOpen", "mouthSmile_L"), track.values[:, [2, 0, 1]], 30.0)
    np.testing.assert_allclose(posed(rig, spelt), posed(rig, track), atol=1e-4)


def test_what_the_rig_cannot_show_is_told_and_what_rests_is_not():
    rig = small_rig()
    track = ControlTrack(("jawOpen", "tongueOut", "cheekPuff"), np.array([[0.5, 0.3, 0.0]]), 30.0)
    shown, warnings = fitted(rig, track)
    assert shown.column("jawOpen").tolist() == [0.5] and not shown.column("mouthSmileLeft").any()
    assert len(warnings) == 1 and "tongueOut" in warnings[0] and "cheekPuff" not in warnings[0]


def test_a_track_without_a_single_fitting_control_is_refused():
    with pytest.raises(UserFacingError, match=r"'ctrl_1'.*'jawOpen'"):
        posed(small_rig(), ControlTrack(("ctrl_1",), np.zeros((2, 1)), 30.0))


def test_a_face_without_shapes_is_no_rig():
    face = small_rig().face
    with pytest.raises(UserFacingError, match="no shapes"):
        Rig.of(Face(face.name, face.positions, face.triangles, face.part))


def test_one_control_for_both_sides_moves_both_and_both_move_the_one():
    mixing = control_mixing(["browInnerUp", "mouthSmileLeft", "mouthSmileRight"],
                            ["browInnerUp_L", "browInnerUp_R", "mouthSmile", "mouthSmile_R", "jawLeft"])  # fmt: skip
    assert mixing.T.tolist() == [[1, 0, 0], [1, 0, 0], [0, 0.5, 0.5], [0, 0, 1], [0, 0, 0]]


def test_arkit_moves_every_shape_of_ict_facekit_that_has_a_name_of_arkits(shared_data):
    """Its 57 shapes are ARKit's but for two cheek raisers and two pupils, and have no tongue."""
    from core.motion.blendshape_track import ARKIT_UNITS

    with np.load(shared_data("ict-facekit") / "expression_deltas.npz", allow_pickle=False) as data:
        names = data["names"].tolist()
    mixing = control_mixing(ARKIT_UNITS, names)
    unmoved = {name for name, moves in zip(names, mixing.any(axis=0)) if not moves}
    unused = {name for name, used in zip(ARKIT_UNITS, mixing.any(axis=1)) if not used}
    assert unmoved == {"PupilDilate_L", "PupilDilate_R", "cheekRaiser_L", "cheekRaiser_R"} and unused == {"tongueOut"}
