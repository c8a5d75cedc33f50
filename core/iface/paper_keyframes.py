"""The paper's eight keyframes (Hong, Wen and Huang 2002, figure 4): captured, or drawn by the units of a face."""

from __future__ import annotations

import contextlib
import csv
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np

from core.animeme.cross_mapping import units_at_markers
from core.errors import UserFacingError
from core.face.face import Face
from core.iface.keyframes import Keyframes
from core.iface.motion_unit import NEUTRAL
from core.iface.units_of_database import nodes_that_count, spoken_deformations
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.motion.resample import frame_bounds
from core.speech.emotion import EMOTION_INDEX
from core.speech.phoneme import PAU, PHONEME_INDEX

_TABLE = Path(__file__).resolve().parents[2] / "resources" / "iface" / "keyframes.csv"
_OF_EMOTION, _OF_PHONE = "emotion", "phone"
_TYPICAL_SHARE = 0.25
_AWAY_S, _FEWEST_SILENT = 0.04, 24  # lips that open or close are no silence


@dataclass(frozen=True)
class PaperKeyframe:
    """One of the eight: what of a capture shows it, and which units of ARKit draw it.

    emotion, phone : the one that it is captured in; the other is None
    units : unit name to strength, 0..1
    """

    emotion: str | None = None
    phone: str | None = None
    units: Mapping[str, float] = field(default_factory=dict)


@cache
def paper_keyframes() -> dict[str, PaperKeyframe]:
    """Return the eight by name, in the order of figure 4: smile, sad, a, i, o, m, f, u."""
    rows: dict[str, dict[str, str]] = {}
    with _TABLE.open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["keyframe"], {})[row["of"]] = row["value"]
    return {
        name: PaperKeyframe(
            of.get(_OF_EMOTION), of.get(_OF_PHONE),
            {unit: float(value) for unit, value in of.items() if unit not in (_OF_EMOTION, _OF_PHONE)},
        )
        for name, of in rows.items()
    }  # fmt: skip


def drawn_units(names: tuple[str, ...]) -> np.ndarray:
    """Return the strengths of a face's units for each keyframe, float64, shape (8, len(names)), 0..1."""
    return np.array([[keyframe.units.get(name, 0.0) for name in names] for keyframe in paper_keyframes().values()])


def drawn_keyframes(face: Face, markers: MarkerSet, of_displacements: bool = False) -> Keyframes:
    """Return the keyframes as the units of ``face`` draw them, at the actor's markers, mm.

    Raises `UserFacingError` for a face without units, or one that the markers cannot be laid on.
    """
    if not face.units:
        raise UserFacingError(f"The face {face.name} has no shapes to draw keyframes with.",
                              "Choose one of our characters.")  # fmt: skip
    names, moves = units_at_markers(face, markers)
    shapes = np.tensordot(drawn_units(names), moves, axes=1) + markers.rest
    return Keyframes(tuple(paper_keyframes()), shapes, markers.rest, of_displacements)


def captured_keyframes(
    database: MotionDatabase, face: Face | None = None, of_displacements: bool = False,
    removed: Collection[str] = (),
) -> tuple[Keyframes, tuple[str, ...]]:  # fmt: skip
    """Return the keyframes κ' as they occur in the captures, and the names of those that had to be drawn.

    A viseme is seen in the middle frames of its phone in neutral speech, an expression in the silences of its
    sentences, so that its lips rest (without silences: in what it adds to neutral speech on average). Of these frames
    the quarter that goes farthest the way that all of them go is averaged.

    face : draws what was not captured; without it, or where the markers cannot be laid on it, such a keyframe is left
        out
    removed : public names of nodes that do not count

    Raises `UserFacingError` when nothing is left.
    """
    found = _captured(database, removed)
    drawn = None
    if face is not None and len(found) < len(paper_keyframes()):
        with contextlib.suppress(UserFacingError):  # markers that cannot be laid on the face
            drawn = drawn_keyframes(face, database.markers)
    names = [name for name in paper_keyframes() if name in found or drawn is not None]
    if not names:
        raise UserFacingError(f"The database '{database.name}' shows none of the paper's keyframes.")
    rest = database.markers.rest
    shapes = [
        rest + found[name] if name in found else drawn.shapes[drawn.names.index(name)] for name in names
    ]  # fmt: skip
    keyframes = Keyframes(tuple(names), np.array(shapes), rest, of_displacements)
    return keyframes, tuple(name for name in names if name not in found)


def _captured(database: MotionDatabase, removed: Collection[str]) -> dict[str, np.ndarray]:
    """Displacements of what the captures show, shape (n_markers, 3), mm."""
    nodes, spoken = database.nodes, spoken_deformations(database, removed)
    if NEUTRAL not in spoken:
        return {}
    mean = spoken[NEUTRAL].mean(axis=0)
    counts, middle = nodes_that_count(database, removed), (nodes.start + nodes.stop - 1) // 2
    found = {}
    for name, keyframe in paper_keyframes().items():
        if keyframe.phone is not None:
            of_phone = (nodes.phoneme == PHONEME_INDEX[keyframe.phone]) & (nodes.emotion == EMOTION_INDEX[NEUTRAL])
            frames = middle[counts & of_phone]
            if len(frames):
                moved = _displacements(database, frames)
                found[name] = _typical(moved, moved.mean(axis=0) - mean)
        elif keyframe.emotion in spoken:
            adds = spoken[keyframe.emotion].mean(axis=0) - mean
            silent = _silent_frames(database, keyframe.emotion)
            found[name] = _typical(_displacements(database, silent), adds) if len(silent) >= _FEWEST_SILENT else adds
    return found


def _typical(moved: np.ndarray, direction: np.ndarray) -> np.ndarray:
    """Mean of the quarter that goes farthest in a direction: the mean of all is worn down by what they stand beside."""
    reach = np.tensordot(moved, direction, axes=2)
    return moved[reach >= np.quantile(reach, 1.0 - _TYPICAL_SHARE)].mean(axis=0)


def _silent_frames(database: MotionDatabase, emotion: str) -> np.ndarray:
    """Rows of the frames within the silences of an emotion's sentences, away from their ends."""
    rows = [np.zeros(0, int)]
    for sentence in database.sentences:
        if sentence.emotion == emotion:
            silences = [u for u in sentence.transcript.phonemes if u.phone == PAU]
            starts = [u.start_s + _AWAY_S for u in silences]
            bounds = frame_bounds(starts, [u.end_s - _AWAY_S for u in silences], database.rate_hz)
            rows += [sentence.start_frame + np.arange(start, stop) for start, stop in zip(*bounds)]
    found = np.concatenate(rows)
    return found[found < len(database.frames)]


def _displacements(database: MotionDatabase, rows: np.ndarray) -> np.ndarray:
    return database.pca.positions(database.frames[rows].astype(float)) - database.markers.rest
