"""Faces that controls move by their own shapes, and all characters together, for pictures and for exports."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from app.pictures import Drawable, FaceRig
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.face.characters import CHARACTERS, DEFAULT
from core.face.default_face import character_face
from core.face.face import Face
from core.face.face_file import FACE_SUFFIX
from core.face.gltf_mesh import read_gltf_shapes
from core.face.lip_contact import LipContact
from core.face.mesh_files import face_of
from core.face.moving_parts import MovingParts
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack
from core.rig.key_poses import KeyPoses, load_key_poses, posed_controls
from core.rig.retarget import controls_of_motion
from core.rig.rig import Rig, fitted
from core.rig.rig_files import GLTF_SUFFIXES, load_rig
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

CAST = "cast"


@dataclass(frozen=True)
class ControlledFace:
    """A rig that is drawn.

    poses_of_keys : an artist's poses of key lip shapes; without them, controls are matched with ARKit's by name
    """

    rig: Rig
    poses_of_keys: KeyPoses | None = None

    @property
    def faces(self) -> tuple[Face, ...]:
        """See `app.pictures.Drawable`."""
        return (self.rig.face,)

    @cached_property
    def _parts(self) -> MovingParts:
        return MovingParts(self.rig.face)

    @cached_property
    def _lips(self) -> LipContact | None:
        return LipContact.of(self.rig.face)

    def poses(
        self, motion: MarkerMotion, tracks: PoseTracks, first: int, stop: int
    ) -> Iterator[tuple[np.ndarray, ...]]:
        """See `app.pictures.Drawable`."""
        yield from self.controlled(rig_controls(motion, self.rig, self.poses_of_keys), tracks, first, stop)

    def controlled(
        self, track: ControlTrack, tracks: PoseTracks, first: int, stop: int
    ) -> Iterator[tuple[np.ndarray, ...]]:
        """Yield the vertices for curves in any controls, matched by name; see `poses`."""
        values = fitted(self.rig, track)[0].values
        for f in range(first, stop):
            moved = self.rig.moved(values[f])
            if self._lips is not None:
                self._lips.apply(moved)
            yield (self._parts.place(moved, **tracks.at(f)),)


@dataclass(frozen=True)
class Cast:
    """Several faces that say the same, side by side."""

    members: tuple[Drawable, ...] = field(default=())

    @property
    def faces(self) -> tuple[Face, ...]:
        """See `app.pictures.Drawable`."""
        return tuple(face for member in self.members for face in member.faces)

    def poses(
        self, motion: MarkerMotion, tracks: PoseTracks, first: int, stop: int
    ) -> Iterator[tuple[np.ndarray, ...]]:
        """See `app.pictures.Drawable`."""
        for at_once in zip(*(member.poses(motion, tracks, first, stop) for member in self.members)):
            yield tuple(positions for of_one in at_once for positions in of_one)


def drawable(
    face: FaceChoice, markers: MarkerSet, key_poses: Path | None = None, progress: Progress = SILENT
) -> Drawable:
    """Return what ``face`` names: a character or a mesh that markers move, a rig that controls move, or `CAST`.

    A mesh is a rig when it holds shapes and no marker file came with it, or poses of key lip shapes did. Raises
    `UserFacingError` when it is not there or does not fit.
    """
    if face.name == CAST:
        names = list(CHARACTERS)
        return Cast(tuple(
            FaceRig.of(name, markers, progress=progress.part(n / len(names), (n + 1) / len(names)))
            for n, name in enumerate(names)
        ))  # fmt: skip
    rig = rig_named(face, key_poses, progress)
    if rig is not None and (not _has_our_markers(rig.face) or key_poses is not None):
        return ControlledFace(rig, None if key_poses is None else load_key_poses(key_poses))
    marker_file = None if face.marker_file is None else Path(face.marker_file)
    return FaceRig.of(face.name, markers, marker_file, progress)


def rig_named(face: FaceChoice, key_poses: Path | None = None, progress: Progress = SILENT) -> Rig | None:
    """Return the rig that ``face`` names, or None for a face that only markers can move."""
    if face.name in CHARACTERS or key_poses is not None or Path(face.name).is_dir():
        return load_rig(face.name, progress)
    path = Path(face.name)
    if path.suffix.lower() == FACE_SUFFIX:
        return load_rig(face.name, progress)
    if path.suffix.lower() in GLTF_SUFFIXES and face.marker_file is None:
        mesh, shapes = read_gltf_shapes(path)
        if shapes:
            return Rig.of(face_of(mesh, path, shapes=shapes))
    return None


def rig_controls(motion: MarkerMotion, rig: Rig | None, key_poses: KeyPoses | None = None) -> ControlTrack:
    """Return the controls that ``motion`` asks for: through the artist's poses, or as units of ARKit.

    A character's own markers tell its units; for any other rig, or none, they are those of the default face.
    """
    if rig is not None and key_poses is not None:
        return posed_controls(key_poses, rig, motion)
    is_ours = rig is not None and _has_our_markers(rig.face)
    return controls_of_motion(motion, rig.face if is_ours else character_face(DEFAULT))


def _has_our_markers(face: Face) -> bool:
    return face.name in CHARACTERS or face.is_kin


def one_rig(face: FaceChoice, key_poses: Path | None, for_file: Path) -> Rig:
    """Return the rig that goes into a file; raises `UserFacingError` for a face that has no shapes, and for many."""
    if face.name == CAST:
        raise UserFacingError(f"'{for_file}' holds one face, and '{CAST}' is {len(CHARACTERS)}.",
                              f"Name one of {', '.join(CHARACTERS)}.")  # fmt: skip
    rig = rig_named(face, key_poses)
    if rig is None:
        raise UserFacingError(
            f"The face '{face.name}' has no shapes, which '{for_file}' would hold.",
            "Give a glTF file with morph targets, a folder of OBJ files, or a character.",
        )
    return rig
