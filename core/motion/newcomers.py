"""Sentences on their way into a database, from a corpus or from another database of the same actor."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.motion.captures import KeptCapture, read_capture
from core.motion.database import MotionDatabase, damage_told
from core.motion.database_checks import stored
from core.motion.marker_set import MarkerSet
from core.motion.motion_part import MotionPart, packed
from core.motion.normalise import normalise
from core.motion.prepared import PreparedSentence
from core.motion.recording import Recording, is_sentence_name

# mm, root mean square over markers: a set of markers taken off and put on again is off by a few, another face by more
FARTHEST_REST_MM = 10.0


@dataclass(frozen=True)
class Newcomers:
    """New sentences, in the head space and the components of the database that they go into.

    part : their frames and motion nodes; None of none
    captures : their faces by name; captured : names of those that are as they were captured, not shown by components
    audio : name and FLAC file of those with sound
    held_out, apart : names by split, and the raw recordings, of what is not to be searched
    counts : what was done to them, for the report
    """

    part: MotionPart | None
    captures: Mapping[str, KeptCapture]
    captured: frozenset[str]
    audio: Iterable[tuple[str, bytes]] = ()
    held_out: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    apart: Sequence[Recording] = ()
    synthetic: bool = False
    counts: Mapping[str, int] = field(default_factory=dict)

    @classmethod
    def of_prepared(cls, prepared: Sequence[PreparedSentence], database: MotionDatabase) -> Newcomers:
        """Take sentences of a corpus that were prepared for ``database``."""
        captures = {p.recording.sentence: KeptCapture(p.face, p.masked) for p in prepared}
        part, left_out = MotionPart.of_prepared(prepared, database.pca, database.rate_hz) if prepared else (None, 0)
        counts = {
            "marker_samples_filled": sum(p.n_filled for p in prepared),
            "frames_masked": int(sum(p.masked.sum() for p in prepared)),
            "phones_left_out": left_out,
        }
        return cls(part, captures, frozenset(captures), counts=counts)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the new sentences that make motion nodes."""
        return tuple(s.name for s in self.part.sentences) if self.part is not None else ()

    def fit(self, database: MotionDatabase) -> tuple[float | None, float | None]:
        """Return how well the components of ``database`` show the new frames.

        The share of their variance about its mean, and what is missed in mm, root mean square over markers and frames.
        """
        squares = missed = n_frames = 0.0
        for capture in self.captures.values():
            face = capture.face[~capture.masked].astype(float)
            away = face.reshape(len(face), -1) - database.pca.mean
            squares += float((away**2).sum())
            missed += float(((away - away @ database.pca.basis @ database.pca.basis.T) ** 2).sum())
            n_frames += len(face)
        if not squares:
            return None, None
        return 1.0 - missed / squares, float(np.sqrt(missed / (n_frames * len(database.markers))))


NOBODY = Newcomers(None, {}, frozenset())


def newcomers_of_database(database: MotionDatabase, other: MotionDatabase, file, prefix: str = "") -> Newcomers:
    """Take all sentences of ``other``, whose open HDF5 file is ``file``, for ``database``.

    prefix : put before each sentence name
    Raises `UserFacingError` when the two are not of one rate, marker set, scale or actor.
    """
    columns, theirs = _check_alike(database, other), MotionPart.of_database(other)
    for name in [s.name for s in other.sentences]:
        if prefix and not is_sentence_name(prefix + name):
            raise UserFacingError(f"'{prefix + name}' cannot be the name of a sentence.")
    same_space = np.array_equal(database.markers.rest, other.markers.rest[columns])
    captures, captured = {}, set()
    turns, moves = other.head_rotation.copy(), other.head_translation.copy()
    for sentence in other.sentences:
        span = slice(sentence.start_frame, sentence.stop_frame)
        with damage_told(other.path):
            capture = read_capture(file, sentence.name, span.stop - span.start, len(other.markers))
        if capture is None:
            face = other.pca.positions(other.frames[span]).astype(np.float32)
            capture = KeptCapture(face, np.zeros(len(face), bool))
        else:
            captured.add(prefix + sentence.name)
        face = capture.face[:, columns]
        if not same_space:
            face, turns[span], moves[span] = _in_space_of(database, face, turns[span], moves[span])
        captures[prefix + sentence.name] = KeptCapture(face, capture.masked)
    sentences = tuple(replace(s, name=prefix + s.name) for s in other.sentences)
    part = replace(
        theirs, frames=np.concatenate([packed(database.pca, c.face) for c in captures.values()]),
        head_rotation=turns, head_translation=moves, sentences=sentences,
        nodes=replace(other.nodes, sentence_names=tuple(s.name for s in sentences)),
        came_from=np.full(len(other.frames), -1),
    )  # fmt: skip
    apart = [replace(r, sentence=prefix + r.sentence) for r in held_out_recordings(other)]
    own_names = [s.name for s in other.sentences] + [r.sentence.removeprefix(prefix) for r in apart]
    return Newcomers(
        part, captures, frozenset(captured),
        ((prefix + name, flac) for name, flac in stored_sounds(other, file, own_names)),
        {split: tuple(prefix + name for name in names) for split, names in other.held_out.items()},
        [seen_by(database.markers, r) for r in apart], other.synthetic, counts_of(other),
    )  # fmt: skip


