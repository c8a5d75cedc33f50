"""What the window of key lip shapes does in the background. Functions for `app.jobs`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.face_light import face_light
from app.panels.poses.posing import PosedFace, Posing, lip_rows
from app.texts import poses as texts
from core.animeme.key_shapes import captured_keys
from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.face.default_face import default_face
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.progress import Progress
from core.rig.key_poses import KeyPoses, first_poses, load_key_poses, resting_poses
from core.rig.rig_files import load_rig
from gpu.gl.complexion import grain
from gpu.gl.face_arrays import FaceArrays

_BLOCK_FRAMES = 4096
_SAME_MM = 0.01  # files of poses are rounded


@dataclass(frozen=True)
class GuessRequest:
    """Captured lips to be posed.

    lips : int, shape (K,), rows of ``markers``; lips_mm : shape (N, K, 3), mm from rest
    """

    face: PosedFace
    markers: MarkerSet
    lips: np.ndarray
    lips_mm: np.ndarray


@dataclass(frozen=True)
class Guess:
    """Poses to go on from; trouble : why they rest, or nothing."""

    poses: KeyPoses
    trouble: str = ""


def open_rig(name: str, progress: Progress) -> PosedFace:
    """Load a rig, and work out what its view would have to on the main thread."""
    rig = load_rig(name, progress.part(0.0, 0.5))
    progress.step(0.5, texts.OPENING_RIG)
    face = PosedFace(rig, FaceArrays.of(rig.face))
    grain()
    face_light().prepare(rig.face, face.arrays)
    return face


def guess(request: GuessRequest, progress: Progress) -> Guess:
    """Pose the rig by least squares at the lip markers, where names match; else, and on other markers, at rest."""
    rig, markers, lips, lips_mm = request.face.rig, request.markers, request.lips, request.lips_mm
    try:
        return Guess(first_poses(rig, default_face(progress), markers, lips, lips_mm))
    except UserFacingError as error:
        poses = resting_poses(rig.face.name, rig.names, markers, lips, lips_mm)
        return Guess(poses, texts.NOT_POSED.format(why=error.message))


def find_keys(request: tuple[PosedFace, MotionDatabase, int], progress: Progress) -> tuple[Posing, str]:
    """Choose key lip shapes among the captures and pose the rig for them; the sentence is a guess's trouble."""
    face, database, n_keys = request
    lips, lips_mm = captured_keys(database, n_keys, progress=progress.part(0.0, 0.8))
    progress.step(0.8, texts.GUESSING)
    guessed = guess(GuessRequest(face, database.markers, lips, lips_mm), progress.part(0.8, 0.9))
    frames = whole_frames(database, guessed.poses, progress.part(0.9, 1.0))
    return Posing(face, guessed.poses, frames), guessed.trouble


def read_poses(request: tuple[Path, PosedFace | None, MotionDatabase | None], progress: Progress) -> Posing:
    """Read poses, and the character that they were made for.

    Raises `UserFacingError` for a file that holds none, and for poses of another rig than the one on show.
    """
    path, face, database = request
    poses = load_key_poses(path)
    if poses.rig in CHARACTERS and (face is None or face.face.name != poses.rig):
        face = open_rig(poses.rig, progress.part(0.1, 0.8))
    if face is None or poses.controls != face.rig.names:
        shown = texts.POSED.lower() if face is None else face.face.name
        raise UserFacingError(texts.MISFIT.format(path=path, rig=poses.rig[:60], face=shown), texts.OPEN_THAT_RIG)
    poses = replace(poses, rig=face.face.name)
    unknown = (None,) * len(poses.keys)
    frames = unknown if database is None else whole_frames(database, poses, progress.part(0.8, 1.0))
    return Posing(face, poses, frames)


def whole_frames(database: MotionDatabase, poses: KeyPoses, progress: Progress) -> tuple[np.ndarray | None, ...]:
    """Return for each key the captured frame that its lips were taken from, shape (n_markers, 3), mm from rest.

    None for lips that are none of the database's.
    """
    rows = lip_rows(database.markers, poses.markers)
    best: list[tuple[float, np.ndarray | None]] = [(_SAME_MM, None)] * len(poses.keys)
    for first in range(0, len(database.frames) if rows is not None else 0, _BLOCK_FRAMES):
        progress.step(first / len(database.frames), texts.FINDING)
        moved = database.pca.positions(database.frames[first : first + _BLOCK_FRAMES].astype(float))
        moved -= database.markers.rest
        for n, lips in enumerate(poses.lips_mm):
            away = np.abs(moved[:, rows] - lips).max(axis=(1, 2))
            nearest = int(away.argmin())
            if away[nearest] < best[n][0]:
                best[n] = float(away[nearest]), moved[nearest].astype(np.float32)
    return tuple(frame for _, frame in best)


def rig_of_file(path: Path) -> str:
    """Return what `load_rig` calls a chosen file; one OBJ file stands for the folder of shapes that it lies in."""
    return str(path.parent if path.suffix.lower() == ".obj" else path)
