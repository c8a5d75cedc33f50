"""A studio's shapes become ARKit's as its own sheet says."""

import zipfile

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, BlendshapeTrack
from core.motion.readers.sheet import read_sheet
from core.motion.shape_mapping import ShapeMapping, mapped, read_shape_mapping

SHEET = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"


def workbook(path, rows: list[list[str]], shared: bool = True):
    """Write a workbook by hand, its texts in the shared table or in their cells."""
    texts = [cell for row in rows for cell in row]
    cells, n = [], 0
    for r, row in enumerate(rows, 1):
        cells.append(f'<row r="{r}">')
        for c, text in enumerate(row):
            body = f'<c r="{chr(65 + c)}{r}" t="s"><v>{n}</v></c>' if shared else (
                f'<c r="{chr(65 + c)}{r}" t="inlineStr"><is><t>{text}</t></is></c>')  # fmt: skip
            cells.append(body if text else "")
            n += 1
        cells.append("</row>")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("xl/workbook.xml", "<workbook/>")
        archive.writestr(
            "xl/worksheets/sheet1.xml",
            f'<worksheet xmlns="{SHEET}"><sheetData>{"".join(cells)}</sheetData></worksheet>',
        )
        if shared:
            strings = "".join(f"<si><r><t>{text[:2]}</t></r><r><t>{text[2:]}</t></r></si>" for text in texts)
            archive.writestr("xl/sharedStrings.xml", f'<sst xmlns="{SHEET}">{strings}</sst>')
    return path


ROWS = [
    ["ARKIT", "", "Ours", "Status"], ["jawOpen", "", "open", "valid"],
    ["mouthfunnel", "", "max(fun_u, fun_d)", "valid"],
    ["browInnerUp", "", "brow", "Invalid"], ["a remark that is no unit", "", "x", ""], ["tongueOut", "", "", "valid"],
]  # fmt: skip


@pytest.mark.parametrize("kind", ["shared", "inline", "csv"])
def test_a_sheet_is_read_from_every_kind_of_file(tmp_path, kind):
    if kind == "csv":
        path = tmp_path / "map.csv"
        path.write_text("\n".join(",".join(f'"{cell}"' for cell in row) for row in ROWS))
    else:
        path = workbook(tmp_path / "map.xlsx", ROWS, kind == "shared")
    mapping = read_shape_mapping(path)
    assert mapping == ShapeMapping({"jawOpen": ("open",), "mouthFunnel": ("fun_u", "fun_d")}, ("browInnerUp",))


def test_a_unit_takes_the_largest_of_its_shapes_and_what_is_lost_is_said():
    weights = np.array([[0.1, 0.7, 0.2, 0.0, 0.3]], np.float32)
    track = BlendshapeTrack(weights, ("OPEN", "fun_u", "fun_d", "still", "tilt"), 30.0)
    mapping = ShapeMapping({"jawOpen": ("open",), "mouthFunnel": ("fun_u", "fun_d"), "jawLeft": ("absent",)})
    made = mapped(track, mapping)
    assert made.names == ("jawOpen", "mouthFunnel")
    np.testing.assert_allclose(made.weights, [[0.1, 0.7]])
    told = " ".join(made.notes)
    assert "tilt" in told and "absent" in told and "still" not in told
    with pytest.raises(UserFacingError, match="no shape of this track"):
        mapped(track, ShapeMapping({"jawLeft": ("absent",)}))


def test_facegoods_sheet_maps_its_mouth_and_rules_out_the_rest(shared_data):
    mapping = read_shape_mapping(shared_data("facegood") / "Voice2Face_blendshape2ARkit.xlsx")
    assert len(mapping.sources) == 27 and len(mapping.unused) == 24
    assert set(mapping.sources) | set(mapping.unused) | {"tongueOut"} == set(ARKIT_UNITS)
    assert mapping.sources["jawOpen"] == ("mouth_stretch_c",)
    assert mapping.sources["mouthPucker"] == ("mouth_pucker_l", "mouth_pucker_r")
    assert mapping.sources["mouthFrownLeft"] == ("mouth_lipCornerDepress_l", "mouth_lipCornerDepressFix_l")
    assert "browDownLeft" in mapping.unused and "cheekSquintRight" in mapping.unused


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        ([["a", "b"]], "cell ARKit"),
        ([["ARKit"]], "cell ARKit"),
        ([["ARKit", "ours"], ["nothing", "x"]], "maps no shape"),
        ([["ARKit", "ours"], ["jawOpen", "a"], ["JawOpen", "b"]], "row 3: 'jawOpen' comes twice"),
        ([["ARKit", "ours"], ["jawOpen", "a+b"]], "row 2"),
        ([["ARKit", "ours"], ["jawOpen", "max(a,)"]], "row 2"),
    ],
)
def test_a_sheet_that_maps_nothing_is_one_sentence(tmp_path, rows, told):
    with pytest.raises(UserFacingError, match=told):
        read_shape_mapping(workbook(tmp_path / "map.xlsx", rows))


def test_workbooks_that_unfold_without_end_are_refused(tmp_path):
    bomb = '<!DOCTYPE x [<!ENTITY a "aaaaaaaaaa">]><worksheet>&a;</worksheet>'
    for n, sheet in enumerate([bomb, "<worksheet>" + " " * (17 << 20) + "</worksheet>",
                               f'<worksheet xmlns="{SHEET}"><c r="ZZZ9999999"><v>1</v></c></worksheet>']):  # fmt: skip
        path = tmp_path / f"bomb{n}.xlsx"
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("xl/worksheets/sheet1.xml", sheet)
        with pytest.raises(UserFacingError, match=f"bomb{n}"):
            read_sheet(path)


@pytest.mark.parametrize("name", ["map.xlsx", "map.csv", "map.ods"])
@pytest.mark.parametrize("content", [None, b"", b"PK\x03\x04", bytes(range(256)) * 9])
def test_foreign_bytes_are_one_sentence(tmp_path, name, content):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(UserFacingError, match=name):
        read_shape_mapping(tmp_path / name)
