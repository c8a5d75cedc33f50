"""A user's own face from an OBJ, PLY, glTF or GLB file, with her marker file if she has one."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import Face
from core.face.face_file import FACE_SUFFIX, read_face
from core.face.marker_placement import load_marker_file
from core.face.mesh_parts import guess_parts
from core.face.mesh_readers import RawMesh, read_mesh

# mm in a unit that modellers use: mm, cm, inch, decimetre, metre
UNITS_MM = (1.0, 10.0, 25.4, 100.0, 1000.0)
OUTER_EYES_MM = 90.0
HEAD_MM = 300.0


def load_face(path: Path, marker_file: Path | None = None) -> Face:
    """Read a face from a mesh file; x must point to the character's left, y up and z forward.

    A ``.npz`` file is a face that was fitted to a scan and saved; it knows its markers.

    marker_file : a CSV as `load_marker_file` reads it; its ``landmark`` column tells the face's landmarks
    returns : positions in mm, whatever unit the file is in (see `guess_unit_mm`), vertices numbered as in the file

    Raises `UserFacingError` for files that are missing, damaged, no mesh or too large, and for markers on vertices
    that the mesh has not.
    """
    path = Path(path)
    if path.suffix.lower() == FACE_SUFFIX:
        return read_face(path)
    return face_of(read_mesh(path), path, marker_file)


def face_of(
    mesh: RawMesh, path: Path, marker_file: Path | None = None, shapes: Mapping[str, np.ndarray] | None = None
) -> Face:
    """Make a face of a mesh that was read from ``path``; see `load_face`.

    shapes : displacements by name, shape (V, 3), in the unit of the file; they become the face's units
    """
    landmarks: dict[str, int] = {}
    if marker_file is not None:
        placement = load_marker_file(marker_file)
        at = dict(zip(placement.names, placement.vertices.tolist()))
        beyond = next((name for name, vertex in at.items() if vertex >= len(mesh.positions)), None)
        if beyond is not None:
            raise UserFacingError(
                f"{marker_file} puts marker {beyond[:40]} on vertex {at[beyond]}, "
                f"but {path.name} has only {len(mesh.positions)} vertices."
            )
        landmarks = {landmark: at[name] for landmark, name in placement.landmarks.items()}
    unit_mm = guess_unit_mm(mesh, landmarks)
    return Face(
        name=path.name,
        positions=(mesh.positions * unit_mm).astype(np.float32),
        triangles=mesh.triangles.astype(np.int32),
        part=guess_parts(mesh, landmarks),
        uv=mesh.uv,
        landmarks=landmarks,
        units={name: (shape * unit_mm).astype(np.float32) for name, shape in (shapes or {}).items()},
        credit=str(path),
    )


def guess_unit_mm(mesh: RawMesh, landmarks: Mapping[str, int]) -> float:
    """Return the mm in one unit of the file.

    Of mm, cm, inch, decimetre and metre it is the one that brings the outer eye corners nearest to 90 mm apart (by
    ratio), or, where these are not known, the largest extent of the mesh nearest to a head's 300 mm.
    """
    corners = [landmarks.get(name) for name in ("outer_eye_left", "outer_eye_right")]
    if None not in corners:
        size, wanted = float(np.linalg.norm(np.subtract(*mesh.positions[corners]))), OUTER_EYES_MM
    else:
        size, wanted = float(np.ptp(mesh.positions, axis=0).max()), HEAD_MM
    if size <= 0:
        return 1.0
    return min(UNITS_MM, key=lambda unit: abs(np.log(size * unit / wanted)))
