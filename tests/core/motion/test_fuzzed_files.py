"""Whatever bytes a file holds, its reader answers or refuses in one sentence, soon, and within memory like its size."""

from __future__ import annotations

import json
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, BlendshapeTrack
from core.motion.live_link_face import write_live_link_face
from core.motion.marker_table import read_marker_table
from core.motion.motion_files import read_takes, write_c3d, write_markers_csv, write_trc
from core.motion.motion_track import ReadOptions
from core.motion.readers.blendshape_files import is_blendshape_file, read_blendshapes, read_shape_names
from core.motion.shape_mapping import read_shape_mapping

# bytes that may be held for a byte of the file, and in any case; lists of short cells weigh most
PER_BYTE, IN_ANY_CASE = 200, 8 << 20
# generous, since other work may share the processor
LONGEST_S = 10.0
SHORT, LONG = 40, 20_000
OPTIONS = ReadOptions(rate_hz=60.0, unit="mm", picture_px=(640, 480))


def _motion() -> np.ndarray:
    positions = np.random.default_rng(0).normal(scale=60, size=(6, 3, 3)).round(3)
    positions[2, 1] = np.nan
    return positions


def _takes(path: Path) -> None:
    """Read with what the file says, and with all that a user can say."""
    for options in (None, OPTIONS):
        try:
            tracks = read_takes(path, options)
        except UserFacingError:
            if options is not None:
                raise
            continue
        for track in tracks:
            assert track.positions.shape[1:] == (len(track.names), 3) and len(set(track.names)) == len(track.names)
            assert not np.isinf(track.positions).any() and 0 < track.rate_hz <= 10_000


def _weights(path: Path) -> None:
    is_blendshape_file(path)
    track = read_blendshapes(path, ("a", "b", "c") if path.suffix == ".npy" else None, 60.0)
    known = track.weights[np.isfinite(track.weights)]
    assert track.weights.shape[1] == len(track.names) and ((known >= 0) & (known <= 1)).all()


def _csv(path: Path) -> Path:
    write_markers_csv(path, _motion(), ("nose", "lip", "chin"), 60.0)
    return path


def _c3d(path: Path) -> Path:
    write_c3d(path, _motion(), ("nose", "lip", "chin"), 60.0)
    return path


def _trc(path: Path) -> Path:
    write_trc(path, _motion(), ("nose", "lip", "chin"), 60.0)
    return path


def _live(path: Path) -> Path:
    weights = np.random.default_rng(0).uniform(0, 1, (5, 52)).round(3).astype(np.float32)
    write_live_link_face(path, BlendshapeTrack(weights, ARKIT_UNITS, 2.0))
    return path


def _table_of_weights(path: Path) -> Path:
    heads = ["time", *ARKIT_UNITS[:8]]
    path.write_text("\n".join([",".join(heads), *(",".join([f"{f / 60:.4f}"] + ["0.25"] * 8) for f in range(5))]))
    return path


def _npy(path: Path) -> Path:
    np.save(path, np.random.default_rng(0).uniform(0, 1, (7, 3)))
    return path


def _npz(path: Path) -> Path:
    points = np.random.default_rng(0).integers(0, 9000, (8, 5, 3), dtype=np.int16)
    np.savez_compressed(
        path,
        xyz64=points,
        start=[0, 3, 8],
        clips=["a", "b"],
        landmark_index=np.arange(5),
        fps=25,
        width=360,
        height=288,
    )
    return path


def _npz_weights(path: Path) -> Path:
    np.savez(path, weights=np.eye(3), names=np.array(["a", "b", "c"]), fps=30.0)
    return path


def _xlsx(path: Path) -> Path:
    import zipfile

    sheet = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
    texts = ["ARKit", "ours", "status", "jawOpen", "max(a,b)", "valid", "mouthLeft", "c", "Invalid"]
    cells = "".join(f'<c r="{"ABC"[n % 3]}{n // 3 + 1}" t="s"><v>{n}</v></c>' for n in range(9))
    # stored, not deflated: damage then reaches the sheet itself
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("xl/worksheets/sheet1.xml", f'<worksheet xmlns="{sheet}"><row>{cells}</row></worksheet>')
        strings = "".join(f"<si><t>{text}</t></si>" for text in texts)
        archive.writestr("xl/sharedStrings.xml", f'<sst xmlns="{sheet}">{strings}</sst>')
    return path


