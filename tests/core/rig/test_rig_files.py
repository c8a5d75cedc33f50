import base64
import json
import struct

import numpy as np
import pytest

from core.errors import UserFacingError
from core.face.gltf_mesh import read_gltf_shapes
from core.pipeline.gltf import write_glb
from core.rig.control_track import ControlTrack
from core.rig.rig import posed
from core.rig.rig_files import load_rig
from tests.core.rig.small_rigs import random_track, small_rig


def write_obj(path, positions, triangles):
    lines = [f"v {x} {y} {z}" for x, y, z in positions.tolist()] + [
        "f " + " ".join(str(i + 1) for i in t) for t in triangles.tolist()
    ]
    path.write_text("\n".join(lines) + "\n")


@pytest.fixture
def obj_folder(tmp_path):
    rig = small_rig()
    write_obj(tmp_path / "sheet_neutral.obj", rig.neutral / 10, rig.face.triangles)
    for name in rig.names:
        write_obj(tmp_path / f"{name}.obj", (rig.neutral + rig.shape(name)) / 10, rig.face.triangles)
    return tmp_path


def test_a_folder_of_obj_files_is_a_rig_in_millimetres(obj_folder):
    rig, read = small_rig(), load_rig(str(obj_folder))
    assert read.names == tuple(sorted(rig.names))
    np.testing.assert_allclose(read.neutral, rig.neutral, atol=1e-3)  # the folder holds centimetres
    for name in rig.names:
        np.testing.assert_allclose(read.shape(name), rig.shape(name), atol=1e-3)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda f: (f / "sheet_neutral.obj").unlink(), "none of the 3"),
        (lambda f: (f / "jawOpen.obj").rename(f / "base.obj"), "2 of the 4"),
        (lambda f: write_obj(f / "jawOpen.obj", small_rig().neutral[:3], np.array([[0, 1, 2]])), "3 vertices"),
        (lambda f: write_obj(f / "jawOpen.obj", small_rig().neutral, small_rig().face.triangles[::-1]), "triangles"),
        (lambda f: (f / "jawOpen.obj").write_text("v 1 2\n"), "line 1"),
    ],
)
def test_a_bad_folder_is_refused_in_a_sentence(obj_folder, spoil, said):
    spoil(obj_folder)
    with pytest.raises(UserFacingError, match=said):
        load_rig(str(obj_folder))


def test_what_is_no_rig_is_refused(tmp_path):
    for name in ("nobody", str(tmp_path / "missing.glb"), str(tmp_path / "face.ply")):
        with pytest.raises(UserFacingError):
            load_rig(name)


def gltf(tmp_path, shapes_sparse=False):
    """One triangle with two shapes, of 16-bit corners, turned and grown by its node; buffers as data URIs."""
    points = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.2, 0]], "<f4")
    first = np.array([[0, 0, 0], [0.01, 0, 0], [0, 0, 0]], "<f4")
    data = points.tobytes() + first.tobytes() + np.array([0, 1, 2, 0], "<u2").tobytes()
    data += np.array([1, 0], "<u2").tobytes() + first[1:2].tobytes()
    views = [
        {"buffer": 0, "byteOffset": a, "byteLength": n} for a, n in ((0, 36), (36, 36), (72, 6), (80, 2), (84, 12))
    ]
    vec = {"componentType": 5126, "count": 3, "type": "VEC3"}
    sparse = {"count": 1, "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 4}}
    accessors = [
        {**vec, "bufferView": 0},
        {**vec, "sparse": sparse} if shapes_sparse else {**vec, "bufferView": 1},
        {"bufferView": 2, "componentType": 5123, "count": 3, "type": "SCALAR"},
    ]
    primitive = {"attributes": {"POSITION": 0}, "indices": 2, "targets": [{"POSITION": 1}, {"POSITION": 0}]}
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1], "scale": [2, 2, 2]}, {"mesh": 0, "translation": [1, 0, 0],
                                                         "rotation": [0, 0, 0.5**0.5, 0.5**0.5]}],
        "meshes": [{"primitives": [primitive], "extras": {"targetNames": ["jawOpen"]}}],
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64,"
                     + base64.b64encode(data).decode()}],
        "bufferViews": views, "accessors": accessors,
    }  # fmt: skip
    path = tmp_path / "triangle.gltf"
    path.write_text(json.dumps(document))
    return path, document


