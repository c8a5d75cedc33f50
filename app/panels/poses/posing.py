"""What the window of key lip shapes works on: a rig, and how it is posed; replaced as a whole by every edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from app.controlled_face import ControlledFace
from core.face.face import Face
from core.motion.marker_set import MarkerSet
from core.rig.control_names import control_mixing
from core.rig.control_track import ControlTrack
from core.rig.key_poses import KeyPoses
from core.rig.rig import Rig
from core.synthesis.pose_tracks import PoseTracks
from gpu.gl.face_arrays import FaceArrays

_ANY_RATE_HZ = 60.0


@dataclass(frozen=True)
class PosedFace:
    """A rig for a face view: its pose is told by controls, where others are told by markers.

    arrays : what a renderer uploads of the face
    """

    rig: Rig
    arrays: FaceArrays

    @property
    def face(self) -> Face:
        """The face at rest."""
        return self.rig.face

    def pose(self, values: np.ndarray) -> np.ndarray:
        """Return the vertices, as films show them, for controls of shape (U,): float32, shape (V, 3), mm."""
        track = ControlTrack(self.rig.names, np.asarray(values, float)[None], _ANY_RATE_HZ)
        return next(self._controlled.controlled(track, PoseTracks(), 0, 1))[0]

    @cached_property
    def _controlled(self) -> ControlledFace:
        """Kept, as it works out once which places of the lips meet."""
        return ControlledFace(self.rig)


@dataclass(frozen=True)
class Posing:
    """A rig and its poses.

    poses : None while there are no key lip shapes
    frames : for each key the whole captured frame, shape (n_markers, 3), mm from rest, or None where it is not known
    """

    face: PosedFace | None = None
    poses: KeyPoses | None = None
    frames: tuple[np.ndarray | None, ...] = field(default=())

    @property
    def keys(self) -> tuple[str, ...]:
        """Names of the key lip shapes."""
        return () if self.poses is None else self.poses.keys

    def on(self, face: PosedFace) -> Posing:
        """Return the same shapes on another rig; controls go over by name, others rest."""
        if self.poses is None:
            return replace(self, face=face)
        values = np.clip(self.poses.values @ control_mixing(self.poses.controls, face.rig.names), 0.0, 1.0)
        poses = replace(self.poses, rig=face.face.name, controls=face.rig.names, values=values)
        return replace(self, face=face, poses=poses)

    def with_added(self, added: KeyPoses, frame: np.ndarray | None) -> Posing:
        """Return these poses and one more, under a name that is free."""
        if self.poses is None:
            return replace(self, poses=added, frames=(frame,))
        number = next(n for n in range(1, len(self.keys) + 2) if f"lips{n}" not in self.keys)
        poses = replace(
            self.poses,
            keys=(*self.keys, f"lips{number}"),
            lips_mm=np.concatenate([self.poses.lips_mm, added.lips_mm]),
            values=np.concatenate([self.poses.values, added.values]),
        )
        return replace(self, poses=poses, frames=(*self.frames, frame))

    def without(self, row: int) -> Posing:
        """Return all poses but one."""
        left = [n for n in range(len(self.keys)) if n != row]
        if not left:
            return Posing(self.face)
        poses = replace(
            self.poses,
            keys=tuple(self.keys[n] for n in left),
            lips_mm=self.poses.lips_mm[left],
            values=self.poses.values[left],
        )
        return replace(self, poses=poses, frames=tuple(self.frames[n] for n in left))

    def renamed(self, row: int, name: str) -> Posing:
        """Return these poses with another name for one key."""
        keys = (*self.keys[:row], name, *self.keys[row + 1 :])
        return replace(self, poses=replace(self.poses, keys=keys))

    def with_values(self, row: int, values: np.ndarray) -> Posing:
        """Return these poses with one posed otherwise; values of shape (U,), within 0 and 1."""
        changed = self.poses.values.copy()
        changed[row] = values
        return replace(self, poses=replace(self.poses, values=changed))

    def captured(self, row: int, markers: MarkerSet) -> np.ndarray | None:
        """Return how markers stand in a key lip shape, shape (n_markers, 3), mm from rest.

        Where only its lips are known the others rest; None where the markers have no such lips.
        """
        if row < len(self.frames) and self.frames[row] is not None and len(self.frames[row]) == len(markers):
            return self.frames[row]
        rows = lip_rows(markers, self.poses.markers)
        if rows is None:
            return None
        moved = np.zeros((len(markers), 3), np.float32)
        moved[rows] = self.poses.lips_mm[row]
        return moved


def lip_rows(markers: MarkerSet, names: Sequence[str]) -> np.ndarray | None:
    """Return the rows of named markers, int, shape (K,); None when one is missing."""
    return markers.indices(names) if set(names) <= set(markers.names) else None