def counts_of(database: MotionDatabase) -> dict[str, int]:
    """Return the counts in a database's report, as far as they are counts: a report comes from a file."""
    found = {name: database.report.get(name, 0) for name in
             ("marker_samples_filled", "frames_masked", "phones_left_out")}  # fmt: skip
    return {name: n if type(n) is int else 0 for name, n in found.items()}


def held_out_recordings(database: MotionDatabase) -> list[Recording]:
    """Read all recordings that a database holds out."""
    return [r for split, names in database.held_out.items() if names for r in database.held_out_recordings(split)]


def seen_by(markers: MarkerSet, recording: Recording) -> Recording:
    """Return a recording with just the markers of a set, in its order; raises `UserFacingError` without one of them."""
    column = {name: k for k, name in enumerate(recording.marker_names)}
    missing = [name for name in markers.names if name not in column]
    if missing:
        raise UserFacingError(f"Sentence '{recording.sentence}' has no marker '{missing[0]}', which the database has.")
    positions = np.asarray(recording.positions, np.float32)[:, [column[name] for name in markers.names]]
    return replace(recording, positions=positions, marker_names=markers.names)


def _check_alike(database: MotionDatabase, other: MotionDatabase) -> np.ndarray:
    """Check that two databases can be one; return where the markers of the first are in the second."""
    two = f"'{database.name}' and '{other.name}'"
    if database.rate_hz != other.rate_hz:
        raise UserFacingError(f"The databases {two} have {database.rate_hz:g} and {other.rate_hz:g} frames a second.",
                              "Build one of them anew at the rate of the other.")  # fmt: skip
    if set(database.markers.names) != set(other.markers.names):
        odd = min(set(database.markers.names) ^ set(other.markers.names))
        raise UserFacingError(f"The databases {two} do not have the same markers: only one has '{odd}'.")
    if database.with_scale != other.with_scale:
        raise UserFacingError(f"The databases {two} are not both of true scale.")
    columns = other.markers.indices(database.markers.names)
    rest, *_ = _normalised(database, other.markers.rest[columns][None])
    apart_mm = float(np.sqrt(((rest[0] - database.markers.rest) ** 2).sum(axis=1).mean()))
    if not apart_mm <= FARTHEST_REST_MM:
        raise UserFacingError(f"The rest poses of {two} lie {apart_mm:.1f} mm apart, so they are not of one actor.")
    return columns


def _normalised(database: MotionDatabase, face: np.ndarray):
    rigid, origin = database.markers.group("rigid"), database.markers.group("origin")
    return normalise(face, database.markers.rest, rigid if len(rigid) >= 3 else None,
                     int(origin[0]) if len(origin) else None, database.with_scale)  # fmt: skip


def _in_space_of(
    database: MotionDatabase, face: np.ndarray, turn: np.ndarray, move: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Bring a face from one head space to another, and its head motion with it; float32 all."""
    there, head = _normalised(database, face)
    before = Rotation.from_rotvec(turn).as_matrix()
    turned = Rotation.from_matrix(before @ head.rotation).as_rotvec()
    moved = np.einsum("fc,fdc->fd", head.translation, before) + move
    return there.astype(np.float32), turned.astype(np.float32), moved.astype(np.float32)


def stored_sounds(database: MotionDatabase, file, names: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """Yield name and FLAC file of those of ``names`` that have sound in the open HDF5 file of ``database``."""
    for name in names:
        with damage_told(database.path):
            flac = stored(file, f"audio/{name}", np.uint8).tobytes() if f"audio/{name}" in file else None
        if flac is not None:
            yield name, flac
