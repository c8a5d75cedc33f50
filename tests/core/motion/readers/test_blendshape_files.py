"""Weights with names, from arrays and tables; nothing of it by way of pickles."""

import json

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, arkit_name
from core.motion.motion_track import RateUnknown
from core.motion.readers.blendshape_files import (
    NamesUnknown,
    is_blendshape_file,
    read_blendshapes,
    read_shape_names,
)

NAMES = ("jawOpen", "mouthPucker", "smirk")


def weights(n_frames: int = 5) -> np.ndarray:
    return np.random.default_rng(0).uniform(0, 1, (n_frames, 3)).round(6)


@pytest.mark.parametrize("kind", [".npy", ".txt", ".json"])
def test_names_come_from_a_list_of_any_kind(tmp_path, kind):
    path = tmp_path / f"names{kind}"
    if kind == ".npy":
        np.save(path, np.array(NAMES))
    else:
        path.write_text(json.dumps(NAMES) if kind == ".json" else "# shapes\n" + ",\n".join(NAMES) + "\n")
    assert read_shape_names(path) == NAMES
    np.save(tmp_path / "w.npy", weights())
    track = read_blendshapes(tmp_path / "w.npy", path, 30.0)
    np.testing.assert_allclose(track.weights, weights(), atol=1e-6)
    assert track.names == NAMES and track.rate_hz == 30.0


def test_an_array_asks_for_its_names_and_its_rate(tmp_path):
    np.save(tmp_path / "w.npy", weights())
    with pytest.raises(NamesUnknown, match="3 weights"):
        read_blendshapes(tmp_path / "w.npy", None, 30.0)
    with pytest.raises(RateUnknown):
        read_blendshapes(tmp_path / "w.npy", NAMES)
    with pytest.raises(UserFacingError, match="there are 2 names"):
        read_blendshapes(tmp_path / "w.npy", NAMES[:2], 30.0)


def test_an_archive_may_hold_all_of_it(tmp_path):
    np.savez(tmp_path / "w.npz", weights=weights(), names=np.array(NAMES), fps=24.0)
    assert is_blendshape_file(tmp_path / "w.npz")
    track = read_blendshapes(tmp_path / "w.npz")
    assert track.names == NAMES and track.rate_hz == 24.0


def test_a_table_with_times_is_read_and_its_names_spelled_as_arkit_does(tmp_path):
    path = tmp_path / "w.csv"
    text = "Frame,Time,EyeBlink_L,JawOpen,mouthFunnel,MouthPucker,TongueOut,own\n"
    text += "".join(f"{f},{f / 60:.6f}," + ",".join(["0.5"] * 6) + "\n" for f in range(4))
    path.write_text(text)
    assert is_blendshape_file(path)
    track = read_blendshapes(path)
    assert track.names == ("eyeBlinkLeft", "jawOpen", "mouthFunnel", "mouthPucker", "tongueOut", "own")
    assert track.rate_hz == 60.0 and (track.weights == 0.5).all()


def test_markers_are_no_blendshapes(tmp_path):
    (tmp_path / "m.csv").write_text("frame,time_s,a_x,a_y,a_z\n0,0,1,2,3\n1,0.1,1,2,3\n")
    assert not is_blendshape_file(tmp_path / "m.csv")


def test_spellings_of_arkits_units_are_one():
    assert {arkit_name(name) for name in ("EyeBlinkLeft", "eyeBlink_L", "eye_blink_left", "eyeblinkleft")} == {
        "eyeBlinkLeft"
    }
    assert arkit_name("smirk") is None
    assert all(arkit_name(name[:1].upper() + name[1:]) == name for name in ARKIT_UNITS)


def test_per_cent_are_weights_and_what_leaves_the_range_is_limited_and_said(tmp_path):
    np.save(tmp_path / "p.npy", 100 * weights())
    track = read_blendshapes(tmp_path / "p.npy", NAMES, 30.0)
    np.testing.assert_allclose(track.weights, weights(), atol=1e-6)
    np.save(tmp_path / "q.npy", np.array([[-0.1, 1.2, 0.5]]))
    track = read_blendshapes(tmp_path / "q.npy", NAMES, 30.0)
    np.testing.assert_allclose(track.weights, [[0, 1, 0.5]])
    assert "limited" in track.notes[0]


@pytest.mark.parametrize(
    ("array", "told"),
    [(np.zeros(3), "frames by shapes"), (np.full((2, 3), 1e9), "weights from"), (np.full((2, 3), np.inf), "infinite"),
     (np.array([["a", "b", "c"]]), "frames by shapes"), (np.zeros((0, 3)), "frames by shapes")],
)  # fmt: skip
def test_arrays_that_are_no_weights_are_refused(tmp_path, array, told):
    np.save(tmp_path / "w.npy", array)
    with pytest.raises(UserFacingError, match=told):
        read_blendshapes(tmp_path / "w.npy", NAMES, 30.0)


@pytest.mark.parametrize(
    ("name", "content", "told"),
    [("n.txt", "a\nb\na\n", "twice"), ("n.txt", "", "empty"), ("n.json", "{}", "no list"), ("n.json", "[", "no JSON"),
     ("n.json", "[" * 100_000, "no JSON"), ("n.txt", None, "no list of names")],
)  # fmt: skip
def test_lists_that_name_nothing_are_refused(tmp_path, name, content, told):
    path = tmp_path / name
    if content is not None:
        path.write_text(content)
    with pytest.raises(UserFacingError, match=told):
        read_shape_names(path)


def test_facegoods_names_and_weights_are_read_as_their_readme_says(shared_data):
    folder = shared_data("facegood")
    track = read_blendshapes(
        folder / "bs_value" / "bs_value_1114_2_01.npy", folder / "shirley_1015_bs_name.npy", rate_hz=30.0
    )
    with pytest.warns(UserWarning, match="Python 2"):
        truth = np.load(folder / "bs_value" / "bs_value_1114_2_01.npy", allow_pickle=False)
    np.testing.assert_allclose(track.weights, truth, atol=1e-6)
    assert len(track.names) == 116 and track.names[0] == "brow_lower_l" and track.names[-1] == "cheek_suck_l"
