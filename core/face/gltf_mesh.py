"""Meshes with their morph targets out of glTF 2.0 files (.gltf, .glb).

trimesh, which reads other meshes here, leaves morph targets and their names out.
"""

from __future__ import annotations

import base64
import binascii
import contextlib
import json
import struct
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote

import numpy as np

from core.errors import UserFacingError
from core.face.mesh_readers import MOST_BYTES, MOST_VERTICES, RawMesh, check_mesh

_COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_TRIANGLES = 4
_MOST_ELEMENTS = 16 * MOST_VERTICES  # of an accessor: one of zeros takes no room in the file, and may ask for any count
# compressed meshes need a decoder of their own
_UNREADABLE = ("KHR_draco_mesh_compression", "EXT_meshopt_compression")


def read_gltf_shapes(path: Path) -> tuple[RawMesh, dict[str, np.ndarray]]:
    """Read all triangles of a file's scene, one after the other, and the morph targets of all by name.

    Names come from ``extras.targetNames`` of a mesh, where all exporters write them, else they are ``shape 0`` and so
    on; targets of the same name on several meshes (head, teeth, lashes) are one shape.

    returns : mesh, and shapes float64 (V, 3), both in the file's unit with the scene's transforms applied
    Raises `UserFacingError` for a file that is missing, damaged or compressed.
    """
    path = Path(path)
    with _told(path):
        document, buffers = gltf_document(path)
        compressed = [name for name in _UNREADABLE if name in document.get("extensionsRequired", ())]
        if compressed:
            raise UserFacingError(f"'{path}' is compressed by {compressed[0]}.", "Export it again without compression.")
        mesh, shapes = _Scene(document, buffers).collected()
    check_mesh(mesh, path)
    for name, shape in shapes.items():
        if not np.isfinite(shape).all():
            raise UserFacingError(f"'{path}': the shape '{name[:60]}' holds what is no number.")
    return mesh, shapes


def gltf_document(path: Path) -> tuple[dict, list[bytes]]:
    """Return the JSON of a glTF or GLB file and its buffers; raises `UserFacingError`."""
    with _told(path):
        if path.stat().st_size > MOST_BYTES:
            raise UserFacingError(f"'{path}' is larger than {MOST_BYTES // 2**20} MB.")
        return _opened(path, path.read_bytes())


@contextlib.contextmanager
def _told(path: Path) -> Iterator[None]:
    """Whatever a damaged or hostile file does to the walk through its tables is one sentence."""
    try:
        yield
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror}.") from error
    except (ValueError, KeyError, IndexError, TypeError, AttributeError, RecursionError, OverflowError, MemoryError,
            struct.error, binascii.Error) as error:  # fmt: skip
        raise UserFacingError(f"'{path}' is not a readable glTF file.") from error


def _opened(path: Path, data: bytes) -> tuple[dict, list[bytes]]:
    """The JSON of a file and its buffers."""
    embedded = b""
    if data[:4] == b"glTF":
        length, kind = struct.unpack_from("<I4s", data, 12)
        if kind != b"JSON":
            raise ValueError("the first chunk is no JSON")
        document = json.loads(data[20 : 20 + length])
        if len(data) > 20 + length:
            size, kind = struct.unpack_from("<I4s", data, 20 + length)
            embedded = data[28 + length : 28 + length + size] if kind == b"BIN\0" else b""
    else:
        document = json.loads(data)
    return document, [_buffer(path, buffer, embedded) for buffer in document.get("buffers", [])]


def _buffer(path: Path, buffer: dict, embedded: bytes) -> bytes:
    uri = buffer.get("uri")
    if uri is None:
        return embedded
    if uri.startswith("data:"):
        return base64.b64decode(uri.partition(",")[2], validate=True)
    beside = path.parent / unquote(uri)
    if not beside.resolve().is_relative_to(path.parent.resolve()):
        raise UserFacingError(f"'{path}' asks for '{uri[:60]}', which lies outside its folder.")
    if not beside.is_file():
        raise UserFacingError(f"'{path}' asks for '{uri[:60]}', which is not there.")
    return beside.read_bytes()


