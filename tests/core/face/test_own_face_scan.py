import json
import struct

import numpy as np
import pytest
import trimesh

from core.errors import UserFacingError
from core.face.own_face_scan import largest_piece_share, read_scan
from core.media.picture import read_picture


@pytest.fixture(scope="module")
def ball():
    return trimesh.creation.icosphere(subdivisions=2, radius=10.0)


def obj_of(mesh, extra="", uv=False):
    lines = [extra, *(f"v {x} {y} {z}" for x, y, z in mesh.vertices)]
    if uv:
        lines += [f"vt {k % 7 / 7} {k % 5 / 5}" for k in range(3 * len(mesh.faces))]
    for t, (a, b, c) in enumerate(mesh.faces + 1):
        lines.append(f"f {a}/{3 * t + 1} {b}/{3 * t + 2} {c}/{3 * t + 3}" if uv else f"f {a} {b} {c}")
    return "\n".join(lines) + "\n"


def picture(path, colour=(10, 200, 30)):
    import cv2

    cv2.imwrite(str(path), np.full((8, 12, 3), colour[::-1], np.uint8))
    return path


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".stl", ".glb"])
def test_the_same_ball_comes_out_of_every_format(tmp_path, ball, suffix):
    path = tmp_path / f"scan{suffix}"
    if suffix == ".obj":
        path.write_text(obj_of(ball))
    else:
        ball.export(path)
    scan = read_scan(path)
    assert len(scan.triangles) == len(ball.faces)
    made = trimesh.Trimesh(scan.positions, scan.triangles, process=False)
    assert made.is_watertight
    assert made.volume == pytest.approx(ball.volume, rel=1e-5)
    assert largest_piece_share(scan) == 1.0


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.obj", b"", "holds no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "holds no triangles"),
        ("a.obj", b"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1"),
        ("a.obj", b"v 0 0 0\nv 1e300 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "only 1 triangles, which are no scan"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\n" + b"f 1 2 3\n" * 99, "only 0 triangles"),
        ("a.stl", b"", "STL|triangles"),
        ("a.stl", b"solid nothing\nendsolid nothing\n", "STL|triangles"),
        ("a.stl", b"\0" * 80 + b"\xff\xff\xff\x7f", "STL|triangles"),
        ("a.stl", b"\0" * 80 + struct.pack("<I", 60) + struct.pack("<12fH", *[float("nan")] * 12, 0) * 60, "a.stl"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999\nend_header\n", "PLY|triangles"),
        ("a.glb", b"glTF\x02\x00\x00\x00\xff\xff\xff\x7f", "not a readable glTF"),
        ("a.blend", b"BLENDER", "is no scan that can be read"),
    ],
)
def test_a_file_that_is_no_scan_is_one_sentence(tmp_path, name, content, message):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(UserFacingError, match=message) as caught:
        read_scan(tmp_path / name)
    assert name in caught.value.message
    assert "\n" not in caught.value.message


def test_a_scan_that_is_not_there(tmp_path):
    for name in ("a.obj", "a.stl"):
        with pytest.raises(UserFacingError, match=name):
            read_scan(tmp_path / name)


def test_of_named_pieces_only_the_skin_is_taken(tmp_path, ball):
    small = ball.copy().apply_scale(0.2)
    text = "usemtl M_Face\n" + obj_of(ball) + "usemtl EyeLeft\n"
    text += "".join(f"v {x} {y} {z}\n" for x, y, z in small.vertices)
    text += "".join("f " + " ".join(str(v + 1 + len(ball.vertices)) for v in face) + "\n" for face in small.faces)
    path = tmp_path / "scan.obj"
    path.write_text(text)
    scan = read_scan(path)
    assert len(scan.triangles) == len(ball.faces)
    assert "no skin were left out" in scan.notes[0]


def test_texture_of_an_obj_file_with_coordinates_of_corners(tmp_path, ball):
    path = tmp_path / "scan.obj"
    path.write_text(obj_of(ball, "mtllib skin.mtl", uv=True))
    assert read_scan(path).picture is None
    assert not read_scan(path).has_colour
    (tmp_path / "skin.mtl").write_text("newmtl a\nmap_Kd -s 1 1 1 colour.png\n")
    picture(tmp_path / "colour.png")
    scan = read_scan(path)
    assert scan.picture.shape == (8, 12, 3)
    assert scan.has_colour
    # every triangle keeps the coordinates of its own corners, though vertices are shared
    k = np.arange(3 * len(ball.faces)).reshape(-1, 3)
    np.testing.assert_allclose(scan.corner_uv, np.stack([k % 7 / 7, k % 5 / 5], axis=2), atol=1e-6)
    other = read_scan(path, picture(tmp_path / "other.png", (1, 2, 3)))
    assert other.picture[0, 0].tolist() == [1, 2, 3]


