"""What the motion units page does in the background. Functions for `app.jobs`."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.child_process import run_apart
from app.figures import marker_figure, units_figure
from app.pictures import FaceRig
from app.texts import units as texts
from core.errors import UserFacingError
from core.face.default_face import default_face
from core.iface.coverage import covered_by_count
from core.iface.keyframes import Keyframes
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.iface.paper_keyframes import captured_keyframes, drawn_keyframes
from core.iface.units_of_database import spoken_deformations, units_of_database
from core.media.image_sequence import write_png
from core.motion.database import MotionDatabase
from core.progress import Progress

CAPTURED, DRAWN = texts.CAPTURED[0], texts.DRAWN[0]


@dataclass(frozen=True)
class LearnRequest:
    """What to learn units from, and how many; see `core.iface.motion_unit.MotionUnitSet.fit`."""

    database: MotionDatabase
    removed: frozenset[str]
    utterance: int | float
    expression: int | float


@dataclass(frozen=True)
class Learned:
    """Motion units of one database.

    shares : see `core.iface.coverage.covered_by_count`
    keyframes : by source, `CAPTURED` and `DRAWN`; a source that shows none is left out
    not_captured : keyframes that had to be drawn among the captured ones
    """

    request: LearnRequest
    units: MotionUnits
    shares: Mapping[str, np.ndarray]
    keyframes: Mapping[str, Keyframes]
    not_captured: tuple[str, ...]


def learn(request: LearnRequest, progress: Progress) -> Learned:
    """Learn the units, and find the keyframes that they convert to."""
    database = request.database
    progress.step(0.0, texts.LEARNING)
    units = units_of_database(database, request.utterance, request.expression, request.removed)
    progress.step(0.4, texts.LEARNING)
    moved = spoken_deformations(database, request.removed)
    shares = covered_by_count({name: moved[name] for name in (NEUTRAL, *units.expressions)}, request.utterance)
    progress.step(0.7, texts.LEARNING)
    face = None
    with contextlib.suppress(UserFacingError):
        face = default_face()
    keyframes, not_captured = {}, ()
    with contextlib.suppress(UserFacingError):
        keyframes[CAPTURED], not_captured = captured_keyframes(database, face, removed=request.removed)
    if face is not None:
        with contextlib.suppress(UserFacingError):  # markers that cannot be laid on the face
            keyframes[DRAWN] = drawn_keyframes(face, database.markers)
    return Learned(request, units, shares, keyframes, not_captured)


@dataclass(frozen=True)
class FigureRequest:
    """A figure to draw: of keyframes, or of units where there are none. It travels to another process.

    title, drawn : of the figure of keyframes, see `app.figures.marker_figure`
    poses, names : of the units, see `app.figures.units_figure`
    """

    path: Path
    rig: FaceRig
    keyframes: Keyframes | None = None
    title: str = ""
    drawn: tuple[str, ...] = ()
    poses: np.ndarray | None = None
    names: tuple[str, ...] = ()


def draw(request: FigureRequest, progress: Progress) -> Path:
    """Draw the figure in a process of its own, which leaves Python's lock to the window; return its path."""
    return run_apart(_draw, (request,), progress, texts.DIED)


def _draw(request: FigureRequest, progress: Progress) -> Path:
    if request.keyframes is not None:
        picture = marker_figure(request.keyframes, request.rig, request.title, request.drawn, progress)
    else:
        picture = units_figure(request.poses, request.names, request.rig, progress)
    write_png(request.path, picture)
    return request.path
