"""TRC files come back as they were written; those of other programs are read as they mean them."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.motion_files import read_takes, write_trc
from core.motion.motion_track import RateUnknown, ReadOptions
from core.motion.trc import read_trc

NAMES = ("nose", "lip", "chin")
HEAD = "PathFileType\t4\t(X/Y/Z)\ta.trc\n"
SETTINGS = "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"


def other_program(units: str = "mm", rate: str = "60.00", rows: str = "") -> str:
    names = "Frame#\tTime\tA\t\t\tB\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
    return HEAD + SETTINGS + f"{rate}\t60\t3\t2\t{units}\t60\t1\t3\n" + names + rows


ROWS = "1\t0.0\t1\t2\t3\t4\t5\t6\t\n2\t0.0167\t\t\t\t4\t5\t6\t\n3\t0.0333\t1\t2\t3\n"


@pytest.mark.parametrize("rate_hz", [25.0, 29.97, 60.0, 119.88, 240.0])
def test_what_is_written_is_read_back_gaps_included(tmp_path, rate_hz):
    positions = np.random.default_rng(1).normal(scale=90, size=(9, 3, 3))
    positions[2:4, 1] = np.nan
    write_trc(tmp_path / "m.trc", positions, NAMES, rate_hz)
    (track,) = read_takes(tmp_path / "m.trc")
    np.testing.assert_allclose(track.positions, positions, atol=1e-4)
    assert track.names == NAMES and track.rate_hz == rate_hz and track.notes == ()


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1), ("cm", 10), ("m", 1000)])
def test_rows_that_end_early_and_empty_cells_are_missing_markers(tmp_path, unit, factor):
    (tmp_path / "m.trc").write_text(other_program(unit, rows=ROWS))
    track = read_trc(tmp_path / "m.trc")
    expected = np.array([[[1, 2, 3], [4, 5, 6]], [[np.nan] * 3, [4, 5, 6]], [[1, 2, 3], [np.nan] * 3]]) * factor
    np.testing.assert_allclose(track.positions, expected)
    assert track.names == ("A", "B") and track.rate_hz == 60.0


def test_frames_that_the_head_promises_and_are_not_there_are_said(tmp_path):
    (tmp_path / "m.trc").write_text(other_program(rows=ROWS.split("\n2")[0]))
    assert any("promises 3 frames, 1" in note for note in read_trc(tmp_path / "m.trc").notes)


def test_a_file_without_a_rate_asks_for_it(tmp_path):
    (tmp_path / "m.trc").write_text(other_program(rate="", rows=ROWS))
    with pytest.raises(RateUnknown):
        read_trc(tmp_path / "m.trc")
    assert read_trc(tmp_path / "m.trc", ReadOptions(rate_hz=50.0)).rate_hz == 50.0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "empty"),
        ("marker,x\n", "PathFileType"),
        (HEAD, "truncated"),
        (HEAD + SETTINGS + "60\n", "Frame#"),
        (other_program(), "0 frames"),
        (other_program(rate="0", rows=ROWS), "no rate"),
        (other_program(units="px", rows=ROWS), "no unit of length"),
        (other_program(rows="1\t0\t1\t2\n"), "line 7: 4 cells"),
        (other_program(rows="1\t0\t1\ttwo\t3\t4\t5\t6\n"), "line 7: 'two'"),
        (other_program(rows="1\t0\t1\tinf\t3\t4\t5\t6\n"), "line 7: a coordinate is infinite"),
        (other_program(rows=ROWS).replace("\tB\t", "\tA\t"), "'A' comes twice"),
        (
            other_program(rows="1\t0\n" * 60).replace("\tB", "\tB" * 1 + "".join(f"\tC{k}" for k in range(400))),
            "line 7",
        ),
    ],
)
def test_what_cannot_be_used_is_one_sentence(tmp_path, text, told):
    (tmp_path / "m.trc").write_text(text)
    with pytest.raises(UserFacingError, match=told) as caught:
        read_trc(tmp_path / "m.trc")
    assert "m.trc" in caught.value.message


@pytest.mark.parametrize("take", ["Jaw", "Eyebrows"])
def test_a_real_take_goes_through_trc(tmp_path, shared_data, take):
    (track,) = read_takes(shared_data("animface-mocap") / f"{take}.c3d")
    write_trc(tmp_path / "m.trc", track.positions[:60], track.names, track.rate_hz)
    (back,) = read_takes(tmp_path / "m.trc")
    np.testing.assert_allclose(back.positions, track.positions[:60], atol=1e-4)
    assert back.names == track.names