def _mapping(path: Path) -> Path:
    path.write_text('ARKit,ours,status\njawOpen,"max(a,b)",valid\nmouthLeft,c,invalid\nmouthRight,d,\n')
    return path


def _names(path: Path) -> Path:
    if path.suffix == ".npy":
        np.save(path, np.array(["jawOpen", "smirk", "mouthLeft"]))
    else:
        path.write_text(json.dumps(["jawOpen", "smirk"]) if path.suffix == ".json" else "jawOpen\nsmirk\nmouthLeft\n")
    return path


def _marker_table(path: Path) -> Path:
    path.write_text("marker,kept,groups,landmark\nnose,1,origin;rigid,nose_bridge\nlip,1,lips,lower_lip\near,0,,\n")
    return path


# name of the file: who writes a sound one, who reads it
KINDS: dict[str, tuple[Callable[[Path], Path], Callable[[Path], object]]] = {
    "m.c3d": (_c3d, _takes), "m.trc": (_trc, _takes), "m.csv": (_csv, _takes), "m.npz": (_npz, _takes),
    "live.csv": (_live, _weights), "w.csv": (_table_of_weights, _weights), "w.npy": (_npy, _weights),
    "w.npz": (_npz_weights, _weights), "map.xlsx": (_xlsx, read_shape_mapping),
    "map.csv": (_mapping, read_shape_mapping),
    "n.txt": (_names, read_shape_names), "n.json": (_names, read_shape_names), "n.npy": (_names, read_shape_names),
    "markers.csv": (_marker_table, read_marker_table),
}  # fmt: skip
TEXT = [name for name in KINDS if name.split(".")[-1] in ("csv", "trc", "txt", "json")]


def bounded(read: Callable[[Path], object]) -> Callable[[Path], object]:
    """Read, and fail where that took long or held much more than the file holds."""

    def measured(path: Path) -> object:
        size = path.stat().st_size
        # only the reader is traced, which slows whatever is
        tracemalloc.start()
        began_s = time.perf_counter()
        try:
            return read(path)
        finally:
            took_s, peak = time.perf_counter() - began_s, tracemalloc.get_traced_memory()[1]
            tracemalloc.stop()
            assert took_s < LONGEST_S
            assert peak < PER_BYTE * size + IN_ANY_CASE

    return measured


@pytest.fixture
def sound_files(tmp_path) -> dict[str, bytes]:
    """Return one sound file of every kind."""
    return {name: write(tmp_path / name).read_bytes() for name, (write, _) in KINDS.items()}


@pytest.mark.parametrize("name", KINDS)
def test_sound_files_are_read(tmp_path, name):
    write, read = KINDS[name]
    bounded(read)(write(tmp_path / name))


@pytest.mark.parametrize("name", KINDS)
@pytest.mark.parametrize("n", [SHORT, pytest.param(LONG, marks=pytest.mark.prove)])
def test_damaged_and_spliced_files_are_read_or_refused(tmp_path, survives_damage, sound_files, name, n):
    others = [raw for other, raw in sound_files.items() if other != name]
    refused = survives_damage(tmp_path / name, bounded(KINDS[name][1]), n, others)
    # lists of names are mended by hardly anything that is done to them
    assert refused > (n / 20 if name.startswith("n.") else n / 10)


