"""From pixels to millimetres: sizes and depths are those of the face, whichever way it looks."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.iface.affine_fit import AffineFit
from core.iface.motion_unit import MotionUnits
from core.media.audio import Audio, load_audio
from core.motion.motion_files import read_motion
from core.tracking.capture import capture_of, evenly_spaced, write_capture
from core.tracking.face_model import FaceModel
from core.tracking.start import Placement
from core.tracking.track import Track, TrackingRequest, track_video
from core.tracking.tracker import TrackerState
from core.tracking.video_pictures import VideoFormat
from tests.core.tracking.bent_sheet import bent_markers, clicks_on, sheet_markers


def _seen_by_a_far_camera(model, turns, scales, parameters):
    """A perfect track of a rigid head that deforms by ``parameters``: what the affine fit of it would be."""
    n_frames, states, points = len(turns), [], []
    z_mean = model.rest[:, 2].mean()
    for f in range(n_frames):
        # picture axes are left-handed: y is turned over on both sides
        flip = np.diag([1.0, -1.0, 1.0])
        camera = scales[f] * (flip @ turns[f].as_matrix() @ flip)[:2]
        linear, sideways = camera[:, :2], camera[:, 2]
        own = np.r_[parameters[f], np.linalg.solve(linear, sideways)]
        fit = AffineFit(own, np.column_stack([linear, [320.0, 240.0]]))
        shape = np.column_stack([model.rest[:, :2], model.rest[:, 2] - z_mean])
        shape = shape + np.tensordot(parameters[f], model.units, 1)
        states.append(TrackerState(model.rest[:, :2], (), fit))
        points.append(shape @ camera.T + [320.0, 240.0])
    count = len(model.names)
    return Track(
        TrackingRequest("film.mp4", model, {}), VideoFormat(640, 480, 30.0, n_frames), 1.0,
        Placement(2.0, np.eye(2), np.zeros(2)), np.arange(n_frames) / 30.0, np.array(points),
        np.ones((n_frames, count)), np.zeros((n_frames, count)), np.zeros(n_frames, bool), tuple(states),
    )  # fmt: skip


def _distances(points):
    return np.linalg.norm(points[..., :, None, :] - points[..., None, :, :], axis=-1)


def test_a_turned_head_keeps_its_size_and_depth(model):
    turns = Rotation.from_euler("YXZ", [[0, 0, 0], [15, 0, 0], [0, -12, 5], [-10, 8, 20]], degrees=True)
    parameters = np.zeros((4, len(model.units)))
    track = _seen_by_a_far_camera(model, turns, [2.0, 2.0, 2.4, 1.7], parameters)
    capture = capture_of(track)
    expected = _distances(model.rest)
    for frame in capture.positions:
        np.testing.assert_allclose(_distances(frame), expected, atol=1e-6)
        # a rotation, not a mirror image: y up and z towards the camera
        a, b = frame - frame.mean(0), model.rest * [1, -1, 1] - (model.rest * [1, -1, 1]).mean(0)
        assert np.linalg.det(np.linalg.lstsq(b, a, rcond=None)[0]) == pytest.approx(1.0, abs=1e-6)


def test_units_move_points_in_depth_too(model):
    chance = np.random.default_rng(2)
    parameters = chance.normal(size=(3, len(model.units))) * np.sqrt(model.variance)
    track = _seen_by_a_far_camera(model, Rotation.identity(3), [2.0] * 3, parameters)
    moved = model.rest + np.tensordot(parameters, model.units, 1)
    capture = capture_of(track)
    # the affine camera of equation 5 knows one depth a point, that of the neutral face
    np.testing.assert_allclose(_distances(capture.positions), _distances(moved), atol=0.05)


def test_frames_of_uneven_times_are_interpolated():
    times_s = np.array([0.0, 0.04, 0.10, 0.14, 0.22])
    positions = np.repeat(times_s[:, None, None], 3, axis=2) * [1.0, -2.0, 0.5]
    even = evenly_spaced(positions, times_s, 25.0)
    np.testing.assert_allclose(even[:, 0, 0], np.arange(6) / 25.0, atol=1e-12)
    jittered = np.arange(5) / 25.0 + [0.0, 0.01, -0.01, 0.015, 0.0]
    assert evenly_spaced(positions, jittered, 25.0) is positions


@pytest.fixture(scope="module")
def tracked(sheet, film, model, clicks, tmp_path_factory):
    path = tmp_path_factory.mktemp("film") / "sheet.avi"
    hum = Audio((0.2 * np.sin(np.arange(15_360) / 12)).astype(np.float32), 16_000)
    film(sheet(dark=frozenset({10, 11})), path, hum)
    return track_video(TrackingRequest(path, model, clicks))


@pytest.mark.parametrize("suffix", [".c3d", ".trc", ".csv"])
def test_a_written_capture_is_read_back(tracked, tmp_path, suffix):
    written = write_capture(tracked, tmp_path / f"take{suffix}")
    assert written == [tmp_path / f"take{suffix}", tmp_path / "take.wav"]
    positions, names, rate_hz = read_motion(tmp_path / f"take{suffix}")
    assert (names, rate_hz) == (tracked.request.model.names, pytest.approx(25.0))
    expected = capture_of(tracked).positions
    assert np.isnan(expected).all(axis=(1, 2)).tolist() == [f in (10, 11) for f in range(24)]
    np.testing.assert_allclose(positions, expected, atol=1e-2)
    assert load_audio(tmp_path / "take.wav").duration_s == pytest.approx(0.96, abs=0.01)


def test_sound_that_lies_there_already_is_left_alone(tracked, tmp_path):
    (tmp_path / "take.wav").write_bytes(b"mine")
    assert write_capture(tracked, tmp_path / "take.c3d") == [tmp_path / "take.c3d"]
    assert (tmp_path / "take.wav").read_bytes() == b"mine"


def test_nothing_is_written_of_a_face_that_was_never_seen(tracked, tmp_path):
    unseen = replace(tracked, lost=np.arange(24) > 0)
    with pytest.raises(UserFacingError, match="seen in no picture"):
        write_capture(unseen, tmp_path / "take.c3d")
    with pytest.raises(UserFacingError, match="no kind of capture"):
        write_capture(tracked, tmp_path / "take.mp3")
    assert not list(tmp_path.iterdir())


def test_points_without_depth_stay_in_the_plane(sheet, film, tmp_path):
    """A database of tracked points with x and y only."""
    marked = sheet_markers()
    flat = replace(marked, rest=marked.rest * [1.0, 1.0, 0.0])
    moved = bent_markers(np.random.default_rng(3).normal(size=(200, 3)) * 3.0)[..., :2]
    model = FaceModel.of(flat, MotionUnits.fit({"neutral": moved}, 0.9999))
    assert not model.has_depth
    path = film(sheet(n=8), tmp_path / "flat.avi")
    track = track_video(TrackingRequest(path, model, clicks_on(model)))
    truth = sheet(n=8).truth(model.seen * [1, -1])
    assert np.linalg.norm(track.points - truth, axis=2).mean() < 0.7
    positions = capture_of(track).positions
    assert np.abs(positions[..., 2]).max() == 0.0
    np.testing.assert_allclose(
        positions[0, :, :2] - positions[0, 0, :2], flat.rest[:, :2] - flat.rest[0, :2], atol=1e-6
    )
