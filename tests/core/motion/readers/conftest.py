"""One motion, written by hand in the layouts that motion tools export."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

NAMES = ("Nose", "LipUp", "Chin", "BrowL")
RATE_HZ = 100.0


def face_motion(n_frames: int = 8) -> np.ndarray:
    """Markers of a face 150 mm high, in a capture volume; one of them is missing for two frames."""
    rest = np.array([[0.0, 0.0, 90.0], [0.0, -30.0, 88.0], [2.0, -80.0, 75.0], [30.0, 70.0, 70.0]])
    positions = (
        rest + np.array([140.0, 1500.0, 20.0]) + np.random.default_rng(5).normal(scale=2.0, size=(n_frames, 4, 3))
    )
    positions[3:5, 2] = np.nan
    return np.round(positions, 5)


def _cell(value: float) -> str:
    return "" if np.isnan(value) else f"{value:.8f}"


def _rows(values: np.ndarray, sep: str, first: Callable[[int], list[str]], cell=_cell) -> str:
    return "".join(
        sep.join([*first(f), *map(cell, row)]) + "\n" for f, row in enumerate(values.reshape(len(values), -1))
    )


def _timed(f: int) -> list[str]:
    return [str(f), f"{f / RATE_HZ:.6f}"]


def nexus(p: np.ndarray) -> str:
    devices = "Devices\n1000\n,,Plate - Force\nFrame,Sub Frame,Fx,Fy,Fz\n,,N,N,N\n1,0,1,2,3\n1,1,1,2,3\n\n"
    head = "Trajectories\n100\n,," + ",,,".join(f"Ada:{name}" for name in NAMES) + ",,\n"
    head += "Frame,Sub Frame" + ",X,Y,Z" * 4 + "\n,," + ",".join(["mm"] * 12) + "\n"
    return devices + head + _rows(p, ",", lambda f: [str(f + 1), "0"])


def motive(p: np.ndarray) -> str:
    def over(texts: list[str]) -> str:
        return ",".join(text for text in texts for _ in range(3))

    head = "Format Version,1.23,Take Name,Take 1,Capture Frame Rate,120.000000,Export Frame Rate,100.000000,"
    head += "Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\n\n"
    kinds = ",".join(["Rigid Body"] * 7) + "," + over(["Rigid Body Marker"]) + "," + over(["Marker"] * 4)
    names = ",".join(["Head"] * 7) + "," + over(["Head:M1"]) + "," + over([f"Head:{name}" for name in NAMES])
    what = ",".join(["Rotation"] * 4 + ["Position"] * 3) + "," + over(["Position"] * 5)
    head += f",Type,{kinds}\n,Name,{names}\n,ID," + ",".join(["1"] * 22) + f"\n,,{what}\n"
    head += "Frame,Time (Seconds),X,Y,Z,W,X,Y,Z" + ",X,Y,Z" * 5 + "\n"
    rigid = ["0.1", "0.2", "0.3", "0.9", "1", "2", "3", "4", "5", "6"]
    return head + _rows(p / 1000, ",", lambda f: [*_timed(f), *rigid])


def qualisys(p: np.ndarray) -> str:
    head = "NO_OF_FRAMES\t8\nNO_OF_CAMERAS\t6\nNO_OF_MARKERS\t4\nFREQUENCY\t100\nDATA_INCLUDED\t3D\n"
    head += "MARKER_NAMES\t" + "\t".join(NAMES) + "\n"
    return head + _rows(np.nan_to_num(p), "\t", lambda f: [])[0:]


def qualisys_headed(p: np.ndarray) -> str:
    heads = "Frame\tTime\t" + "\t".join(f"{name} {axis}" for name in NAMES for axis in "XYZ")
    lines = qualisys(p).split("\n")
    rows = [f"{f + 1}\t{f / RATE_HZ:.5f}\t{line}" for f, line in enumerate(lines[6:-1])]
    return "\n".join([*lines[:6], heads, *rows]) + "\n"


def two_rows_decimal_comma(p: np.ndarray) -> str:
    head = "Frame;Time;" + ";;;".join(NAMES) + ";;\n;s" + ";X (cm);Y (cm);Z (cm)" * 4 + "\n"
    body = _rows(p / 10, ";", _timed)
    return head + body.replace(".", ",")


def one_row(pattern: str, scale: float = 1.0, columns: str = "xyz") -> Callable[[np.ndarray], str]:
    def write(p: np.ndarray) -> str:
        order = ["xyz".index(axis) for axis in columns]
        heads = [pattern.format(n=name, a=axis, A=axis.upper()) for name in NAMES for axis in columns]
        return ",".join(["Frame#", "Time (s)", *heads]) + "\n" + _rows(p[..., order] / scale, ",", _timed)

    return write


def by_axis(p: np.ndarray) -> str:
    """All x first, as OpenFace orders its columns; times in milliseconds; a column that is no point."""
    heads = [f"{axis}_{name}" for axis in "xyz" for name in NAMES]
    rows = _rows(p.transpose(0, 2, 1), ",", lambda f: [f"{f * 10}", "0.98"])
    return ",".join(["timestamp_ms", "quality", *heads]) + "\n" + rows


def one_row_a_point(p: np.ndarray) -> str:
    rows = ["frame,time_s,marker,x,y,z"]
    for f, frame in enumerate(p):
        rows += [",".join([*_timed(f), name, *map(_cell, at)]) for name, at in zip(NAMES, frame) if at[0] == at[0]]
    return "\n".join(rows) + "\n"


LAYOUTS: dict[str, tuple[str, Callable[[np.ndarray], str]]] = {
    "nexus": (".csv", nexus),
    "motive": (".csv", motive),
    "qualisys": (".tsv", qualisys),
    "qualisys headed": (".tsv", qualisys_headed),
    "two rows, decimal comma, cm": (".csv", two_rows_decimal_comma),
    "name:X": (".csv", one_row("{n}:{A}")),
    "name_x in metres": (".csv", one_row("{n}_{a}", 1000.0)),
    "name.translateX": (".csv", one_row("{n}.translate{A}")),
    "nameX, columns z y x": (".csv", one_row("{n}{A}", columns="zyx")),
    "name_x (cm)": (".csv", one_row("{n}_{a} (cm)", 10.0)),
    "by axis, milliseconds": (".csv", by_axis),
    "one row a point": (".csv", one_row_a_point),
}


@pytest.fixture
def layouts() -> dict[str, tuple[str, Callable[[np.ndarray], str]]]:
    """Return each layout's ending and its writer from positions (F, 4, 3) mm."""
    return LAYOUTS


@pytest.fixture
def motion() -> np.ndarray:
    """Return 8 frames of 4 markers, mm, one missing in frames 3 and 4."""
    return face_motion()


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run a test that asks for ``layout`` on each of them."""
    if "layout" in metafunc.fixturenames:
        metafunc.parametrize("layout", list(LAYOUTS))
