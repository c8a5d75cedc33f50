import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.face.jaw import JawHinge

HINGE = np.array([0.0, -20.0, -60.0])
CHIN = np.array([0.0, -85.0, 20.0])


def jaw():
    return JawHinge(HINGE, CHIN)


def teeth():
    return np.random.default_rng(1).normal((0, -70, 20), 10, (30, 3))


@pytest.mark.parametrize("degrees", [-3.0, 5.0, 22.0])
def test_a_turn_about_the_hinge_is_found_again(degrees):
    turn = Rotation.from_euler("x", degrees, degrees=True)
    moved = turn.apply(CHIN - HINGE) + HINGE - CHIN
    expected = turn.apply(teeth() - HINGE) + HINGE - teeth()
    np.testing.assert_allclose(jaw().displacements(teeth(), moved[None])[0], expected, atol=1e-9)


def test_a_slide_to_the_side_carries_every_tooth_alike():
    found = jaw().displacements(teeth(), np.array([[4.0, 0.0, 0.0]]))[0]
    np.testing.assert_allclose(found, np.broadcast_to([4.0, 0.0, 0.0], found.shape), atol=1e-12)


def test_any_motion_of_the_chin_leaves_the_jaw_rigid_and_at_the_chin():
    moved = np.random.default_rng(2).normal(0, 12, (20, 3))
    rest = np.concatenate([teeth(), CHIN[None]])
    posed = rest + jaw().displacements(rest, moved)
    between = np.linalg.norm(rest[:, None] - rest[None], axis=2)
    for frame in posed:
        np.testing.assert_allclose(np.linalg.norm(frame[:, None] - frame[None], axis=2), between, atol=1e-9)
    np.testing.assert_allclose(posed[:, -1] - CHIN, moved, atol=1e-9)


def test_the_joint_lies_before_the_ears(face):
    hinge = JawHinge.of(face, face.positions[face.landmarks["chin"]].astype(float)).hinge
    eyes, chin = face.positions[face.landmarks["outer_eye_left"]], face.positions[face.landmarks["chin"]]
    assert chin[1] < hinge[1] < eyes[1]
    assert -80 < hinge[2] - eyes[2] < -40
    assert hinge[0] == pytest.approx(0, abs=1)
