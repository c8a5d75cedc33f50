"""Marker files come back as they were written; everything else is one sentence."""

import struct
from pathlib import Path

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.motion_files import read_motion, write_c3d, write_markers_csv, write_trc
from core.motion.motion_track import ReadOptions

TAKES = Path(__file__).resolve().parents[3] / "../shared/data/animface-mocap"
NAMES = ("nose", "lip", "chin")
WRITERS = {".c3d": write_c3d, ".csv": write_markers_csv}
MM = 1e-4


def motion(n_frames: int = 7, n_markers: int = 3) -> np.ndarray:
    positions = np.random.default_rng(4).normal(scale=80, size=(n_frames, n_markers, 3)).astype(np.float32)
    positions[1, 2] = np.nan
    return positions


@pytest.mark.parametrize("suffix", WRITERS)
@pytest.mark.parametrize("rate_hz", [25.0, 29.97002997, 120.0, 2.5])
def test_what_is_written_is_read_back_gaps_included(tmp_path, suffix, rate_hz):
    path = tmp_path / f"m{suffix}"
    WRITERS[suffix](path, motion(), NAMES, rate_hz)
    positions, names, rate = read_motion(path)
    assert positions.dtype == np.float32
    np.testing.assert_allclose(positions, motion(), atol=MM)
    assert names == NAMES
    assert rate == pytest.approx(rate_hz, rel=1e-6)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_take_of_300_markers_keeps_every_name(tmp_path, suffix):
    names = tuple(f"a marker with a long name {k}" for k in range(300))
    path = tmp_path / f"m{suffix}"
    WRITERS[suffix](path, motion(3, 300), names, 60.0)
    positions, read_names, _ = read_motion(path)
    assert read_names == names
    np.testing.assert_allclose(positions, motion(3, 300), atol=MM)


def test_a_c3d_take_longer_than_its_header_can_count_is_whole(tmp_path):
    positions = np.arange(70_000 * 3, dtype=np.float32).reshape(70_000, 1, 3)
    write_c3d(tmp_path / "long.c3d", positions, ("nose",), 120.0)
    read, _, _ = read_motion(tmp_path / "long.c3d")
    np.testing.assert_array_equal(read, positions)


@pytest.mark.parametrize("take", ["Jaw", "Cheeks", "Nose", "Eyebrows"])
def test_studio_takes_agree_between_c3d_and_csv(take):
    if not TAKES.is_dir():
        pytest.skip("the shared animface takes are not on this machine")
    positions, names, rate_hz = read_motion(TAKES / f"{take}.c3d")
    table, table_names, table_rate_hz = read_motion(TAKES / f"{take}.csv")
    assert names == table_names
    assert len(names) == 41
    assert rate_hz == table_rate_hz == 60.0
    np.testing.assert_allclose(positions, table, atol=2e-4)


@pytest.mark.parametrize("suffix", [".c3d"])
def test_ezc3d_reads_our_file_as_we_do(tmp_path, suffix):
    import ezc3d

    write_c3d(tmp_path / "m.c3d", motion(), NAMES, 60.0)
    points = ezc3d.c3d(str(tmp_path / "m.c3d"))["data"]["points"]
    np.testing.assert_allclose(points[:3].transpose(2, 1, 0), motion(), atol=MM)


@pytest.mark.parametrize("take", ["animface-mocap/Eyebrows.c3d", "animface-mocap/Nose.c3d", "grid-s1/examples"])
def test_we_read_real_files_as_ezc3d_does(shared_data, take):
    import ezc3d

    path = shared_data(take.split("/")[0]) / take.split("/")[1]
    path = path if path.is_file() else min(path.glob("*.c3d"))
    theirs = ezc3d.c3d(str(path))
    positions, names, rate_hz = read_motion(path)
    np.testing.assert_allclose(positions, theirs["data"]["points"][:3].transpose(2, 1, 0), atol=MM)
    assert list(names) == theirs["parameters"]["POINT"]["LABELS"]["value"]
    assert rate_hz == theirs["parameters"]["POINT"]["RATE"]["value"][0]


