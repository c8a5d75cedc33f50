"""A scan of a head, as the fit takes it: one surface with its colours, from OBJ, PLY, STL, glTF or GLB."""

from __future__ import annotations

import io
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import PARTS
from core.face.geodesic import components
from core.face.gltf_mesh import gltf_document, read_gltf_shapes
from core.face.mesh_parts import guess_parts
from core.face.mesh_readers import MOST_BYTES, RawMesh, check_mesh, read_mesh
from core.media.picture import read_picture

SUFFIXES = (".obj", ".ply", ".stl", ".gltf", ".glb")
PICTURES = (".png", ".jpg", ".jpeg")
FEWEST_TRIANGLES = 50
_LIBRARY_PATH = 512


@dataclass(frozen=True)
class Scan:
    """A triangle surface in the unit and orientation of its file.

    positions : float64, shape (V, 3); vertices as in the file, so that points may name them
    triangles : int, shape (T, 3), without those that have no area and without eyes, teeth and the like
    corner_uv : float32, shape (T, 3, 2), v up, or None; picture : uint8, shape (h, w, 3), top row first, or None
    colours : uint8, shape (V, 3), of vertices, or None
    notes : sentences about what was left out
    """

    name: str
    positions: np.ndarray
    triangles: np.ndarray
    corner_uv: np.ndarray | None = None
    picture: np.ndarray | None = None
    colours: np.ndarray | None = None
    notes: tuple[str, ...] = ()

    @property
    def has_colour(self) -> bool:
        """Whether there is something to paint the fitted face with."""
        return self.colours is not None or (self.picture is not None and self.corner_uv is not None)

    @property
    def size(self) -> float:
        """The largest extent of the surface, in the unit of the file."""
        return float(np.ptp(self.positions[np.unique(self.triangles)], axis=0).max())

    def placed(self, scale: float, rotation: np.ndarray, shift: np.ndarray) -> Scan:
        """Return the scan at ``scale`` · rotation · position + shift."""
        return replace(self, positions=scale * self.positions @ rotation.T + shift)


def read_scan(path: Path, texture: Path | None = None) -> Scan:
    """Read a scan; raises `UserFacingError` for what is missing, damaged, empty, too large or no mesh.

    texture : a picture for the scan's texture coordinates; None: the one that the file names or holds, else one that
        lies beside it under its name

    Of files that name their pieces only the skin is taken, of others all.
    """
    path = Path(path)
    mesh = _read_stl(path) if path.suffix.lower() == ".stl" else _read_other(path)
    part = guess_parts(mesh, {})
    skin = (part[mesh.triangles] == PARTS.index("skin")).all(axis=1)
    named = any(mesh.labels) and np.unique(part).size > 1
    keep = skin if named and skin.sum() > FEWEST_TRIANGLES else np.ones(len(mesh.triangles), bool)
    keep &= _areas(mesh) > 0
    if keep.sum() < FEWEST_TRIANGLES:
        raise UserFacingError(f"{path} has only {int(keep.sum())} triangles, which are no scan of a head.")
    corner_uv = mesh.corner_uv
    if corner_uv is None and mesh.uv is not None:
        corner_uv = mesh.uv[mesh.triangles]
    picture = _picture(path, texture) if corner_uv is not None else None
    if texture is not None and corner_uv is None:
        raise UserFacingError(f"{path} has no texture coordinates, so the picture '{texture}' cannot be laid on it.")
    notes = () if keep.all() else (f"{int((~keep).sum())} triangles of {path.name} that are no skin were left out.",)
    return Scan(
        path.name, mesh.positions, mesh.triangles[keep], None if corner_uv is None else corner_uv[keep], picture,
        None if picture is not None else _vertex_colours(path, len(mesh.positions)), notes,
    )  # fmt: skip


def largest_piece_share(scan: Scan) -> float:
    """Return the share of the triangles that lie in the largest connected piece, 0..1."""
    piece = components(len(scan.positions), scan.triangles)[scan.triangles[:, 0]]
    return float(np.bincount(piece).max() / len(scan.triangles))


def _areas(mesh: RawMesh) -> np.ndarray:
    a, b, c = mesh.positions[mesh.triangles].transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1)


def _read_other(path: Path) -> RawMesh:
    if path.suffix.lower() not in SUFFIXES:
        raise UserFacingError(f"{path} is no scan that can be read.", f"Known are {', '.join(SUFFIXES)}.")
    if path.suffix.lower() in (".gltf", ".glb"):
        # trimesh drops texture coordinates where there is no imaging library beside it
        return read_gltf_shapes(path)[0]
    return read_mesh(path)


