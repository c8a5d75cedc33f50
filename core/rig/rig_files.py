"""Rigs from wherever they lie: our characters, glTF files with morph targets, folders of OBJ files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.face.default_face import character_face
from core.face.face_file import FACE_SUFFIX, read_face
from core.face.gltf_mesh import read_gltf_shapes
from core.face.mesh_files import face_of
from core.face.mesh_readers import RawMesh, read_mesh
from core.progress import SILENT, Progress
from core.rig.rig import Rig
from core.rig.teeth_room import with_room_for_teeth

NEUTRAL_NAMES = ("neutral", "basis", "base", "rest", "default")
GLTF_SUFFIXES = (".gltf", ".glb")


def load_rig(name: str, progress: Progress = SILENT) -> Rig:
    """Return the rig that ``name`` means.

    name : one of `core.face.characters.CHARACTERS` with its 52 ARKit units; a face file, of a face fitted to a scan; a
        glTF or GLB file with morph targets; or a folder of OBJ files of equal topology, one of them the neutral face
        (its name holds ``neutral``, ``basis``, ``base``, ``rest`` or ``default``), each other one a shape named as its
        file

    Files hold x to the character's left, y up, z forward; their unit is guessed as for other faces. Raises
    `UserFacingError` for what is missing, damaged, without shapes, or of unequal topology.
    """
    if name in CHARACTERS:
        return Rig.of(with_room_for_teeth(character_face(name, progress)))
    path = Path(name)
    if path.suffix.lower() == FACE_SUFFIX:
        return Rig.of(with_room_for_teeth(read_face(path)))
    if path.suffix.lower() in GLTF_SUFFIXES:
        mesh, shapes = read_gltf_shapes(path)
    elif path.is_dir():
        mesh, shapes = _read_obj_set(path)
    else:
        raise UserFacingError(
            f"'{name}' is no rig.",
            f"Give one of {', '.join(CHARACTERS)}, a .glb or .gltf file with morph targets, or a folder of OBJ files.",
        )
    return Rig.of(face_of(mesh, path, shapes=shapes))


def _read_obj_set(folder: Path) -> tuple[RawMesh, dict[str, np.ndarray]]:
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() == ".obj")
    neutral = [path for path in files if any(word in path.stem.lower() for word in NEUTRAL_NAMES)]
    if len(neutral) != 1:
        found = "none of" if not neutral else f"{len(neutral)} of"
        raise UserFacingError(
            f"In the folder '{folder}' {found} the {len(files)} OBJ files is named as the neutral face.",
            "Let the name of one, and only one, hold 'neutral'.",
        )
    rest = read_mesh(neutral[0])
    shapes = {}
    for path in files:
        if path == neutral[0]:
            continue
        mesh = read_mesh(path)
        if len(mesh.positions) != len(rest.positions):
            raise UserFacingError(
                f"'{path}' has {len(mesh.positions)} vertices, but '{neutral[0].name}' has {len(rest.positions)}."
            )
        if not np.array_equal(mesh.triangles, rest.triangles):
            raise UserFacingError(f"'{path}' has other triangles than '{neutral[0].name}'.")
        shapes[path.stem] = mesh.positions - rest.positions
    return rest, shapes