@pytest.mark.parametrize(("unit", "factor"), [("m", 1000), ("cm", 10), ("mm", 1), ("M", 1000)])
def test_lengths_in_other_units_become_millimetres(tmp_path, unit, factor):
    path = tmp_path / "m.c3d"
    write_c3d(path, motion(), NAMES, 60.0)
    path.write_bytes(path.read_bytes().replace(b"\x02mm", bytes([len(unit)]) + unit.encode().ljust(2), 1))
    positions, _, _ = read_motion(path)
    np.testing.assert_allclose(positions, motion() * factor, rtol=1e-5)


@pytest.mark.parametrize("name", ["m.c3d", "m.trc", "m.csv"])
def test_what_the_user_says_wins_over_the_file(tmp_path, name):
    {".c3d": write_c3d, ".trc": write_trc, ".csv": write_markers_csv}[name[1:]](tmp_path / name, motion(), NAMES, 60.0)
    positions, _, rate_hz = read_motion(tmp_path / name, ReadOptions(rate_hz=50.0, unit="cm"))
    np.testing.assert_allclose(positions, 10 * motion(), rtol=1e-4, atol=1e-3)
    assert rate_hz == 50.0


def handmade_c3d(machine: int) -> bytes:
    """Two integer frames of two markers at a scale of 0.5, written by hand as another machine would."""
    order = ">" if machine == 86 else "<"

    def real(value: float) -> bytes:
        if machine != 85:
            return struct.pack(f"{order}f", value)
        low, high = struct.unpack("<2H", struct.pack("<f", value * 4))
        return struct.pack("<2H", high, low)

    header = bytearray(512)
    header[:2] = 2, 0x50
    header[2:10] = struct.pack(f"{order}4H", 2, 0, 1, 2)
    header[12:16] = real(0.5)
    header[16:18] = struct.pack(f"{order}H", 3)
    header[20:24] = real(50.0)
    section = bytearray(512)
    section[:4] = 1, 80, 1, machine
    entries = bytes([5, 0xFF]) + b"POINT" + struct.pack(f"{order}H", 3) + b"\0"
    entries += bytes([6, 1]) + b"LABELS" + struct.pack(f"{order}H", 12) + bytes([0xFF, 2, 3, 2]) + b"A  B  " + b"\0"
    section[4 : 4 + len(entries)] = entries
    points = struct.pack(f"{order}16h", 2, 4, 6, 0, 8, 10, 12, 0, -2, -4, -6, 0, 1, 1, 1, -1)
    return bytes(header + section) + points


@pytest.mark.parametrize("machine", [84, 85, 86], ids=["intel", "dec", "mips"])
def test_integer_files_of_every_machine_are_scaled(tmp_path, machine):
    path = tmp_path / "old.c3d"
    path.write_bytes(handmade_c3d(machine))
    positions, names, rate_hz = read_motion(path)
    assert names == ("A", "B")
    assert rate_hz == 50.0
    np.testing.assert_array_equal(positions[0], [[1, 2, 3], [4, 5, 6]])
    np.testing.assert_array_equal(positions[1], [[-1, -2, -3], [np.nan] * 3])


HEADER = "frame,time_s,a_x,a_y,a_z\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "empty"),
        ("\n\n", "empty"),
        ("a,b,c\n1,2,3\n", "line 1"),
        ("frame,time_s,a_x,a_y,a_z,b_x,b_y\n0,0,1,2,3,4,5\n", "line 1: the marker 'b' has no column for z"),
        ("frame,time_s,a_x,a_y,a_z,a_x,a_y,a_z\n", "twice"),
        (HEADER, "0 frames"),
        (HEADER + "0,0,1,2,3\n", "how many frames a second"),
        (HEADER + "0,0,1,2,3\n1,0.1,1,2\n", "line 3"),
        (HEADER + "0,0,1,2,3\n1,0.1,1,two,3\n", "line 3: 'two'"),
        (HEADER + "0,0,1,2,3\n1,0.1,1,inf,3\n", "line 3: a coordinate is infinite"),
        (HEADER + "0,0,1,2,3\n1,0.1,1,1e300,3\n", "line 3: a coordinate is infinite"),
        (HEADER + "0,0,1,2,3\n1,0,1,2,3\n", "advance"),
        (HEADER + "0,0,1,2,3\n1,nan,1,2,3\n", "line 3: the time is not a number"),
        (HEADER + "0,0,1,2,3\n1,0.1,1,2,3\n2,0.2,1,2,3\n3,0.9,1,2,3\n", "evenly"),
    ],
)
def test_a_table_that_cannot_be_used_is_told_with_its_line(tmp_path, text, told):
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(UserFacingError, match=told) as caught:
        read_motion(path)
    assert "m.csv" in caught.value.message


