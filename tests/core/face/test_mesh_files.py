import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from core.errors import UserFacingError
from core.face.binding import bind
from core.face.face import PARTS, Face
from core.face.marker_placement import load_marker_file
from core.face.mesh_files import guess_unit_mm, load_face
from core.face.mesh_readers import RawMesh, read_mesh
from core.face.skinning import MarkerSkin

ICT = Path(__file__).resolve().parents[3] / "../shared/data/ict-facekit"

# Places in the 68 points of Multi-PIE, by which the ICT face names its landmarks.
MULTI_PIE = {
    "nose_bridge": 27, "nose_tip": 30, "outer_eye_right": 36, "inner_eye_right": 39, "inner_eye_left": 42,
    "outer_eye_left": 45, "mouth_corner_right": 48, "mouth_corner_left": 54, "upper_lip": 62, "lower_lip": 66,
    "brow_right": 19, "brow_left": 24, "chin": 8,
}  # fmt: skip

SQUARE = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\n"


def write(tmp_path, text, name="mesh.obj"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_obj_vertices_keep_their_numbers_though_texture_seams_pass_through_them(tmp_path):
    text = "v 9 9 9\n" + SQUARE + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt .5 .5\nf 2/1 3/2 4/3\nf 2/5 4/4 5/1\n"
    mesh = read_mesh(write(tmp_path, text))
    np.testing.assert_array_equal(mesh.positions[:, 0], [9, 0, 10, 10, 0])
    np.testing.assert_array_equal(mesh.triangles, [[1, 2, 3], [1, 3, 4]])
    np.testing.assert_array_equal(mesh.uv[2], [1, 0])


def test_obj_quads_and_negative_numbers_and_broken_lines(tmp_path):
    mesh = read_mesh(write(tmp_path, SQUARE + "o head\ng lips\nf -4 -3 \\\n -2 -1\n"))
    np.testing.assert_array_equal(mesh.triangles, [[0, 1, 2], [0, 2, 3]])
    assert mesh.labels == ("head lips",)


@pytest.mark.parametrize("suffix", [".ply", ".glb", ".gltf"])
def test_other_formats_keep_the_order_of_vertices_too(tmp_path, suffix):
    ball = trimesh.creation.icosphere(subdivisions=2)
    order = np.random.default_rng(0).permutation(len(ball.vertices))
    place = np.argsort(order)
    shuffled = trimesh.Trimesh(ball.vertices[order], place[ball.faces], process=False)
    path = tmp_path / f"ball{suffix}"
    if suffix == ".gltf":
        for name, data in trimesh.exchange.gltf.export_gltf(trimesh.Scene(shuffled)).items():
            (tmp_path / ("ball.gltf" if name.endswith(".gltf") else name)).write_bytes(data)
    else:
        shuffled.export(path)
    mesh = read_mesh(path)
    np.testing.assert_allclose(mesh.positions, ball.vertices[order], atol=1e-6)
    np.testing.assert_array_equal(mesh.triangles, place[ball.faces])


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.obj", b"", "holds no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "holds no triangles"),
        ("a.obj", b"v 0 0\nf 1 1 1\n", "line 1"),
        ("a.obj", b"v 0 0 zero\n", "line 1"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "line 4"),
        ("a.obj", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1"),
        ("a.obj", b"v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1"),
        ("a.obj", b"v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "one point"),
        ("a.obj", bytes(range(256)) * 40, "holds no triangles"),
        ("a.ply", b"", "not a readable PLY"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999\nend_header\n", "PLY|triangles"),
        ("a.ply", bytes(range(256)) * 40, "not a readable PLY"),
        ("a.glb", b"glTF\x02\x00\x00\x00\xff\xff\xff\x7f", "not a readable GLB"),
        ("a.gltf", b'{"asset": {"version": "2.0"}, "meshes": 7}', "GLTF|triangles"),
        ("a.gltf", b'{"buffers": [{"uri": "../../secret.bin", "byteLength": 4}]}', "GLTF|triangles"),
        ("a.fbx", b"Kaydara", "is no face mesh"),
        ("face", b"v 0 0 0", "is no face mesh"),
    ],
)
def test_a_bad_file_is_one_sentence(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(UserFacingError, match=message) as caught:
        load_face(tmp_path / name)
    assert name in caught.value.message
    assert "\n" not in caught.value.message


def test_missing_files_and_folders_too(tmp_path):
    with pytest.raises(UserFacingError, match="cannot be read"):
        load_face(tmp_path / "none.obj")
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(UserFacingError, match="not a file"):
        load_face(tmp_path / "folder.obj")


def test_a_marker_file_for_another_mesh_is_refused(tmp_path):
    path = write(tmp_path, SQUARE + "f 1 2 3 4\n")
    markers = write(tmp_path, "marker,vertex\na,4\n", "m.csv")
    with pytest.raises(UserFacingError, match=r"marker a on vertex 4, but mesh\.obj has only 4"):
        load_face(path, markers)


@pytest.mark.parametrize(("unit", "head"), [(1.0, 240.0), (10.0, 24.0), (100.0, 2.4), (1000.0, 0.24), (25.4, 9.5)])
def test_the_unit_is_guessed_from_the_size(unit, head):
    positions = np.array([[0, 0, 0], [0, head, 0], [0.3 * head, 0, 0], [-0.08 * head, 0, 0]])
    mesh = RawMesh(positions, np.array([[0, 1, 2]]), None, ("",), np.zeros(1, int))
    assert guess_unit_mm(mesh, {}) == unit
    assert guess_unit_mm(mesh, {"outer_eye_left": 2, "outer_eye_right": 3}) == unit


def test_names_of_materials_tell_the_parts(tmp_path):
    piece = "v {x} {y} 0\nv {x1} {y} 0\nv {x} {y1} 0\n"
    text, names = "", ("M_Face", "eye ball L", "eyeball R", "teeth_upper", "LowerTeeth", "Tongue", "Mouth_Socket", "?")
    places = [(0, 0), (5, 5), (-9, 5), (0, 8), (0, 9), (0, 11), (0, 13), (0, 15)]
    for k, (name, (x, y)) in enumerate(zip(names, places)):
        text += piece.format(x=x, y=y, x1=x + 1, y1=y + 1)
        text += f"usemtl {name}\nf {3 * k + 1} {3 * k + 2} {3 * k + 3}\n"
    face = load_face(write(tmp_path, text))
    found = [PARTS[part] for part in face.part[::3]]
    assert found == ["skin", "eye_left", "eye_right", "upper_teeth", "lower_teeth", "tongue", "mouth_socket", "other"]


@pytest.fixture(scope="module")
def ict_files(tmp_path_factory):
    if not ICT.exists():
        pytest.skip(f"needs the ICT face at {ICT}")
    points = json.loads((ICT / "vertex_indices.json").read_text())["idx_to_landmark_verts"]
    markers = tmp_path_factory.mktemp("ict") / "landmarks.csv"
    rows = [f"known_{name},{points[place]},{name}" for name, place in MULTI_PIE.items()]
    markers.write_text("marker,vertex,landmark\n" + "\n".join(rows) + "\n")
    return ICT / "generic_neutral_mesh.obj", markers


@pytest.fixture(scope="module")
def ict(ict_files):
    return load_face(*ict_files)


@pytest.fixture(scope="module")
def ict_vertices(ict, actress):
    return bind(ict, actress[0])


def test_the_ict_face_comes_in_mm_with_its_26719_vertices_and_parts(ict):
    assert len(ict.positions) == 26719
    assert 80 < ict.outer_eye_distance < 100
    # ranges from its own table of parts
    assert (ict.part[:14062] == PARTS.index("skin")).all()
    assert (ict.part[17039:19247] == PARTS.index("upper_teeth")).all()
    assert (ict.part[19247:21451] == PARTS.index("lower_teeth")).all()
    assert (ict.part[21451:23021] == PARTS.index("eye_left")).all()
    assert (ict.part[23021:24591] == PARTS.index("eye_right")).all()


def test_a_marker_file_written_from_the_binding_gives_the_same_binding(ict, ict_files, ict_vertices, actress, tmp_path):
    path = tmp_path / "actress-on-ict.csv"
    rows = [f"{name},{vertex}" for name, vertex in zip(actress[0].names, ict_vertices)]
    path.write_text("marker,vertex\n" + "\n".join(rows) + "\n")
    np.testing.assert_array_equal(bind(ict, actress[0], load_marker_file(path)), ict_vertices)
    assert len(load_face(ict_files[0], path).positions) == len(ict.positions)


def test_on_the_ict_face_the_lower_lip_marker_moves_the_lower_lip_only(ict, ict_vertices, actress):
    marker_set, _ = actress
    points = json.loads((ICT / "vertex_indices.json").read_text())["idx_to_landmark_verts"]
    skin = MarkerSkin.fit(ict, ict_vertices, marker_set)
    down = np.zeros((len(marker_set), 3))
    down[marker_set.indices(["lip_lower_mid", "lip_lower_outer_mid"]), 1] = -6.0
    moved = skin.deform(down)[:, 1]
    assert moved[points[66]] < -3
    assert moved[points[57]] < -3
    assert abs(moved[points[62]]) < 0.3
    assert abs(moved[points[51]]) < 0.3
    assert np.abs(moved[17039:19247]).max() == 0


def test_on_the_ict_face_the_jaw_takes_the_lower_teeth_and_the_blink_its_lashes(ict, ict_vertices, actress, face):
    marker_set, vertices = actress
    skin = MarkerSkin.fit(ict, ict_vertices, marker_set)
    opened = skin.deform(face.units["jawOpen"][vertices])
    assert opened[19247:21451, 1].max() < -5
    assert np.abs(opened[17039:19247]).max() == 0
    assert np.abs(opened[21451:24591]).max() == 0
    blink = skin.deform(face.units["eyeBlinkLeft"][vertices])
    assert blink[ict.vertices_of("lashes_upper_left"), 1].mean() < -3
    assert np.abs(blink[ict.vertices_of("lashes_upper_right")]).max() < 0.1


def test_with_no_parts_known_pieces_go_by_their_place(ict, ict_vertices, actress, face):
    marker_set, vertices = actress
    nameless = Face(**{**vars(ict), "part": np.zeros_like(ict.part)})
    skin = MarkerSkin.fit(nameless, ict_vertices, marker_set)
    moved = skin.deform(face.units["jawOpen"][vertices])
    assert moved[20263:20435, 1].max() < -10  # lower incisors
    assert np.abs(moved[18067:18219]).max() == 0  # upper incisors
    blink = skin.deform(face.units["eyeBlinkLeft"][vertices])
    assert np.abs(blink[21451:24591]).max() == 0  # eyeballs
    assert blink[ict.vertices_of("lashes_upper_left"), 1].mean() < -3