@pytest.mark.parametrize("n", [SHORT, pytest.param(LONG, marks=pytest.mark.prove)])
def test_damaged_layouts_of_other_tools_are_read_or_refused(tmp_path, survives_damage, layout_files, n):
    others = list(layout_files.values())
    for number, (name, raw) in enumerate(layout_files.items()):
        path = tmp_path / f"layout{number}{Path(name).suffix}"
        path.write_bytes(raw)
        assert survives_damage(path, bounded(_takes), n // 4, others) > 0


@pytest.fixture
def layout_files(tmp_path) -> dict[str, bytes]:
    """Return the tables that motion tools and face trackers write, by name."""
    motion = np.array([[[0, 0, 90], [1, -80, 75]], [[1, 2, 91], [2, -80, 76]], [[0, 1, 92], [np.nan] * 3]])
    cells = [["" if v != v else f"{v:.2f}" for v in frame.ravel()] for frame in motion]

    def rows(sep: str, *, time_s: bool = True) -> str:
        return "\n".join(
            sep.join([str(f), *([f"{f / 50:.3f}"] if time_s else []), *row]) for f, row in enumerate(cells)
        )

    points = [f"{f},{k},{0.1 * k},{0.2},{0.3}" for f in range(3) for k in range(24)]
    numbered = [",".join([str(f), *map(str, range(30, 90))]) for f in range(3)]
    openface = ["frame, timestamp, confidence, success, " + ", ".join(f"{a}_{k}" for a in "xy" for k in range(21))]
    openface += [", ".join([str(f), f"{f / 30:.3f}", "1", "1", *map(str, range(50, 92))]) for f in range(3)]
    files = {
        "nexus.csv": "Trajectories\n50\n,,A:n,,,A:c,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n" + rows(","),
        "motive.csv": "Format Version,1.23,Export Frame Rate,50,Length Units,Meters\n\n,Type" + ",Marker" * 6
        + "\n,Name,n,n,n,c,c,c\n,," + ",".join(["Position"] * 6) + f"\nFrame,Time,X,Y,Z,X,Y,Z\n{rows(',')}\n",
        "qualisys.tsv": "NO_OF_FRAMES\t3\nFREQUENCY\t50\nMARKER_NAMES\tn\tc\n"
        + "Frame\tTime\tn X\tn Y\tn Z\tc X\tc Y\tc Z\n" + rows("\t"),
        "comma.csv": "Frame;Time;n;;;c;;\n;s;X;Y;Z;X;Y;Z\n" + rows(";").replace(".", ","),
        "colon.csv": "Frame,n:X,n:Y,n:Z,c:X,c:Y,c:Z\n" + rows(",", time_s=False),
        "points.csv": "frame,landmark,x,y,z\n" + "\n".join(points),
        "numbered.csv": "frame," + ",".join(f"x{k},y{k},z{k}" for k in range(20)) + "\n" + "\n".join(numbered),
        "openface.csv": "\n".join(openface),
    }  # fmt: skip
    return {name: text.encode() for name, text in files.items()}


WORDS = """0 1 -2.5 1,5 nan inf 1e300 1_0 x y z X Y Z a_x a_y a_z b:X b:Y b:Z x0 y0 z0 x_1 frame Frame# time time_s
timestamp_ms mm m Position Marker Name Type MARKER_NAMES Trajectories FREQUENCY marker confidence success Timecode
BlendShapeCount 00:00:01:02.003 23:59:59:29.5 61 jawOpen ARKit status invalid max(a,b) PathFileType DataRate Units 60
" "a \u0663 \ufeff [ {"""
CELLS = st.sampled_from(["", "Sub Frame", "Length Units", "fps: 3", *WORDS.split()])
LINES = st.lists(st.lists(CELLS, max_size=9), max_size=14)


def _tables(n: int):
    """Let hypothesis compose tables of the words that readers know."""

    @settings(max_examples=n, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck), database=None)
    @given(LINES, st.sampled_from(",;\t"), st.sampled_from(["\n", "\r\n", "\r"]))
    def check(path, read, lines, sep, end):
        path.write_text(end.join(sep.join(cells) for cells in lines), encoding="utf-8", newline="")
        try:
            bounded(read)(path)
        except UserFacingError as error:
            assert path.name in str(error)

    return check


@pytest.mark.parametrize("name", TEXT)
@pytest.mark.parametrize("n", [SHORT, pytest.param(LONG // 10, marks=pytest.mark.prove)])
def test_tables_of_known_words_in_any_order_are_read_or_refused(tmp_path, name, n):
    _tables(n)(tmp_path / name, KINDS[name][1])


def _bytes(n: int, head: bytes):
    """Let hypothesis compose bytes behind the first ones of a sound file."""

    @settings(max_examples=n, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck), database=None)
    @given(st.integers(0, len(head)), st.binary(max_size=2000))
    def check(path, read, cut, tail):
        path.write_bytes(head[:cut] + tail)
        try:
            bounded(read)(path)
        except UserFacingError as error:
            assert path.name in str(error)

    return check


@pytest.mark.parametrize("name", [name for name in KINDS if name not in TEXT])
@pytest.mark.parametrize("n", [SHORT, pytest.param(LONG // 10, marks=pytest.mark.prove)])
def test_any_bytes_behind_a_sound_head_are_read_or_refused(tmp_path, sound_files, name, n):
    _bytes(n, sound_files[name])(tmp_path / name, KINDS[name][1])