def test_tabs_windows_line_ends_and_a_byte_order_mark_are_read(tmp_path):
    path = tmp_path / "m.tsv"
    rows = "frame\ttime_s\ta_x\ta_y\ta_z\n1\t0\t1\t2\t3\n2\t0.033333\t\t\t\n3\t0.066667\t4\tnan\t6\n"
    path.write_bytes(b"\xef\xbb\xbf" + rows.replace("\n", "\r\n").encode())
    positions, names, rate_hz = read_motion(path)
    assert names == ("a",)
    assert rate_hz == 30.0
    np.testing.assert_array_equal(positions[0], [[1, 2, 3]])
    assert np.isnan(positions[1:]).all()


@pytest.mark.parametrize("name", ["m.c3d", "m.csv"])
@pytest.mark.parametrize("content", [None, b"", b"\x02\x50", b"RIFF" + bytes(range(256)) * 8, b"\xff\xfe\x00" * 900])
def test_foreign_bytes_are_one_sentence(tmp_path, name, content):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(UserFacingError, match=name):
        read_motion(path)


@pytest.mark.parametrize("name", ["m.bvh", "m", "."])
def test_another_kind_of_file_is_refused(tmp_path, name):
    with pytest.raises(UserFacingError):
        read_motion(tmp_path / name)


def test_every_shorter_c3d_is_refused_and_never_read_as_whole(tmp_path):
    whole = tmp_path / "whole.c3d"
    write_c3d(whole, motion(), NAMES, 60.0)
    data = whole.read_bytes()
    used = 7 * 3 * 16
    start = (struct.unpack_from("<H", data, 16)[0] - 1) * 512
    path = tmp_path / "cut.c3d"
    for n in [*range(0, start, 97), start, start + 1, start + used - 1]:
        path.write_bytes(data[:n])
        with pytest.raises(UserFacingError, match=r"cut\.c3d"):
            read_motion(path)


def test_damaged_c3d_bytes_give_an_answer_or_one_sentence(tmp_path):
    write_c3d(tmp_path / "whole.c3d", motion(), NAMES, 60.0)
    whole = (tmp_path / "whole.c3d").read_bytes()
    chance = np.random.default_rng(8)
    path = tmp_path / "damaged.c3d"
    refused = 0
    for _ in range(1500):
        data = bytearray(whole)
        for _ in range(chance.integers(1, 6)):
            data[chance.integers(0, 24) if chance.random() < 0.4 else chance.integers(0, len(data))] = chance.integers(
                256
            )
        path.write_bytes(data)
        try:
            positions, names, rate_hz = read_motion(path)
        except UserFacingError:
            refused += 1
            continue
        assert positions.shape[1:] == (len(names), 3)
        assert positions.nbytes <= 2 * len(data)
        assert not np.isinf(positions).any()
        assert 0 < rate_hz < np.inf
    assert refused > 100


@pytest.mark.parametrize("suffix", WRITERS)
def test_a_folder_that_is_not_there_is_one_sentence(tmp_path, suffix):
    with pytest.raises(UserFacingError, match="cannot be written"):
        WRITERS[suffix](tmp_path / f"nowhere/m{suffix}", motion(), NAMES, 60.0)
