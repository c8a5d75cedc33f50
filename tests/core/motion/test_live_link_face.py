"""Live Link Face takes come back as they were written; real ones are uneven, interrupted, and do not say their rate."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, HEAD_AND_EYES, BlendshapeTrack
from core.motion.live_link_face import read_live_link_face, write_live_link_face
from core.motion.motion_track import RateUnknown

COLUMNS = [name[:1].upper() + name[1:] for name in (*ARKIT_UNITS, *HEAD_AND_EYES)]


def track(n_frames: int = 150, rate_hz: float = 60.0, **more) -> BlendshapeTrack:
    chance = np.random.default_rng(2)
    weights = chance.uniform(0, 1, (n_frames, 52)).astype(np.float32)
    return BlendshapeTrack(weights, ARKIT_UNITS, rate_hz, **more)


def test_the_52_units_are_those_of_the_default_face():
    from core.face.marker_units import load_marker_units

    assert set(ARKIT_UNITS) == set(load_marker_units().names) and len(ARKIT_UNITS) == 52


@pytest.mark.parametrize("rate_hz", [24.0, 25.0, 30.0, 60.0, 120.0])
def test_what_is_written_is_read_back(tmp_path, rate_hz):
    rotations = np.random.default_rng(3).normal(scale=0.2, size=(300, 9)).astype(np.float32)
    written = track(300, rate_hz, start_timecode="10:59:59:20.500", rotations=rotations)
    written.weights[40:50] = np.nan
    path = tmp_path / "take.csv"
    write_live_link_face(path, written)
    read = read_live_link_face(path)
    np.testing.assert_allclose(read.weights, written.weights, atol=1e-6)
    np.testing.assert_allclose(
        np.delete(read.rotations, np.s_[40:50], 0), np.delete(rotations, np.s_[40:50], 0), atol=1e-6
    )
    assert (read.names, read.rate_hz, read.start_timecode) == (ARKIT_UNITS, rate_hz, "10:59:59:20.500")


def test_the_file_is_what_live_link_face_writes(tmp_path):
    """Header, order and count as in the phone application's own files."""
    write_live_link_face(tmp_path / "t.csv", track(2))
    head, first, _ = (tmp_path / "t.csv").read_text().split("\n", 2)
    assert head.startswith("Timecode,BlendShapeCount,EyeBlinkLeft,EyeLookDownLeft,EyeLookInLeft,EyeLookOutLeft")
    assert head.endswith("TongueOut,HeadYaw,HeadPitch,HeadRoll,LeftEyeYaw,LeftEyePitch,LeftEyeRoll,RightEyeYaw,"
                         "RightEyePitch,RightEyeRoll")  # fmt: skip
    assert head.count(",") == first.count(",") == 62
    assert first.startswith("00:00:00:00.000,61,")


def lines(codes, values=None) -> str:
    rows = [",".join(["Timecode", "BlendshapeCount", *COLUMNS])]
    for n, code in enumerate(codes):
        value = n / 100 if values is None else values[n]
        rows.append(",".join([code, "61", *[f"{value:.6f}"] * 61]))
    return "\n".join(rows) + "\n"


def code(frame: float) -> str:
    whole, sub = divmod(round(frame * 1000), 1000)
    return f"14:03:{whole // 60:02d}:{whole % 60:02d}.{sub:03d}"


def test_jitter_and_dropped_rows_are_brought_onto_even_frames(tmp_path):
    """A phone at 60 Hz whose rows stray by a tenth of a frame, with 2 rows lost, then 30."""
    frames = np.delete(np.arange(200), [*range(50, 52), *range(100, 130)])
    stray = frames + np.random.default_rng(0).uniform(-0.1, 0.1, len(frames))
    stray[0] = 0
    values = 0.5 + 0.4 * np.sin(stray / 30)
    path = tmp_path / "t.csv"
    path.write_text(lines([code(f) for f in stray], values))
    read = read_live_link_face(path)
    assert read.rate_hz == 60.0 and len(read.weights) == 200
    known = np.isfinite(read.weights[:, 0])
    assert set(np.flatnonzero(~known)) <= set(range(99, 131)) and (~known).sum() >= 29
    truth = 0.5 + 0.4 * np.sin(np.arange(200) / 30)
    assert np.abs(read.weights[known, 0] - truth[known]).max() < 0.002
    assert any("Uneven" in note for note in read.notes)


def test_a_take_at_half_the_rate_of_its_timecode_is_seen_as_that(tmp_path):
    (tmp_path / "t.csv").write_text(lines([code(2 * f) for f in range(90)]))
    assert read_live_link_face(tmp_path / "t.csv").rate_hz == 30.0


def test_a_take_past_midnight_goes_on(tmp_path):
    codes = ["23:59:59:58.000", "23:59:59:59.000", "00:00:00:00.000", "00:00:00:01.000"]
    (tmp_path / "t.csv").write_text(lines(codes))
    assert len(read_live_link_face(tmp_path / "t.csv").weights) == 4


def test_a_take_too_short_to_tell_its_rate_asks_for_it(tmp_path):
    (tmp_path / "t.csv").write_text(lines([code(f) for f in range(20)]))
    with pytest.raises(RateUnknown):
        read_live_link_face(tmp_path / "t.csv")
    assert read_live_link_face(tmp_path / "t.csv", 59.94).rate_hz == pytest.approx(59.94)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "empty"),
        ("frame,JawOpen\n", "begins with Timecode"),
        (lines([]), "0 rows"),
        (lines(["a", "b"]), "line 2: 'a' is no timecode"),
        (lines([code(80), code(10), code(11)]), "line 3: the timecode goes back"),
        (lines([code(59), code(59)]), "how many frames"),
        (lines([code(59), code(60)], [0.0, 1e9]), "weights from"),
        (lines([code(59), code(60)]).replace("0.010000", "no", 1), "line 3: a cell is not a number"),
        (lines([code(59), code(60)]).replace(",0.010000", "", 1), "line 3: 62 cells"),
        (lines([code(58), code(59), code(60), "18:00:00:00.000"]), "lacks most"),
        (lines([code(59), code(60)]).replace("JawLeft", "JawRight"), "columns repeat"),
        (",".join(["Timecode", "BlendshapeCount", *COLUMNS]) + f"\n{code(59)},0\n{code(60)},0\n", "0 of its 2"),
    ],
)
def test_what_cannot_be_used_is_one_sentence(tmp_path, text, told):
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(UserFacingError, match=told) as caught:
        read_live_link_face(tmp_path / "t.csv")
    assert "t.csv" in caught.value.message
