"""Marker motion as control curves that an artist edits, and back: edits reach the markers, and so every export."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from core.animeme.cross_mapping import solve_controls, units_at_markers
from core.animeme.material import component_controls
from core.face.characters import DEFAULT
from core.face.default_face import character_face
from core.motion.database import MotionDatabase
from core.rig.control_track import ControlTrack
from core.synthesis.control_edits import ControlEdits
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.polish import Polish, polished

# What shows speech best, to begin with.
LIP_CONTROLS = ("jawOpen", "mouthClose", "mouthFunnel", "mouthPucker", "mouthStretchLeft", "mouthLowerDownLeft",
                "mouthUpperUpLeft", "mouthSmileLeft")  # fmt: skip
_N_COMPONENTS_SHOWN = 5
_LANDMARKS_NEEDED = 4


@dataclass(frozen=True, eq=False)
class ControlBasis:
    """What each control does to the markers.

    names : of the U controls
    moves : float64, shape (U, K, 3), mm for a control of 1
    rest : float64, shape (U,), values in which a control does nothing
    lowest, highest : what edits keep a control within
    shown : those to show first
    """

    names: tuple[str, ...]
    moves: np.ndarray
    rest: np.ndarray
    lowest: float
    highest: float
    shown: tuple[str, ...]

    @property
    def has_units(self) -> bool:
        """Whether the controls are units of a face, in 0..1."""
        return self.highest == 1.0

    @classmethod
    def of(cls, database: MotionDatabase) -> ControlBasis:
        """Take the 52 units of the default face, whichever face is on show, so that a name means the same everywhere.

        Markers that cannot be laid on that face, for they name fewer than four landmarks, leave the principal
        components. Raises `UserFacingError` on a machine that lacks the face and cannot fetch it.
        """
        if len(database.markers.landmarks) >= _LANDMARKS_NEEDED:
            names, moves = units_at_markers(character_face(DEFAULT), database.markers)
            return cls(names, moves, np.zeros(len(names)), 0.0, 1.0, LIP_CONTROLS)
        names, pca = component_controls(database)[0], database.pca
        moves = pca.positions(np.eye(len(names))) - pca.positions(np.zeros((1, len(names))))
        rest = np.asarray(database.rest_coefficients, float)
        return cls(names, moves, rest, -np.inf, np.inf, names[:_N_COMPONENTS_SHOWN])

    def curves(self, motion: MarkerMotion, database: MotionDatabase) -> ControlTrack:
        """Return the controls that make ``motion``; bounded least squares for units of a face."""
        if self.has_units:
            return ControlTrack(self.names, solve_controls(motion.displacements, self.moves), motion.rate_hz)
        return ControlTrack(self.names, database.pca.coefficients(motion.positions.astype(float)), motion.rate_hz)


Answer = TypeVar("Answer")


class _LastAnswers:
    """The last few answers by the object that they are about; neither databases nor motions can be compared."""

    def __init__(self, n_kept: int) -> None:
        self._n_kept, self._kept, self._lock = n_kept, [], threading.Lock()

    def get(self, about: object, find: Callable[[], Answer]) -> Answer:
        with self._lock:
            for known, answer in self._kept:
                if known is about:
                    return answer
            answer = find()
            self._kept = [*self._kept, (about, answer)][-self._n_kept :]
            return answer


_BASES, _CURVES = _LastAnswers(2), _LastAnswers(2)


def control_basis(database: MotionDatabase) -> ControlBasis:
    """Return `ControlBasis.of` a database, found once."""
    return _BASES.get(database, lambda: ControlBasis.of(database))


def motion_curves(motion: MarkerMotion, database: MotionDatabase) -> ControlTrack:
    """Return the controls of ``motion`` before any edit, found once for as long as it is on show."""
    return _CURVES.get(motion, lambda: control_basis(database).curves(motion, database))


def edited_curves(curves: ControlTrack, basis: ControlBasis, edits: ControlEdits) -> ControlTrack:
    """Lay ``edits`` over ``curves``; what is edited is kept within the bounds of the controls."""
    values = np.array(curves.values, float)
    for name, edit in edits.by_control.items():
        if name in curves.names:
            u = curves.names.index(name)
            changed = edit.applied(values[:, u], curves.rate_hz, basis.rest[u])
            values[:, u] = np.clip(changed, basis.lowest, basis.highest)
    return replace(curves, values=values)


def laid_over(motion: MarkerMotion, database: MotionDatabase, edits: ControlEdits, polish: Polish) -> MarkerMotion:
    """Return the motion that is shown and exported: the engine's, under the artist's controls, under the polish.

    Each edited control moves the markers by what it differs from its own curve; all else of the motion stays, also what
    no control could make.
    """
    if not edits.changes_nothing:
        basis, curves = control_basis(database), motion_curves(motion, database)
        changed = edited_curves(curves, basis, edits).values - curves.values
        rows = np.flatnonzero(np.abs(changed).max(axis=0) > 0)
        moved = np.tensordot(changed[:, rows].astype(float), basis.moves[rows], axes=1)
        motion = replace(motion, positions=(motion.positions + moved).astype(np.float32))
    return polished(motion, polish)
