"""Raw meshes from OBJ, PLY and glTF files, with vertices numbered as in the file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError

MOST_BYTES = 512 * 2**20
MOST_VERTICES = 2_000_000
SUFFIXES = (".obj", ".ply", ".gltf", ".glb")


@dataclass(frozen=True)
class RawMesh:
    """What a file says, in its own units.

    positions : float64, shape (V, 3); triangles : int, shape (T, 3); uv : float32, shape (V, 2), or None
    labels : object, group and material names; label_of_triangle : int, shape (T,), index into them
    corner_uv : float32, shape (T, 3, 2), where a file gives the corners of its triangles texture coordinates of their
        own, or None; ``uv`` is then the first of each vertex
    """

    positions: np.ndarray
    triangles: np.ndarray
    uv: np.ndarray | None
    labels: tuple[str, ...]
    label_of_triangle: np.ndarray
    corner_uv: np.ndarray | None = None


def read_mesh(path: Path) -> RawMesh:
    """Read an OBJ, PLY, glTF or GLB file; `UserFacingError` for anything that is not a sound mesh.

    Vertices keep the order of the file; where a glTF file holds several meshes they follow one another.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise UserFacingError(f"{path} is no face mesh that can be read.", f"Known are {', '.join(SUFFIXES)}.")
    try:
        size = path.stat().st_size
        if not path.is_file():
            raise UserFacingError(f"{path} is not a file.")
        if size > MOST_BYTES:
            raise UserFacingError(f"{path} is {size // 2**20} MB; a face mesh may have {MOST_BYTES // 2**20} MB.")
        text = path.read_text(encoding="utf-8", errors="replace") if suffix == ".obj" else ""
    except OSError as error:
        raise UserFacingError(f"{path} cannot be read: {error.strerror}.") from error
    mesh = _read_obj(path, text) if suffix == ".obj" else _read_by_trimesh(path)
    check_mesh(mesh, path)
    return mesh


def _read_obj(path: Path, text: str) -> RawMesh:
    # trimesh splits vertices by texture coordinate, and marker files count them as the file does
    positions: list[list[float]] = []
    uvs: list[list[float]] = []
    uv_of_vertex: dict[int, int] = {}
    triangles: list[tuple[int, int, int]] = []
    triangle_uvs: list[tuple[int, int, int]] = []
    labels: dict[str, int] = {}
    label_of_triangle: list[int] = []
    named = {"o": "", "g": "", "usemtl": ""}
    for number, line in enumerate(text.replace("\\\n", " ").splitlines(), 1):
        word, *rest = line.split() or [""]
        try:
            if word == "v":
                x, y, z = rest[:3]
                positions.append([float(x), float(y), float(z)])
            elif word == "vt":
                uvs.append([float(rest[0]), float(rest[1])])
            elif word == "f":
                corners, corner_uvs = [], []
                for corner in rest:
                    vertex, _, others = corner.partition("/")
                    corners.append(_counted(int(vertex), len(positions)))
                    uv = others.partition("/")[0]
                    corner_uvs.append(_counted(int(uv), len(uvs)) if uv else -1)
                    if uv:
                        uv_of_vertex.setdefault(corners[-1], corner_uvs[-1])
                label = labels.setdefault(" ".join(name for name in named.values() if name), len(labels))
                for i in range(1, len(corners) - 1):
                    triangles.append((corners[0], corners[i], corners[i + 1]))
                    triangle_uvs.append((corner_uvs[0], corner_uvs[i], corner_uvs[i + 1]))
                    label_of_triangle.append(label)
            elif word in named:
                named[word] = " ".join(rest)
        except (ValueError, IndexError) as error:
            raise UserFacingError(
                f"{path}, line {number}: not a line of an OBJ mesh: {line.strip()[:60]!r}."
            ) from error
    uv = corner_uv = None
    if uv_of_vertex:
        table = np.array([*uvs, (0.0, 0.0)], np.float32)  # the last one for corners without
        uv = np.zeros((len(positions), 2), np.float32)
        uv[list(uv_of_vertex)] = table[list(uv_of_vertex.values())]
        corner_uv = table[np.array(triangle_uvs, int).reshape(-1, 3)]
    return RawMesh(
        np.array(positions, float).reshape(-1, 3),
        np.array(triangles, int).reshape(-1, 3),
        uv,
        tuple(labels) or ("",),
        np.array(label_of_triangle, int),
        corner_uv,
    )


def _counted(index: int, count: int) -> int:
    # OBJ counts from 1, and from the end with negative numbers
    place = index - 1 if index > 0 else count + index
    if index == 0 or not 0 <= place < count:
        raise IndexError(index)
    return place


def _read_by_trimesh(path: Path) -> RawMesh:
    import trimesh

    try:
        # no processing: it would merge and reorder the vertices that marker files count
        scene = trimesh.load_scene(path, process=False, skip_materials=True)
        parts = []
        for node in scene.graph.nodes_geometry:
            transform, geometry = scene.graph[node]
            mesh = scene.geometry[geometry]
            if isinstance(mesh, trimesh.Trimesh):
                parts.append((f"{node} {geometry}", transform, mesh))
        positions, triangles, uvs, label_of_triangle, start = [], [], [], [], 0
        for label, (_, transform, mesh) in enumerate(parts):
            positions.append(np.asarray(mesh.vertices, float) @ transform[:3, :3].T + transform[:3, 3])
            triangles.append(np.asarray(mesh.faces, int).reshape(-1, 3) + start)
            uv = getattr(mesh.visual, "uv", None)
            uvs.append(np.zeros((len(mesh.vertices), 2)) if uv is None else np.asarray(uv)[:, :2])
            label_of_triangle.append(np.full(len(mesh.faces), label))
            start += len(mesh.vertices)
    except Exception as error:
        # foreign parsers raise anything at all on damaged or hostile files
        raise UserFacingError(f"{path} is not a readable {path.suffix[1:].upper()} mesh.") from error
    if not parts:
        raise UserFacingError(f"{path} holds no triangles.")
    uv = np.concatenate(uvs).astype(np.float32)
    return RawMesh(
        np.concatenate(positions),
        np.concatenate(triangles),
        uv if uv.any() else None,
        tuple(label for label, _, _ in parts),
        np.concatenate(label_of_triangle),
    )


def check_mesh(mesh: RawMesh, path: Path) -> None:
    """Raise `UserFacingError` unless ``mesh``, read from ``path``, is sound: finite points, triangles that exist."""
    count = len(mesh.positions)
    if count == 0 or len(mesh.triangles) == 0:
        raise UserFacingError(f"{path} holds no triangles.")
    if count > MOST_VERTICES:
        raise UserFacingError(f"{path} has {count} vertices; a face mesh may have {MOST_VERTICES}.")
    if not np.isfinite(mesh.positions).all() or np.abs(mesh.positions).max() > 1e9:
        bad = int(np.argmax(~(np.abs(mesh.positions) <= 1e9).all(axis=1)))
        raise UserFacingError(f"{path}: vertex {bad} has a position that is no number.")
    if mesh.triangles.min() < 0 or mesh.triangles.max() >= count:
        raise UserFacingError(f"{path} has triangles whose corners do not exist.")
    if np.ptp(mesh.positions, axis=0).max() <= 0:
        raise UserFacingError(f"{path}: all vertices lie in one point.")
