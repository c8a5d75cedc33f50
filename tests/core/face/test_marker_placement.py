import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.marker_placement import ACTRESS_FILE, MarkerPlacement, load_marker_file, marker_set_on
from core.motion.marker_set import LANDMARKS


@pytest.fixture(scope="module")
def table():
    return load_marker_file(ACTRESS_FILE)


def test_the_actress_has_the_papers_102_markers_of_which_90_are_kept(table):
    assert len(table.names) == 102
    assert table.kept.sum() == 90
    assert len(set(table.vertices.tolist())) == 102


def test_every_landmark_is_a_marker_that_is_kept(table):
    assert set(table.landmarks) == set(LANDMARKS)
    kept = {name for name, keep in zip(table.names, table.kept) if keep}
    assert set(table.landmarks.values()) <= kept
    assert set(table.groups) == {"origin", "rigid", "jaw", "upper_lip", "lower_lip", "lips"}
    assert set(table.groups["upper_lip"]) | set(table.groups["lower_lip"]) < set(table.groups["lips"])
    assert not set(table.groups["upper_lip"]) & set(table.groups["lower_lip"])


def test_left_and_right_mirror_each_other_and_left_is_the_characters(face, table):
    at = dict(zip(table.names, face.positions[table.vertices]))
    for name in table.names:
        if name.endswith("_left"):
            assert at[name][0] > 0
            np.testing.assert_allclose(at[name] * [-1, 1, 1], at[name.replace("_left", "_right")], atol=0.6)
        elif not name.endswith("_right"):
            assert abs(at[name][0]) < 0.1


def test_markers_lie_where_anatomy_has_them(face, table):
    at = dict(zip(table.names, face.positions[table.vertices]))
    down = ["forehead_mid", "glabella", "nose_bridge", "nose_tip", "philtrum", "lip_upper_outer_mid", "lip_upper_mid",
            "lip_lower_mid", "lip_lower_outer_mid", "chin_mid", "chin_tip"]  # fmt: skip
    heights = [at[name][1] for name in down]
    assert heights == sorted(heights, reverse=True)
    assert max(at, key=lambda name: at[name][2]) == "nose_tip"
    assert at["brow_inner_left"][1] > at["lid_upper_left"][1] > at["lid_lower_left"][1] > at["cheek_upper_left"][1]


def test_rigid_markers_hardly_move_in_any_expression(face, table):
    rigid = [table.vertices[table.names.index(name)] for name in table.groups["rigid"]]
    for name, unit in face.units.items():
        assert np.linalg.norm(unit[rigid], axis=1).max() < 1.6, name


def test_rest_is_measured_from_the_origin_marker(face, table):
    markers = marker_set_on(face, table)
    assert len(markers) == 90
    origin = markers.group("origin")
    assert np.abs(markers.rest[origin]).max() == 0
    apart = np.linalg.norm(markers.rest[0] - markers.rest[5])
    a, b = (face.positions[table.vertices[table.names.index(markers.names[k])]] for k in (0, 5))
    assert apart == pytest.approx(np.linalg.norm(a - b), rel=1e-5)
    assert len(marker_set_on(face, table, kept_only=False)) == 102


def test_a_vertex_beyond_the_face_is_refused(face):
    stray = MarkerPlacement(("a",), np.array([10**6]), np.array([True]))
    with pytest.raises(UserFacingError, match=r"Marker a sits on vertex 1000000"):
        marker_set_on(face, stray)


def test_a_short_table_needs_only_marker_and_vertex(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("\ufeffMarker,Vertex\r\na,3\r\n\r\nb,0\r\n", encoding="utf-8")
    placement = load_marker_file(path)
    assert placement.names == ("a", "b")
    assert placement.vertices.tolist() == [3, 0]
    assert placement.kept.all()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "header"),
        ("name,number\na,1\n", "header"),
        ("marker,vertex\n", "names no markers"),
        ("marker,vertex\na,one\n", "line 2"),
        ("marker,vertex\na,1\nb,-4\n", "line 3"),
        ("marker,vertex\na\n", "line 2"),
        ("marker,vertex\n,5\n", "line 2"),
        ("marker,vertex\na,99999999999999999999\n", "line 2"),
        ("marker,vertex\na,nan\n", "line 2"),
        ("marker,vertex\na,1\na,2\n", "marker a twice"),
        ("marker,vertex\na,1\nb,1\n", "vertex 1 twice"),
        ("marker,vertex,kept\na,1,yes\n", "line 2: kept"),
        ("marker,vertex,landmark\na,1,third_eye\n", "line 2: 'third_eye'"),
        ("marker,vertex,groups\na,1,origin\nb,2,origin\n", "more than one origin"),
        ("marker,vertex\na,\x00\n", "line 2"),
    ],
)
def test_a_bad_table_is_one_sentence_that_says_where(tmp_path, text, message):
    path = tmp_path / "m.csv"
    path.write_text(text)
    with pytest.raises(UserFacingError, match=message) as caught:
        load_marker_file(path)
    assert "m.csv" in caught.value.message
    assert "\n" not in caught.value.message


def test_a_missing_or_binary_file_is_a_sentence_too(tmp_path):
    with pytest.raises(UserFacingError, match="cannot be read"):
        load_marker_file(tmp_path / "none.csv")
    with pytest.raises(UserFacingError, match="cannot be read"):
        load_marker_file(tmp_path)
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00\x81" * 20)
    with pytest.raises(UserFacingError, match="not text"):
        load_marker_file(tmp_path / "b.csv")