def test_a_library_outside_of_the_scans_folder_is_not_opened(tmp_path, ball):
    inner = tmp_path / "inner"
    inner.mkdir()
    picture(tmp_path / "secret.png")
    (inner / "skin.mtl").write_text("map_Kd ../secret.png\n")
    (tmp_path / "skin.mtl").write_text("map_Kd secret.png\n")
    for library in ("skin.mtl", "../skin.mtl", "\0", "x" * 9000):
        path = inner / "scan.obj"
        path.write_text(obj_of(ball, f"mtllib {library}", uv=True))
        assert read_scan(path).picture is None


def test_a_texture_for_a_scan_without_coordinates_is_refused(tmp_path, ball):
    path = tmp_path / "scan.obj"
    path.write_text(obj_of(ball))
    with pytest.raises(UserFacingError, match="no texture coordinates"):
        read_scan(path, picture(tmp_path / "colour.png"))


def test_colours_of_vertices(tmp_path, ball):
    colours = np.random.default_rng(0).integers(0, 256, (len(ball.vertices), 3), dtype=np.uint8)
    made = trimesh.Trimesh(ball.vertices, ball.faces, vertex_colors=colours, process=False)
    made.export(tmp_path / "scan.ply")
    np.testing.assert_array_equal(read_scan(tmp_path / "scan.ply").colours, colours)
    lines = [f"v {x} {y} {z} {r / 255} {g / 255} {b / 255}" for (x, y, z), (r, g, b) in zip(ball.vertices, colours)]
    lines += [f"f {a} {b} {c}" for a, b, c in ball.faces + 1]
    (tmp_path / "scan.obj").write_text("\n".join(lines))
    np.testing.assert_array_equal(read_scan(tmp_path / "scan.obj").colours, colours)


@pytest.mark.parametrize(("words", "value"), [("red green blue", None), ("nan 1e300 -inf", [0, 255, 0])])
def test_colours_that_are_none_do_no_harm(tmp_path, ball, words, value):
    lines = [f"v {x} {y} {z} {words}" for x, y, z in ball.vertices] + [f"f {a} {b} {c}" for a, b, c in ball.faces + 1]
    (tmp_path / "scan.obj").write_text("\n".join(lines))
    colours = read_scan(tmp_path / "scan.obj").colours
    assert (colours is None) if value is None else (colours == value).all()


def glb_with_texture(path, ball, image: bytes):
    """A GLB file by hand, as trimesh cannot write a texture without an imaging library."""
    positions = ball.vertices.astype("<f4").tobytes()
    uv = (ball.vertices[:, :2] / 40 + 0.5).astype("<f4").tobytes()
    faces = ball.faces.astype("<u4").tobytes()
    data = positions + uv + faces + image
    starts = np.cumsum([0, len(positions), len(uv), len(faces)]).tolist()
    lengths = [len(positions), len(uv), len(faces), len(image)]
    low, high = ball.vertices.min(axis=0).tolist(), ball.vertices.max(axis=0).tolist()
    document = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0}], "images": [{"bufferView": 3, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(ball.vertices), "type": "VEC3", "min": low,
             "max": high},
            {"bufferView": 1, "componentType": 5126, "count": len(ball.vertices), "type": "VEC2"},
            {"bufferView": 2, "componentType": 5125, "count": 3 * len(ball.faces), "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteOffset": s, "byteLength": n} for s, n in zip(starts, lengths)],
        "buffers": [{"byteLength": len(data)}],
    }  # fmt: skip
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def test_a_texture_inside_of_a_glb_file(tmp_path, ball):
    image = picture(tmp_path / "i.png").read_bytes()
    glb_with_texture(tmp_path / "scan.glb", ball, image)
    scan = read_scan(tmp_path / "scan.glb")
    np.testing.assert_array_equal(scan.picture, read_picture(tmp_path / "i.png"))
    # glTF counts rows from the top, we from below
    np.testing.assert_allclose(scan.corner_uv[..., 0], ball.vertices[ball.faces][..., 0] / 40 + 0.5, atol=1e-6)
    np.testing.assert_allclose(1 - scan.corner_uv[..., 1], ball.vertices[ball.faces][..., 1] / 40 + 0.5, atol=1e-6)


def test_damaged_scans_are_refused_by_name(tmp_path, ball, survives_damage):
    glb_with_texture(tmp_path / "scan.glb", ball, picture(tmp_path / "i.png").read_bytes())
    assert survives_damage(tmp_path / "scan.glb", read_scan, 40) > 0
    ball.export(tmp_path / "scan.stl")
    survives_damage(tmp_path / "scan.stl", read_scan, 30)