class _Scene:
    def __init__(self, document: dict, buffers: list[bytes]) -> None:
        self._document, self._buffers = document, buffers
        self._positions: list[np.ndarray] = []
        self._triangles: list[np.ndarray] = []
        self._uvs: list[np.ndarray] = []
        self._labels: list[str] = []
        self._label_of_triangle: list[np.ndarray] = []
        self._moves: list[tuple[str, int, np.ndarray]] = []
        self._count = 0
        self._walked: set[int] = set()

    def collected(self) -> tuple[RawMesh, dict[str, np.ndarray]]:
        document = self._document
        scenes = document.get("scenes")
        roots = scenes[document.get("scene", 0)]["nodes"] if scenes else range(len(document.get("nodes", [])))
        for node in roots:
            self._walk(node, np.eye(4))
        if not self._positions:
            raise ValueError("no triangles")
        uv = np.concatenate(self._uvs).astype(np.float32)
        mesh = RawMesh(
            np.concatenate(self._positions), np.concatenate(self._triangles), uv if uv.any() else None,
            tuple(self._labels), np.concatenate(self._label_of_triangle),
        )  # fmt: skip
        shapes: dict[str, np.ndarray] = {}
        for name, first, moved in self._moves:
            shapes.setdefault(name, np.zeros((self._count, 3)))[first : first + len(moved)] = moved
        return mesh, shapes

    def _walk(self, number: int, above: np.ndarray) -> None:
        # nodes form trees (glTF 2.0, 3.5.2); one with two parents, level upon level, would be walked for ever
        if number in self._walked:
            raise ValueError("a node has two parents")
        self._walked.add(number)
        node = self._document["nodes"][number]
        world = above @ _local(node)
        if "mesh" in node:
            mesh = self._document["meshes"][node["mesh"]]
            # a skinned mesh stands where its joints put it, not where its node is (glTF 2.0, 3.7.3.3)
            self._take(mesh, node.get("name", ""), np.eye(4) if "skin" in node else world)
        for child in node.get("children", []):
            self._walk(child, world)

    def _take(self, mesh: dict, node_name: str, world: np.ndarray) -> None:
        names = mesh.get("extras", {}).get("targetNames", [])
        taken: dict[str, tuple[int, int]] = {}
        for primitive in mesh["primitives"]:
            if primitive.get("mode", _TRIANGLES) != _TRIANGLES:
                continue
            attributes, targets = primitive["attributes"], primitive.get("targets", [])
            # parts of one skin with a material each often share their vertices
            shared = json.dumps([attributes, targets], sort_keys=True)
            if shared in taken:
                first, count = taken[shared]
                self._take_triangles(primitive, mesh, node_name, first, count)
                continue
            points = self._accessor(attributes["POSITION"]).astype(float)
            taken[shared] = self._count, len(points)
            self._take_triangles(primitive, mesh, node_name, self._count, len(points))
            uv = np.zeros((len(points), 2))
            if "TEXCOORD_0" in attributes:
                uv = self._accessor(attributes["TEXCOORD_0"]).astype(float)
                uv[:, 1] = 1.0 - uv[:, 1]  # glTF counts texture rows from the top
            self._positions.append(points @ world[:3, :3].T + world[:3, 3])
            self._uvs.append(uv)
            own = primitive.get("extras", {}).get("targetNames", names)
            for k, target in enumerate(targets):
                if "POSITION" in target:
                    name = str(own[k]) if k < len(own) else f"shape {k}"
                    moved = self._accessor(target["POSITION"]).astype(float) @ world[:3, :3].T
                    self._moves.append((name, self._count, moved))
            self._count += len(points)

    def _take_triangles(self, primitive: dict, mesh: dict, node_name: str, first: int, count: int) -> None:
        corners = np.arange(count)
        if "indices" in primitive:
            corners = self._accessor(primitive["indices"]).ravel().astype(int)
            if len(corners) and not 0 <= corners.min() <= corners.max() < count:
                raise ValueError("a triangle's corner does not exist")
        material = self._document.get("materials", [])[primitive["material"]] if "material" in primitive else {}
        self._labels.append(" ".join(x for x in (node_name, mesh.get("name"), material.get("name")) if x))
        self._label_of_triangle.append(np.full(len(corners) // 3, len(self._labels) - 1))
        self._triangles.append(corners.reshape(-1, 3) + first)

    def _accessor(self, index: int) -> np.ndarray:
        accessor = self._document["accessors"][index]
        count, width = int(accessor["count"]), _WIDTHS[accessor["type"]]
        kind = np.dtype(_COMPONENTS[accessor["componentType"]])
        if count > _MOST_ELEMENTS:
            raise ValueError("an accessor asks for more than any face has")
        if "bufferView" in accessor:
            values = self._view(accessor["bufferView"], accessor.get("byteOffset", 0), kind, count, width).copy()
        else:
            values = np.zeros((count, width), kind)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            n = int(sparse["count"])
            where, what = sparse["indices"], sparse["values"]
            rows = self._view(where["bufferView"], where.get("byteOffset", 0),
                              np.dtype(_COMPONENTS[where["componentType"]]), n, 1)  # fmt: skip
            values[rows.ravel()] = self._view(what["bufferView"], what.get("byteOffset", 0), kind, n, width)
        if accessor.get("normalized"):
            return np.maximum(values / np.iinfo(kind).max, -1.0)
        return values

    def _view(self, index: int, offset: int, kind: np.dtype, count: int, width: int) -> np.ndarray:
        view = self._document["bufferViews"][index]
        start = view.get("byteOffset", 0) + offset
        stride = view.get("byteStride", kind.itemsize * width)
        size = (count - 1) * stride + kind.itemsize * width if count else 0
        data = self._buffers[view["buffer"]][start : start + size]
        if len(data) < size or count < 0 or offset + size > view["byteLength"]:
            raise ValueError("an accessor reaches beyond its buffer")
        return np.ndarray((count, width), kind, data, strides=(stride, kind.itemsize))


def _local(node: dict) -> np.ndarray:
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    from scipy.spatial.transform import Rotation

    local = np.eye(4)
    turn = Rotation.from_quat(node.get("rotation", [0, 0, 0, 1])).as_matrix()
    local[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]), float)
    local[:3, 3] = node.get("translation", [0, 0, 0])
    return local
