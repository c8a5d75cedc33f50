import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.face.pose import Eyeballs, Head, TongueShape


def test_teeth_and_eyes_go_with_the_head_as_one_rigid_piece(face):
    head = Head.of(face)
    rotation, shift = np.array([0.1, -0.2, 0.05]), np.array([1.0, 2.0, -3.0])
    moved = head.move(face.positions, rotation, shift)
    stiff = np.concatenate([face.vertices_of(p) for p in ("upper_teeth", "lower_teeth", "eye_left", "eye_right")])
    turned = Rotation.from_rotvec(rotation).apply(face.positions[stiff] - head.pivot) + head.pivot + shift
    np.testing.assert_allclose(moved[stiff], turned, atol=1e-3)
    before = np.linalg.norm(face.positions[stiff][:, None] - face.positions[stiff][None], axis=2)
    after = np.linalg.norm(moved[stiff][:, None] - moved[stiff][None], axis=2)
    np.testing.assert_allclose(after, before, atol=1e-3)


def test_the_face_goes_along_and_the_base_of_the_neck_stays(face):
    head = Head.of(face)
    moved = head.move(face.positions, np.array([0.0, 0.3, 0.0]), np.zeros(3)) - face.positions
    assert all(head.share[vertex] > 0.999 for vertex in face.landmarks.values())
    base = face.positions[:, 1] < np.quantile(face.positions[:, 1], 0.02)
    np.testing.assert_allclose(moved[base], 0.0, atol=1e-6)


def test_the_neck_gives_way_without_a_step(face):
    share = Head.of(face).share
    edges = np.concatenate([face.triangles[:, [0, 1]], face.triangles[:, [1, 2]]])
    assert np.abs(share[edges[:, 0]] - share[edges[:, 1]]).max() < 0.45


@pytest.mark.parametrize(("yaw", "pitch"), [(10.0, 0.0), (0.0, 8.0), (-7.0, -5.0)])
def test_eyes_turn_about_their_centres_by_the_angle_asked_for(face, yaw, pitch):
    eyes = Eyeballs.of(face)
    positions = face.positions.copy()
    eyes.turn(positions, yaw, pitch)
    wanted = np.array([
        np.sin(np.radians(yaw)) * np.cos(np.radians(pitch)),
        np.sin(np.radians(pitch)),
        np.cos(np.radians(yaw)) * np.cos(np.radians(pitch)),
    ])  # fmt: skip
    assert len(eyes.balls) == 2
    for vertices, centre in eyes.balls:
        # the turn that best explains the vertices takes the line of sight where it was asked to go
        turn, _ = Rotation.align_vectors(positions[vertices] - centre, face.positions[vertices] - centre)
        np.testing.assert_allclose(turn.apply([0.0, 0.0, 1.0]), wanted, atol=1e-4)
        np.testing.assert_allclose(
            np.linalg.norm(positions[vertices] - centre, axis=1),
            np.linalg.norm(face.positions[vertices] - centre, axis=1),
            atol=1e-3,
        )
    still = np.setdiff1d(np.arange(len(positions)), np.concatenate([vertices for vertices, _ in eyes.balls]))
    np.testing.assert_array_equal(positions[still], face.positions[still])


def bent(face, tip, back, advance):
    moved = np.zeros_like(face.positions)
    TongueShape.of(face).bend(moved, face.positions, tip, back, advance)
    return moved


def test_a_raised_tip_comes_up_behind_the_upper_teeth(face):
    shape = TongueShape.of(face)
    at = face.positions[shape.tip_vertex] + bent(face, 1.0, 0.0, 0.0)[shape.tip_vertex]
    teeth = face.positions[face.vertices_of("upper_teeth")]
    front = teeth[teeth[:, 2] > teeth[:, 2].max() - 5]
    assert front[:, 1].min() < at[1] < front[:, 1].max()
    assert at[2] < front[:, 2].max()


def test_between_the_teeth_it_passes_under_their_edge(face):
    shape = TongueShape.of(face)
    at = face.positions[shape.tip_vertex] + bent(face, 0.85, 0.1, 1.0)[shape.tip_vertex]
    teeth = face.positions[face.vertices_of("upper_teeth")]
    front = teeth[teeth[:, 2] > teeth[:, 2].max() - 5]
    assert at[1] < front[:, 1].min()
    assert at[2] > front[:, 2].max()


def test_the_tongue_alone_moves(face):
    moved = bent(face, 1.0, 1.0, -0.5)
    others = face.part != face.part[face.vertices_of("tongue")[0]]
    assert not moved[others].any()
    assert np.abs(bent(face, 0.0, 0.0, 0.0)).max() == 0.0
