"""Points tracked in pictures: OpenFace's and MediaPipe's tables and arrays, pixels or fractions."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.motion_files import read_motion, read_takes, write_markers_csv
from core.motion.motion_track import PictureSizeUnknown, RateUnknown, ReadOptions

SIZE = (1280, 720)


def pixels(n_points: int, seed: int = 0) -> np.ndarray:
    """Frames of points in a picture, x right, y down, z away."""
    return np.random.default_rng(seed).uniform(100, 500, (6, n_points, 3)).round(3)


def openface(points: np.ndarray, depth: bool) -> str:
    heads = "frame, face_id, timestamp, confidence, success, gaze_0_x, gaze_0_y, gaze_0_z, eye_lmk_x_0, eye_lmk_y_0"
    axes = [("x", 0), ("y", 1)] + ([("X", 0), ("Y", 1), ("Z", 2)] if depth else [])
    heads += "".join(f", {axis}_{k}" for axis, _ in axes for k in range(68)) + ", p_rx, AU01_r\n"
    for f, frame in enumerate(points):
        cells = [f + 1, 0, f"{f / 30:.3f}", 0.98, int(f != 2), 0.1, 0.2, 0.97, 5, 6]
        cells += [frame[k, a] for _, a in axes for k in range(68)]
        heads += ", ".join(map(str, [*cells, 0.1, 0.2])) + "\n"
    return heads


@pytest.mark.parametrize("depth", [False, True])
def test_openface_gives_68_points_and_lost_frames_are_missing(tmp_path, depth):
    (tmp_path / "o.csv").write_text(openface(pixels(68), depth))
    (track,) = read_takes(tmp_path / "o.csv")
    assert track.positions.shape == (6, 68, 3) and track.rate_hz == 30.0
    assert track.names[:2] == ("P00", "P01")
    assert track.true_scale is depth and track.has_depth is depth
    assert np.isnan(track.positions[2]).all() and np.isfinite(np.delete(track.positions, 2, 0)).all()
    flipped = pixels(68) * [1, -1, -1]
    if depth:
        # OpenFace's 3D points are millimetres before the camera
        np.testing.assert_allclose(np.delete(track.positions, 2, 0), np.delete(flipped, 2, 0), atol=1e-3)
    else:
        np.testing.assert_allclose(track.positions[0, :, :2], flipped[0, :, :2], atol=1e-3)
        assert (track.positions[0, :, 2] == 0).all()


@pytest.mark.parametrize(
    "heads", ["x{k},y{k},z{k}", "{k}_x,{k}_y,{k}_z", "landmark_{k}_x,landmark_{k}_y,landmark_{k}_z"]
)
@pytest.mark.parametrize("first", [0, 1])
def test_mediapipe_fractions_become_pixels_of_the_picture(tmp_path, heads, first):
    points = pixels(478)
    fractions = points / [SIZE[0], SIZE[1], SIZE[0]]
    text = "timestamp_ms," + ",".join(heads.format(k=k + first) for k in range(478)) + "\n"
    text += "".join(",".join([str(40 * f), *map(str, frame.ravel())]) + "\n" for f, frame in enumerate(fractions))
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(PictureSizeUnknown, match="picture whose size"):
        read_takes(path)
    (track,) = read_takes(path, ReadOptions(picture_px=SIZE))
    np.testing.assert_allclose(track.positions, points * [1, -1, -1], atol=1e-3)
    assert track.names[0] == "MP000" and track.names[-1] == "MP477" and track.rate_hz == 25.0
    assert not track.true_scale and track.has_depth
    with pytest.raises(UserFacingError, match="not millimetres"):
        read_motion(path, ReadOptions(picture_px=SIZE))


def test_our_own_csv_of_numbered_markers_is_millimetres(tmp_path):
    positions = pixels(30) / 10
    write_markers_csv(tmp_path / "m.csv", positions, [f"MP{k:03d}" for k in range(30)], 25.0)
    np.testing.assert_allclose(read_motion(tmp_path / "m.csv")[0], positions, atol=1e-4)


def test_one_row_a_point_is_read_too(tmp_path):
    points = pixels(30)
    rows = [f"{f},{k},{x},{y},{z}" for f, frame in enumerate(points) for k, (x, y, z) in enumerate(frame)]
    (tmp_path / "m.csv").write_text("frame,landmark,x,y,z\n" + "\n".join(rows))
    with pytest.raises(RateUnknown):
        read_takes(tmp_path / "m.csv")
    (track,) = read_takes(tmp_path / "m.csv", ReadOptions(rate_hz=30.0))
    np.testing.assert_allclose(track.positions, points * [1, -1, -1], atol=1e-3)


def test_points_that_are_each_in_a_frame_of_their_own_are_no_take(tmp_path):
    rows = [f"{n},{n},1,2,3" for n in range(3000)]
    (tmp_path / "m.csv").write_text("frame,landmark,x,y,z\n" + "\n".join(rows))
    with pytest.raises(UserFacingError, match="few of its frames"):
        read_takes(tmp_path / "m.csv", ReadOptions(rate_hz=30.0))


def test_the_grid_set_is_480_takes_of_named_points(shared_data):
    tracks = read_takes(shared_data("grid-s1") / "tracks.npz")
    with np.load(shared_data("grid-s1") / "tracks.npz") as arrays:
        raw, start = arrays["xyz64"], arrays["start"]
        assert [track.take for track in tracks] == arrays["clips"].tolist()
        assert tracks[0].names == tuple(f"MP{n:03d}" for n in arrays["landmark_index"])
    assert sum(len(track.positions) for track in tracks) == len(raw)
    np.testing.assert_allclose(tracks[7].positions[3], raw[start[7] + 3] / 64 * [1, -1, -1])
    assert {track.rate_hz for track in tracks} == {25.0} and not any(track.true_scale for track in tracks)


@pytest.mark.parametrize("n_axes", [2, 3])
def test_plain_arrays_are_one_take(tmp_path, n_axes):
    points = pixels(70)[..., :n_axes]
    np.savez(tmp_path / "a.npz", points=points, fps=24)
    (track,) = read_takes(tmp_path / "a.npz")
    np.testing.assert_allclose(track.positions[..., 1], -points[..., 1], rtol=1e-6)
    assert track.rate_hz == 24.0 and track.names[69] == "MP069" and track.has_depth is (n_axes == 3)


@pytest.mark.parametrize(
    ("arrays", "told"),
    [
        ({"a": np.zeros(3)}, "no array of points"),
        ({"points": np.zeros((4, 5))}, "frames, points"),
        ({"points": np.full((4, 5, 3), np.inf)}, "infinite"),
        ({"points": np.full((4, 5, 3), np.nan)}, "shows no point"),
        ({"points": pixels(5)}, "how many frames"),
        ({"points": pixels(5), "fps": -3}, "how many frames"),
        ({"points": pixels(5), "fps": 25, "names": np.array(["a", "b"])}, "one for each"),
        ({"points": pixels(5), "fps": 25, "names": np.array(list("abcaa"))}, "repeat"),
        ({"points": pixels(5), "fps": 25, "start": np.array([0, 3])}, "name its takes"),
        ({"points": pixels(5), "fps": 25, "clips": np.array(["a"]), "start": np.array([0, 9])}, "starts of takes"),
    ],
)
def test_arrays_that_do_not_fit_are_one_sentence(tmp_path, arrays, told):
    np.savez(tmp_path / "a.npz", **arrays)
    with pytest.raises(UserFacingError, match=told) as caught:
        read_takes(tmp_path / "a.npz")
    assert "a.npz" in caught.value.message