def _read_stl(path: Path) -> RawMesh:
    import trimesh

    try:
        if not path.is_file():
            raise UserFacingError(f"There is no scan '{path}'.")
        if path.stat().st_size > MOST_BYTES:
            raise UserFacingError(f"{path} is larger than {MOST_BYTES // 2**20} MB.")
        # every triangle of an STL file has corners of its own, which the reader has to join
        mesh = trimesh.load_mesh(path, process=True)
        positions, triangles = np.asarray(mesh.vertices, float), np.asarray(mesh.faces, int).reshape(-1, 3)
    except OSError as error:
        raise UserFacingError(f"{path} cannot be read: {error.strerror}.") from error
    except UserFacingError:
        raise
    except Exception as error:  # foreign parsers raise anything at all on damaged or hostile files
        raise UserFacingError(f"{path} is not a readable STL mesh.") from error
    raw = RawMesh(positions.reshape(-1, 3), triangles, None, ("",), np.zeros(len(triangles), int))
    check_mesh(raw, path)
    return raw


def _picture(path: Path, texture: Path | None) -> np.ndarray | None:
    if texture is not None:
        return read_picture(Path(texture))
    suffix = path.suffix.lower()
    if suffix == ".obj":
        named = _named_by_obj(path)
    elif suffix in (".gltf", ".glb"):
        named = _held_by_gltf(path)
    else:
        named = None
    if isinstance(named, bytes):
        return read_picture(io.BytesIO(named), f"{path.name}'s texture")
    beside = [path.with_suffix(ending) for ending in PICTURES]
    found = next((p for p in ([named] if named is not None else []) + beside if p.is_file()), None)
    return None if found is None else read_picture(found)


def _named_by_obj(path: Path) -> Path | None:
    """Return the picture that an OBJ file's material library names, if it lies in the same folder or below."""
    with path.open(encoding="utf-8", errors="replace") as file:
        libraries = [
            line.split(maxsplit=1)[1].strip() for line in file if line.startswith("mtllib ") and line[7:].strip()
        ]
    for library in libraries:
        text = _inside(path, library)
        if text is None or text.stat().st_size > MOST_BYTES:
            continue
        for line in text.read_text(encoding="utf-8", errors="replace").splitlines():
            words = line.split()
            if len(words) > 1 and words[0].lower() == "map_kd":
                return _inside(path, words[-1])
    return None


def _inside(path: Path, name: str) -> Path | None:
    if "\0" in name or len(name) > _LIBRARY_PATH:
        return None
    beside = path.parent / name.replace("\\", "/")
    return beside if beside.resolve().is_relative_to(path.parent.resolve()) and beside.is_file() else None


def _held_by_gltf(path: Path) -> bytes | Path | None:
    """Return the base colour picture of the first material that has one."""
    document, buffers = gltf_document(path)
    try:
        textures = [
            material["pbrMetallicRoughness"]["baseColorTexture"]["index"]
            for material in document.get("materials", [])
            if "baseColorTexture" in material.get("pbrMetallicRoughness", {})
        ]
        if not textures:
            return None
        image = document["images"][document["textures"][textures[0]]["source"]]
        if "uri" in image:
            return None if image["uri"].startswith("data:") else _inside(path, image["uri"])
        view = document["bufferViews"][image["bufferView"]]
        start = int(view.get("byteOffset", 0))
        return buffers[view["buffer"]][start : start + int(view["byteLength"])]
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
        raise UserFacingError(f"'{path}' names a texture that it does not hold.") from error


def _vertex_colours(path: Path, count: int) -> np.ndarray | None:
    suffix = path.suffix.lower()
    if suffix == ".obj":
        with path.open(encoding="utf-8", errors="replace") as file:
            rows = [line.split()[4:7] for line in file if line.startswith("v ")]
        if len(rows) != count or any(len(row) != 3 for row in rows):
            return None
        try:
            colours = np.nan_to_num(np.array(rows, float))
        except ValueError:
            return None
        return (np.clip(colours, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8)
    if suffix != ".ply":
        return None
    import trimesh

    visual = trimesh.load_mesh(path, process=False).visual
    if visual.kind != "vertex" or len(visual.vertex_colors) != count:
        return None
    return np.ascontiguousarray(np.asarray(visual.vertex_colors, np.uint8)[:, :3])
