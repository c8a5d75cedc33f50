import json

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, HEAD_AND_EYES, BlendshapeTrack
from core.motion.live_link_face import read_live_link_face, write_live_link_face
from core.motion.readers.blendshape_files import read_blendshapes
from core.pipeline.blendshapes import arkit_weights, controls_of
from core.pipeline.curves import read_curves_json, write_curves_csv, write_curves_json
from core.rig.control_track import ControlTrack
from tests.core.rig.small_rigs import random_track

ANY_NAMES = ("jawOpen", "CTRL lips, wide", 'a "quoted" one', "Mund offen é")


def test_json_comes_back_as_it_was(tmp_path):
    track = random_track(ANY_NAMES, n_frames=11, rate_hz=30000 / 1001, start_frame=107892)
    write_curves_json(tmp_path / "a.json", track)
    read = read_curves_json(tmp_path / "a.json")
    assert (read.names, read.rate_hz, read.start_frame) == (track.names, track.rate_hz, track.start_frame)
    np.testing.assert_allclose(read.values, track.values, atol=1e-6)
    assert json.loads((tmp_path / "a.json").read_text())["start_timecode"] == "00:59:56:12"


def test_values_beyond_one_are_kept(tmp_path):
    write_curves_json(tmp_path / "a.json", ControlTrack(("a",), np.array([[-0.5], [1.7]]), 25.0))
    assert read_curves_json(tmp_path / "a.json").values.ravel().tolist() == pytest.approx([-0.5, 1.7])


def test_a_table_comes_back_by_the_reader_of_weights(tmp_path):
    track = random_track(ANY_NAMES, n_frames=40, rate_hz=24.0, start_frame=7)
    write_curves_csv(tmp_path / "a.csv", track)
    read = controls_of(read_blendshapes(tmp_path / "a.csv"))
    assert read.names == track.names and read.rate_hz == 24.0
    np.testing.assert_allclose(read.values, track.values, atol=1e-6)
    assert (tmp_path / "a.csv").read_text().splitlines()[1].startswith("7,0.000000,")


@pytest.mark.parametrize("rate_hz", [24.0, 25.0, 30000 / 1001, 30.0, 60.0])
def test_live_link_face_comes_back_with_its_timecode(tmp_path, rate_hz):
    track = random_track(("jawOpen", "mouthSmile_L"), n_frames=80, rate_hz=rate_hz, start_frame=3600 * round(rate_hz))
    captured, warnings = arkit_weights(track)
    write_live_link_face(tmp_path / "a.csv", captured)
    heads = (tmp_path / "a.csv").read_text().splitlines()[0].split(",")
    assert len(heads) == 2 + len(ARKIT_UNITS) + len(HEAD_AND_EYES) == 63 and not warnings
    read = controls_of(read_live_link_face(tmp_path / "a.csv"))
    assert read.rate_hz == pytest.approx(rate_hz) and read.start_frame == track.start_frame
    np.testing.assert_allclose(read.column("mouthSmileLeft"), track.values[:, 1], atol=1e-6)
    assert not read.column("tongueOut").any()


def test_arkit_gets_only_its_own_within_bounds_and_is_told():
    track = ControlTrack(("jawOpen", "CTRL_x"), np.array([[1.5, 0.2], [-0.5, 0.2]]), 30.0)
    captured, warnings = arkit_weights(track)
    assert captured.weights[:, ARKIT_UNITS.index("jawOpen")].tolist() == [1.0, 0.0]
    assert "CTRL_x" in warnings[0] and "jawOpen" in warnings[1]
    with pytest.raises(UserFacingError, match="CTRL_x"):
        arkit_weights(ControlTrack(("CTRL_x",), np.zeros((1, 1)), 30.0))


def test_frames_without_a_face_are_bridged():
    weights = np.array([[0.0], [np.nan], [1.0], [np.nan]])
    track = controls_of(BlendshapeTrack(weights, ("jawOpen",), 30.0, "01:00:00:15.000"))
    assert track.values.ravel().tolist() == [0.0, 0.5, 1.0, 1.0] and track.start_frame == 30 * 3600 + 15
    with pytest.raises(UserFacingError):
        controls_of(BlendshapeTrack(weights[1:2], ("jawOpen",), 30.0))


GOOD = {"format": "efase-curves", "version": 1, "rate_hz": 30, "controls": ["a"], "frames": [[0.5]]}


@pytest.mark.parametrize(
    "bad",
    [{"format": "x"}, {"version": 2}, {"rate_hz": 0}, {"rate_hz": "fast"}, {"controls": []}, {"controls": [1]},
     {"controls": ["a", "a"], "frames": [[0, 0]]}, {"controls": [""]}, {"frames": []}, {"frames": [[0, 1]]},
     {"frames": [["x"]]}, {"frames": [[float("nan")]]}, {"frames": 3}],
)  # fmt: skip
def test_damaged_json_is_refused_in_a_sentence(tmp_path, bad):
    path = tmp_path / "a.json"
    path.write_text(json.dumps(GOOD))
    assert read_curves_json(path).values.tolist() == [[0.5]]
    path.write_text(json.dumps(GOOD | bad))
    with pytest.raises(UserFacingError, match=path.name):
        read_curves_json(path)


def test_damaged_copies_are_read_or_refused(tmp_path, survives_damage):
    write_curves_json(tmp_path / "a.json", random_track(ANY_NAMES))
    assert survives_damage(tmp_path / "a.json", read_curves_json, 200) > 50
