"""What the window of own faces does in the background. Functions for `app.jobs`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from app.face_light import face_light
from app.own_face import save_own_face
from app.panels.poses.posing import PosedFace
from app.texts import own_face as texts
from core.face.default_face import character_face
from core.face.face import Face
from core.face.own_face import OwnFace, fit_own_face, painted, painted_by_photo
from core.face.own_face_display import Clickable, ShownScan
from core.face.own_face_points import PointFile, generic_points, load_points
from core.face.own_face_scan import Scan, read_scan
from core.face.own_face_surface import vertex_normals
from core.face.own_face_texture import distance_texture
from core.media.picture import read_picture
from core.progress import Progress
from core.rig.rig import Rig
from core.rig.teeth_room import with_room_for_teeth
from gpu.gl.complexion import grain
from gpu.gl.face_arrays import FaceArrays

FULL_MM = 2.0
FAR_OFF = 0.02


@dataclass(frozen=True)
class StillFace:
    """A face for a view, and what a click on it meets.

    arrays : what a renderer uploads of the face; normals : shape (V, 3), of ``tree``'s places
    """

    face: Face
    arrays: FaceArrays
    clickable: Clickable
    tree: cKDTree
    normals: np.ndarray

    @classmethod
    def of(cls, face: Face) -> StillFace:
        """Work out all that a view would have to on the main thread."""
        made = cls(
            face, FaceArrays.of(face), Clickable(face.positions, face.triangles), cKDTree(face.positions),
            vertex_normals(face.positions.astype(float), face.triangles),
        )  # fmt: skip
        grain()
        face_light().prepare(face, made.arrays)
        return made

    def pose(self, displacements: np.ndarray) -> np.ndarray:
        """Return the vertices, at rest whatever ``displacements`` say."""
        return self.face.positions

    def normals_at(self, places: np.ndarray) -> np.ndarray:
        """Return the normals nearest to ``places`` (n, 3), unit, shape (n, 3)."""
        return self.normals[self.tree.query(places)[1]]


@dataclass(frozen=True)
class OpenedScan:
    """A scan, and how it is shown."""

    path: Path
    scan: Scan
    shown: ShownScan
    still: StillFace


@dataclass(frozen=True)
class ScanRequest:
    """A scan to open, or one that is open to be turned: rows of ``turn`` are the shown axes."""

    path: Path
    scan: Scan | None = None
    turn: np.ndarray | None = None


@dataclass(frozen=True)
class FitRequest:
    """What a fit needs; see `core.face.own_face.fit_own_face`."""

    generic: Face
    scan: Scan
    points: Mapping[str, np.ndarray]
    moved: Mapping[str, np.ndarray]
    name: str
    photo: np.ndarray | None
    pixels: Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Fitted:
    """A fitted face: as it is saved, and the two ways in which it is shown."""

    own: OwnFace
    face: Face
    shown: PosedFace
    distance: PosedFace
    notes: tuple[str, ...]


def open_scan(request: ScanRequest, progress: Progress) -> OpenedScan:
    """Read a scan, or turn one, and work out how it is shown."""
    progress.step(0.0, texts.READING_SCAN)
    scan = read_scan(request.path) if request.scan is None else request.scan
    progress.step(0.5, texts.READING_SCAN)
    shown = ShownScan.of(scan, request.turn)
    progress.step(0.7, texts.READING_SCAN)
    return OpenedScan(request.path, scan, shown, StillFace.of(shown.face))


def open_generic(name: str, progress: Progress) -> StillFace:
    """Load one of our characters to be fitted."""
    return StillFace.of(character_face(name, progress.part(0.0, 0.5)))


def open_photo(path: Path, progress: Progress) -> tuple[Path, np.ndarray]:
    """Read a photo."""
    progress.step(0.0, texts.READING_PHOTO)
    return path, read_picture(path)


def read_points(request: tuple[Path, Scan | None], _progress: Progress) -> tuple[PointFile, str]:
    """Read points; those on a scan that is open become places, and those far off it are left out and named."""
    path, scan = request
    file = load_points(path)
    if scan is None:
        return file, ""
    points = file.on(scan.positions, scan.name)
    used = scan.positions[np.unique(scan.triangles)]
    low, high = used.min(axis=0) - FAR_OFF * scan.size, used.max(axis=0) + FAR_OFF * scan.size
    off = [key for key, place in points.items() if (place < low).any() or (place > high).any()]
    kept = {key: place for key, place in points.items() if key not in off}
    trouble = texts.POINTS_OFF.format(path=path.name, points=", ".join(off)) if off else ""
    return replace(file, points=kept, vertices={}), trouble


def fit(request: FitRequest, progress: Progress) -> Fitted:
    """Fit, paint and measure."""
    anchors = generic_points(request.generic, request.moved)
    own = fit_own_face(request.generic, request.scan, request.points, anchors, request.name, progress.part(0.0, 0.5))
    notes = list(own.notes)
    stage = progress.part(0.5, 0.9)
    if request.photo is not None and request.pixels:
        face, camera = painted_by_photo(own, request.photo, request.pixels, request.points, stage)
        notes.append(f"The photo's camera misses the points by {camera.error_px:.1f} pixels.")
    else:
        face = painted(own, stage)
    progress.step(0.9, texts.FITTING)
    coloured = replace(
        own.face, uv=own.uv, texture=distance_texture(own.face, own.uv, own.closed.to_scan, FULL_MM),
        look=replace(own.face.look, hair_mm=0.0),
    )  # fmt: skip
    return Fitted(own, face, _shaped(face), _shaped(coloured), tuple(notes))


def save(request: tuple[Face, Path], _progress: Progress) -> Path:
    """Write a face file."""
    save_own_face(*request)
    return request[1]


def _shaped(face: Face) -> PosedFace:
    made = PosedFace(Rig.of(with_room_for_teeth(face)), FaceArrays.of(face))
    face_light().prepare(face, made.arrays)
    return made
