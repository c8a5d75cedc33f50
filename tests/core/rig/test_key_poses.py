import json

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.marker_set import MarkerSet
from core.rig.control_track import ControlTrack
from core.rig.key_poses import KeyPoses, load_key_poses, posed_controls, share_controls
from core.synthesis.marker_motion import MarkerMotion
from tests.core.rig.small_rigs import small_rig

MARKERS = MarkerSet(("nose", "up", "low", "left"), np.arange(12.0).reshape(4, 3))


def poses_of(rig, seed=1, n_keys=2):
    rng = np.random.default_rng(seed)
    lips = rng.normal(0, 5, (n_keys, 3, 3))
    return KeyPoses(rig.face.name, tuple(f"lips{n}" for n in range(n_keys)), ("low", "up", "left"), lips, rig.names,
                    rng.uniform(size=(n_keys, len(rig.names))))  # fmt: skip


def motion_of(poses, shares):
    """Markers, in another order than the poses', that stand where the shares of the key shapes put them."""
    moved = np.zeros((len(shares), 4, 3))
    moved[:, [2, 1, 3]] = np.tensordot(shares, poses.lips_mm, 1)
    return MarkerMotion((MARKERS.rest + moved).astype(np.float32), 50.0, MARKERS)


def test_a_key_shape_gives_its_pose_and_rest_gives_rest():
    rig = small_rig()
    poses = poses_of(rig)
    track = posed_controls(poses, rig, motion_of(poses, np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])))
    np.testing.assert_allclose(track.values[:2], poses.values, atol=1e-5)
    np.testing.assert_allclose(track.values[2], 0, atol=1e-5)
    assert track.names == rig.names and track.rate_hz == 50.0


def test_between_key_shapes_poses_blend():
    rig = small_rig()
    poses = poses_of(rig)
    shares = np.random.default_rng(3).uniform(0, 0.5, (20, 2))
    np.testing.assert_allclose(posed_controls(poses, rig, motion_of(poses, shares)).values, shares @ poses.values,
                               atol=1e-5)  # fmt: skip


def test_beyond_full_strength_controls_come_as_near_as_they_can():
    """A second opinion by scipy on the vertices themselves."""
    from scipy.optimize import lsq_linear

    rig = small_rig()
    poses = poses_of(rig)
    shares = np.array([[1.3, 0.9], [0.2, 1.8]])
    track = posed_controls(poses, rig, motion_of(poses, shares))
    basis = rig.deltas.reshape(len(rig.names), -1).T.astype(float)
    for row, share in zip(track.values, shares):
        wanted = basis @ (share @ poses.values)
        np.testing.assert_allclose(row, lsq_linear(basis, wanted, (0, 1), tol=1e-12).x, atol=1e-4)
    assert track.values.max() <= 1 + 1e-6


def test_poses_come_back_from_their_file(tmp_path, survives_damage):
    poses = poses_of(small_rig(), n_keys=3).with_pose("lips1", {"jawOpen": 0.25})
    poses.save(tmp_path / "poses.json")
    read = load_key_poses(tmp_path / "poses.json")
    assert (read.rig, read.keys, read.markers, read.controls) == (poses.rig, poses.keys, poses.markers, poses.controls)
    np.testing.assert_allclose(read.values, poses.values, atol=1e-6)
    np.testing.assert_allclose(read.lips_mm, poses.lips_mm, atol=1e-4)
    assert survives_damage(tmp_path / "poses.json", load_key_poses, 150) > 20


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda d: d.update(version=9), "newer"),
        (lambda d: d.update(keys=[]), "keys"),
        (lambda d: d["keys"][1].update(name="lips0"), "key 2"),
        (lambda d: d["keys"][1].update(lips_mm=[[0, 0, 0]]), "3 markers"),
        (lambda d: d["keys"][0].update(controls={"jaw": 0.5}), "'jaw'"),
        (lambda d: d["keys"][0].update(controls={"jawOpen": 1.5}), "1.5"),
        (lambda d: d["keys"][0].update(controls={"jawOpen": "wide"}), "lips0"),
    ],
)
def test_a_bad_file_is_refused_by_what_is_wrong_in_it(tmp_path, spoil, said):
    path = tmp_path / "poses.json"
    poses_of(small_rig()).save(path)
    data = json.loads(path.read_text())
    spoil(data)
    path.write_text(json.dumps(data))
    with pytest.raises(UserFacingError, match=said):
        load_key_poses(path)


def test_another_rig_and_another_marker_set_are_refused():
    rig = small_rig()
    poses = poses_of(rig)
    with pytest.raises(UserFacingError, match="sheet"):
        posed_controls(poses, small_rig(names=("a", "b")), motion_of(poses, np.zeros((1, 2))))
    others = MarkerMotion(np.zeros((1, 1, 3), np.float32), 50.0, MarkerSet(("nose",), np.zeros((1, 3))))
    with pytest.raises(UserFacingError, match="'low'"):
        posed_controls(poses, rig, others)


def test_shares_from_a_model_become_controls_in_whatever_order_they_come():
    rig = small_rig()
    poses = poses_of(rig)
    shares = np.random.default_rng(6).uniform(0, 0.5, (9, 2))
    track = share_controls(poses, rig, ControlTrack(poses.keys[::-1], shares[:, ::-1], 30.0, start_frame=4))
    np.testing.assert_allclose(track.values, shares @ poses.values, atol=1e-6)
    assert track.start_frame == 4 and track.names == rig.names