@pytest.mark.parametrize("shapes_sparse", [False, True])
def test_shapes_are_turned_and_scaled_with_their_node_but_not_shifted(tmp_path, shapes_sparse):
    path, _ = gltf(tmp_path, shapes_sparse)
    mesh, shapes = read_gltf_shapes(path)
    np.testing.assert_allclose(mesh.positions, [[2, 0, 0], [2, 0.2, 0], [1.6, 0, 0]], atol=1e-6)
    assert list(shapes) == ["jawOpen", "shape 1"]  # a target without a name is counted
    np.testing.assert_allclose(shapes["jawOpen"], [[0, 0, 0], [0, 0.02, 0], [0, 0, 0]], atol=1e-6)


def test_vertices_and_shapes_are_those_that_trimesh_reads(tmp_path):
    import trimesh

    path, _ = gltf(tmp_path)
    theirs = trimesh.load_scene(path, process=False).to_geometry()
    np.testing.assert_allclose(read_gltf_shapes(path)[0].positions, theirs.vertices, atol=1e-6)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda d: d["accessors"][0].update(count=4),
        lambda d: d["accessors"][0].update(count=-1),
        lambda d: (d["accessors"][0].update(count=10**10), d["accessors"][0].pop("bufferView")),
        lambda d: (d["accessors"][0].update(count=10**10), d["bufferViews"][0].update(byteStride=0)),
        lambda d: d["bufferViews"][0].update(byteOffset=90),
        lambda d: d["nodes"][1].update(children=[0]),
        # 2 ** 40 ways lead down
        lambda d: d.update(nodes=[*({"children": [n + 1, n + 1]} for n in range(40)), {"mesh": 0}]),
        lambda d: d["scenes"][0].update(nodes=[7]),
        lambda d: d["meshes"][0].update(primitives=[]),
        lambda d: d["buffers"][0].update(uri="../../etc/passwd"),
        lambda d: d["buffers"][0].update(uri="missing.bin"),
        lambda d: d.update(extensionsRequired=["KHR_draco_mesh_compression"]),
        lambda d: d.update(nodes=5),
    ],
)
def test_a_damaged_gltf_is_refused_in_a_sentence(tmp_path, spoil):
    path, document = gltf(tmp_path)
    spoil(document)
    path.write_text(json.dumps(document))
    with pytest.raises(UserFacingError):
        load_rig(str(path))


def test_a_glb_cut_anywhere_is_refused(tmp_path):
    rig = small_rig()
    write_glb(rig, random_track(rig.names), tmp_path / "whole.glb")
    whole = (tmp_path / "whole.glb").read_bytes()
    json_end = 20 + struct.unpack_from("<I", whole, 12)[0]
    for length in (0, 3, 12, 19, 40, json_end - 5, json_end, json_end + 30, json_end + 400):
        (tmp_path / "cut.glb").write_bytes(whole[:length])
        with pytest.raises(UserFacingError):
            load_rig(str(tmp_path / "cut.glb"))


def test_ict_facekit_is_a_rig_and_opens_its_jaw(shared_data):
    """Its own jawOpen moves the chin down, not the forehead; in millimetres though the file is in centimetres."""
    from core.face.mesh_files import face_of
    from core.face.mesh_readers import read_mesh
    from core.rig.rig import Rig

    folder = shared_data("ict-facekit")
    with np.load(folder / "expression_deltas.npz", allow_pickle=False) as data:
        shapes = dict(zip(data["names"].tolist(), data["delta"]))
    mesh = folder / "generic_neutral_mesh.obj"
    rig = Rig.of(face_of(read_mesh(mesh), mesh, shapes=shapes))
    assert len(rig.names) == 57 and 150 < np.ptp(rig.neutral[:9409, 1]) < 400
    moved = posed(rig, ControlTrack(("jawOpen",), np.array([[0.0], [1.0]]), 30.0))[1] - rig.neutral
    chin = rig.neutral[:9409, 1] < np.quantile(rig.neutral[:9409, 1], 0.2)
    brow = rig.neutral[:9409, 1] > np.quantile(rig.neutral[:9409, 1], 0.9)
    assert moved[:9409][chin, 1].min() < -10 and np.abs(moved[:9409][brow]).max() < 1


def test_damaged_copies_are_read_or_refused(tmp_path, survives_damage):
    rig = small_rig()
    write_glb(rig, random_track(rig.names), tmp_path / "whole.glb")
    assert survives_damage(tmp_path / "whole.glb", lambda path: load_rig(str(path)), 200) > 20
