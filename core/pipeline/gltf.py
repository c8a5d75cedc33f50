"""A rig and its curves as one glTF 2.0 binary file (.glb): morph targets and the animation of their weights.

The container is a header, a JSON table and one block of numbers, and is written here: pygltflib (MIT) would hold the
same table in dataclasses, and leave the packing, the bounds and the alignment, which are most of this file, to us.
Every file is checked against the Khronos validator in the tests.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np

from core.face.face import PARTS
from core.media.swap_in import swapped_in
from core.pipeline.vertex_colours import vertex_colours
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig

M_PER_MM = 0.001
_FLOAT, _UINT = 5126, 5125
_VERTICES, _CORNERS = 34962, 34963
_ROUGHNESS = {"eye_left": 0.25, "eye_right": 0.25, "upper_teeth": 0.35, "lower_teeth": 0.35, "tongue": 0.45}


def write_glb(rig: Rig, track: ControlTrack, path: str | Path) -> None:
    """Write ``rig`` with ``track`` (its own controls in its order, see `core.rig.rig.fitted`) to ``path``.

    Metres, y up, the face looking along z, as glTF wants it. All shapes are morph targets, named in the mesh's
    ``extras.targetNames``, as Blender, three.js and Unreal read them; the weights are keyed at every frame, linear
    between. Parts of the face are primitives with a material each over shared vertices, coloured by vertex. Raises
    `UserFacingError` when the file cannot be written.
    """
    if track.names != rig.names:
        raise ValueError("the track is not in the rig's own controls")
    packed = _Packed()
    face = rig.face
    attributes = {
        "POSITION": packed.array(face.positions * np.float32(M_PER_MM), "VEC3", _VERTICES, bounds=True),
        "NORMAL": packed.array(vertex_normals(face.positions, face.triangles), "VEC3", _VERTICES),
        "COLOR_0": packed.array(vertex_colours(face), "VEC3", _VERTICES),
    }
    if face.uv is not None:
        attributes["TEXCOORD_0"] = packed.array(face.uv * np.float32([1, -1]) + np.float32([0, 1]), "VEC2", _VERTICES)
    targets = [
        {"POSITION": packed.array(delta * np.float32(M_PER_MM), "VEC3", _VERTICES, bounds=True)} for delta in rig.deltas
    ]
    part = face.part[face.triangles[:, 0]]
    primitives, materials = [], []
    for index in np.unique(part):
        corners = packed.array(face.triangles[part == index].reshape(-1, 1), "SCALAR", _CORNERS)
        primitives.append({"attributes": attributes, "indices": corners, "material": len(materials),
                           "targets": targets})  # fmt: skip
        name = PARTS[index]
        rough = _ROUGHNESS.get(name, 0.6)
        look = {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0.0, "roughnessFactor": rough}
        # hair cards and sheets are seen from both sides
        materials.append({"name": name, "pbrMetallicRoughness": look, "doubleSided": name.startswith("lashes")})
    times = packed.array(track.times_s[:, None], "SCALAR", None, bounds=True)
    weights = packed.array(track.values.reshape(-1, 1), "SCALAR", None)
    sampler = {"input": times, "output": weights, "interpolation": "LINEAR"}
    channel = {"sampler": 0, "target": {"node": 0, "path": "weights"}}
    name = Path(face.name).stem
    document = {
        "asset": {"version": "2.0", "generator": "eFASE workstation", "copyright": face.credit},
        "scene": 0,
        "scenes": [{"name": name, "nodes": [0]}],
        "nodes": [{"name": name, "mesh": 0}],
        "meshes": [{"name": name, "primitives": primitives, "weights": [0.0] * len(rig.names),
                    "extras": {"targetNames": list(rig.names)}}],
        "materials": materials,
        "animations": [{"name": "speech", "samplers": [sampler], "channels": [channel],
                        "extras": {"rate_hz": track.rate_hz, "start": track.start_timecode}}],
        **packed.tables(),
    }  # fmt: skip
    if not face.credit:
        del document["asset"]["copyright"]
    with swapped_in(path) as beside:
        beside.write_bytes(_container(document, bytes(packed.data)))


def vertex_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return unit normals, float32, shape (V, 3): the mean of the triangles around, by area; +z where there is none."""
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    across = np.cross(b - a, c - a)
    normals = np.zeros((len(positions), 3))
    for k in range(3):
        np.add.at(normals, triangles[:, k], across)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(length > 0, normals / np.where(length > 0, length, 1.0), [0.0, 0.0, 1.0])
    return normals.astype(np.float32)


class _Packed:
    """The block of numbers, and the tables that say what lies where."""

    def __init__(self) -> None:
        self.data = bytearray()
        self._views: list[dict] = []
        self._accessors: list[dict] = []

    def array(self, values: np.ndarray, kind: str, target: int | None, bounds: bool = False) -> int:
        """Append rows of float32, or of indices (uint32); return the number of the accessor."""
        values = np.ascontiguousarray(values, "<u4" if target == _CORNERS else "<f4")
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes}
        if target is not None:
            view["target"] = target
        accessor = {"bufferView": len(self._views), "componentType": _UINT if target == _CORNERS else _FLOAT,
                    "count": len(values), "type": kind}  # fmt: skip
        if bounds:
            accessor["min"] = [float(x) for x in values.min(axis=0)]
            accessor["max"] = [float(x) for x in values.max(axis=0)]
        self._views.append(view)
        self._accessors.append(accessor)
        self.data += values.tobytes()
        return len(self._accessors) - 1

    def tables(self) -> dict[str, list[dict]]:
        """Return what the document says of the block."""
        return {"buffers": [{"byteLength": len(self.data)}], "bufferViews": self._views, "accessors": self._accessors}


def _container(document: dict, data: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
