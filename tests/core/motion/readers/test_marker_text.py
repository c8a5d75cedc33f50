"""One motion is read the same from every layout; what a table leaves open is asked for in one sentence."""

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.motion_files import read_motion, read_takes
from core.motion.motion_track import RateUnknown, ReadOptions, UnitUnknown

NAMES = ("Nose", "LipUp", "Chin", "BrowL")


def test_every_layout_gives_the_same_motion(tmp_path, layouts, motion, layout):
    suffix, write = layouts[layout]
    path = tmp_path / f"take{suffix}"
    path.write_text(write(motion))
    (track,) = read_takes(path)
    np.testing.assert_allclose(track.positions, motion, atol=1e-3)
    assert tuple(name.split(":")[-1] for name in track.names) == NAMES
    assert track.rate_hz == 100.0
    assert track.true_scale and track.has_depth


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
def test_names_survive_the_encodings_that_tools_write(tmp_path, encoding):
    text = "Frame,Time,Kinn_ä_x,Kinn_ä_y,Kinn_ä_z,b_x,b_y,b_z\r\n0,0,0,0,0,100,1,1\r\n1,0.01,1,1,1,100,1,1\r\n"
    (tmp_path / "m.csv").write_bytes(text.encode(encoding))
    assert read_motion(tmp_path / "m.csv")[1] == ("Kinn_ä", "b")


def table(tmp_path, scale: float, time: bool = True, heads: str = "{n}:{a}"):
    motion = scale * np.random.default_rng(0).uniform(-1, 1, (5, 12, 3))
    names = [heads.format(n=f"m{k}a", a=a) for k in range(12) for a in "XYZ"]
    rows = [["Frame", *(["Time"] if time else []), *names]]
    rows += [[f, *([f / 50] if time else []), *frame.ravel().tolist()] for f, frame in enumerate(motion)]
    path = tmp_path / "m.csv"
    path.write_text("\n".join(",".join(map(str, row)) for row in rows))
    return path, motion


@pytest.mark.parametrize(("scale", "unit", "factor"), [(80, "mm", 1), (8, "cm", 10), (0.08, "m", 1000)])
def test_the_unit_is_told_from_the_size_of_a_face_and_said(tmp_path, scale, unit, factor):
    path, motion = table(tmp_path, scale)
    (track,) = read_takes(path)
    np.testing.assert_allclose(track.positions, motion * factor, rtol=1e-4)
    assert any(f"taken as {unit}" in note for note in track.notes)


def test_what_the_user_says_of_the_unit_wins(tmp_path):
    path, motion = table(tmp_path, 8)
    positions, _, _ = read_motion(path, ReadOptions(unit="in"))
    np.testing.assert_allclose(positions, motion * 25.4, rtol=1e-4)
    with pytest.raises(UserFacingError, match="no unit of length"):
        read_motion(path, ReadOptions(unit="parsec"))


@pytest.mark.parametrize("scale", [1e-6, 0.6, 1e6])
def test_a_size_that_is_no_face_in_any_unit_is_asked_for(tmp_path, scale):
    path, _ = table(tmp_path, scale)
    with pytest.raises(UnitUnknown, match="unit of length"):
        read_motion(path)
    assert len(read_motion(path, ReadOptions(unit="mm"))[0]) == 5


def test_a_table_without_times_asks_for_its_rate(tmp_path):
    path, _ = table(tmp_path, 80, time=False)
    with pytest.raises(RateUnknown, match="how many frames a second") as caught:
        read_motion(path)
    assert caught.value.remedy
    assert read_motion(path, ReadOptions(rate_hz=29.97))[2] == 29.97
    with pytest.raises(UserFacingError, match="no rate"):
        read_motion(path, ReadOptions(rate_hz=-1.0))


def test_the_own_layout_is_millimetres_whatever_its_size(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("frame,time_s,a_x,a_y,a_z\n0,0,0.1,0.2,0.3\n1,0.1,0,0,0\n")
    positions, _, _ = read_motion(path)
    np.testing.assert_allclose(positions[:, 0], [[0.1, 0.2, 0.3], [0, 0, 0]], atol=1e-6)


def test_zeros_of_a_marker_that_comes_and_goes_are_missing_and_of_the_origin_are_not(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("Time,o:X,o:Y,o:Z,a:X,a:Y,a:Z\n0,0,0,0,90,50,60\n0.1,0,0,0,0,0,0\n")
    (track,) = read_takes(path)
    np.testing.assert_array_equal(track.positions[:, 0], 0.0)
    assert np.isnan(track.positions[1, 1]).all() and any("missing" in note for note in track.notes)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("Time,a:X,a:Y,a:Z\n0,1,2,3\n\n0.1,1,2,3\n", "line 3 is empty"),
        ("Time,a:X,a:Y,a:Z\n0,1,2\n", "line 2: 3 cells"),
        ("Time,a:X,a:Y,a:Z\n0,1,2,3,4\n", "line 2: 5 cells"),
        ("Frame,Time\n,,X,Y,Z\n0,0,1,2,3\n", "names the markers"),
        (",,A,,\nFrame,Time,X,Z,Y\n0,0,1,2,3\n", "line 2: column 4"),
        ("Frame,Time,X,Y,Z\n0,0,1,2,3\n", "names the markers"),
        (",,A,,,A,,\nFrame,Time,X,Y,Z,X,Y,Z\n0,0,1,2,3,1,2,3\n", "column 6"),
        ("x,y,z,marker\n1,2,3,a\n", "which frame"),
        ("Timecode,BlendShapeCount,JawOpen\n00:00:00:00.000,61,0\n", "weights of blendshapes"),
    ],
)
def test_what_cannot_be_used_is_told_with_its_place(tmp_path, text, told):
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(UserFacingError, match=told) as caught:
        read_motion(path)
    assert "m.csv" in caught.value.message


def test_a_header_that_promises_a_table_larger_than_the_file_is_refused(tmp_path):
    path = tmp_path / "m.csv"
    heads = ",".join(f"m{k}a:{axis}" for k in range(3000) for axis in "XYZ")
    path.write_text(f"Time,{heads}\n" + "1\n" * 500_000)
    with pytest.raises(UserFacingError, match="line 2"):
        read_motion(path)


@pytest.mark.parametrize("take", ["Jaw", "Nose"])
def test_a_real_take_is_read_alike_from_the_layouts_of_other_tools(tmp_path, shared_data, take):
    positions, names, rate_hz = read_motion(shared_data("animface-mocap") / f"{take}.c3d")
    positions = positions[:40]
    heads = ",".join(f"{name}:{axis}" for name in names for axis in "XYZ")
    rows = (
        ",".join([f"{f / rate_hz:.6f}", *(f"{v / 10:.6f}" for v in frame.ravel())]) for f, frame in enumerate(positions)
    )
    path = tmp_path / "m.csv"
    path.write_text(f"Time,{heads}\n" + "\n".join(rows))
    (track,) = read_takes(path)
    np.testing.assert_allclose(track.positions, positions, atol=1e-3)
    assert track.names == names and track.rate_hz == rate_hz
    assert any("taken as cm" in note for note in track.notes)
