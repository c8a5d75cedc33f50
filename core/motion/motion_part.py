"""Sentences with their frames and motion nodes, to be joined, thinned out and made a database of."""

from __future__ import annotations

import hashlib
from collections.abc import Container, Sequence
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from core.errors import UserFacingError
from core.motion.captured_sentence import CapturedSentence
from core.motion.database import REMAKE, MotionDatabase
from core.motion.marker_set import MarkerSet
from core.motion.node import NIL, NodeTable, NodeTableBuilder
from core.motion.pca import MotionPca
from core.motion.prepared import PreparedSentence
from core.motion.resample import frame_bounds
from core.speech.emotion import EMOTION_INDEX
from core.speech.phoneme import PHONEME_INDEX


@dataclass(frozen=True)
class MotionPart:
    """Whole sentences, one after the other; arrays as in `MotionDatabase`.

    came_from : int64, shape (n_frames,), rows of the frames in the database that they were taken from, -1 for new ones
    """

    frames: np.ndarray
    head_rotation: np.ndarray
    head_translation: np.ndarray
    nodes: NodeTable
    sentences: tuple[CapturedSentence, ...]
    came_from: np.ndarray

    @classmethod
    def of_database(cls, database: MotionDatabase) -> MotionPart:
        """Take all sentences of a database; raises `UserFacingError` when one does not follow the other."""
        stops = [s.stop_frame for s in database.sentences]
        if [s.start_frame for s in database.sentences] != [0, *stops[:-1]] or stops[-1:] != [len(database.frames)]:
            raise UserFacingError(f"The motion database '{database.path}' is damaged (its sentences overlap).", REMAKE)
        return cls(database.frames, database.head_rotation, database.head_translation, database.nodes,
                   database.sentences, np.arange(len(database.frames)))  # fmt: skip

    @classmethod
    def of_prepared(
        cls, prepared: Sequence[PreparedSentence], pca: MotionPca, rate_hz: float
    ) -> tuple[MotionPart, int]:
        """Cut new sentences into motion nodes; also return how many phones were left out for want of good frames."""
        builder = NodeTableBuilder()
        sentences, first, left_out = [], 0, 0
        for p in prepared:
            about, transcript = p.recording, p.recording.transcript
            start, stop = frame_bounds([u.start_s for u in transcript.phonemes],
                                       [u.end_s for u in transcript.phonemes], rate_hz)  # fmt: skip
            left_out += builder.add_sentence(
                about.sentence, EMOTION_INDEX[about.emotion], [PHONEME_INDEX[x] for x in transcript.phones],
                start, stop, p.masked, first,
            )  # fmt: skip
            sentences.append(CapturedSentence(about.sentence, about.emotion, about.text, first, first + len(p.face),
                                              transcript))  # fmt: skip
            first += len(p.face)
        frames = np.concatenate([packed(pca, p.face) for p in prepared])
        turns, moves = (np.concatenate([getattr(p, name) for p in prepared]) for name in ("turn", "move"))
        return cls(frames, turns, moves, builder.table(), tuple(sentences), np.full(first, -1)), left_out

    def without(self, sentences: Container[str], node_rows: np.ndarray | None = None) -> MotionPart:
        """Leave out whole ``sentences``, and of the others the motion nodes at ``node_rows``, whose frames stay."""
        stays = np.array([s.name not in sentences for s in self.sentences], bool)
        frame_stays = np.zeros(len(self.frames), bool)
        kept, first = [], 0
        for sentence, is_kept in zip(self.sentences, stays):
            span = slice(sentence.start_frame, sentence.stop_frame)
            if is_kept:
                frame_stays[span] = True
                stop = first + span.stop - span.start
                kept.append(replace(sentence, start_frame=first, stop_frame=stop))
                first = stop
        nodes, node_stays = self.nodes, stays[self.nodes.sentence]
        if node_rows is not None:
            node_stays[node_rows] = False
        new_row = np.where(node_stays, np.cumsum(node_stays) - 1, NIL)
        moved = np.concatenate([[0], np.cumsum(frame_stays)])
        columns = {name: getattr(nodes, name)[node_stays] for name in NodeTable.COLUMNS}
        columns["sentence"] = (np.cumsum(stays) - 1)[columns["sentence"]]
        for name in ("start", "stop"):
            columns[name] = moved[columns[name]]
        for name in ("pre", "suc"):
            columns[name] = np.where(columns[name] == NIL, NIL, new_row[columns[name]])
        return MotionPart(
            self.frames[frame_stays], self.head_rotation[frame_stays], self.head_translation[frame_stays],
            _table(columns, [s.name for s in kept]), tuple(kept), self.came_from[frame_stays],
        )  # fmt: skip

    def followed_by(self, other: MotionPart) -> MotionPart:
        """Join two parts whose sentences have different names and whose frames have the same components."""
        n_frames, n_nodes, n_sentences = len(self.frames), len(self.nodes), len(self.sentences)
        shift = {"sentence": n_sentences, "start": n_frames, "stop": n_frames, "pre": n_nodes, "suc": n_nodes}
        columns = {}
        for name in NodeTable.COLUMNS:
            own, theirs = getattr(self.nodes, name), getattr(other.nodes, name)
            if name in shift:
                theirs = np.where(theirs == NIL, NIL, theirs.astype(np.int64) + shift[name])
            columns[name] = np.concatenate([own, theirs])
        later = tuple(replace(s, start_frame=s.start_frame + n_frames, stop_frame=s.stop_frame + n_frames)
                      for s in other.sentences)  # fmt: skip
        sentences = self.sentences + later
        joined = {name: np.concatenate([getattr(self, name), getattr(other, name)])
                  for name in ("frames", "head_rotation", "head_translation", "came_from")}  # fmt: skip
        return MotionPart(**joined, nodes=_table(columns, [s.name for s in sentences]), sentences=sentences)

    def content_hash(self, markers: MarkerSet, pca: MotionPca) -> str:
        """Return the digest of what was captured: markers, components, frames and motion nodes."""
        digest = hashlib.sha256(markers.to_json().encode())
        columns = [getattr(self.nodes, name) for name in NodeTable.COLUMNS]
        for array in (markers.rest, pca.mean, pca.basis, self.frames, *columns):
            digest.update(np.ascontiguousarray(array).data)
        digest.update("\n".join(self.nodes.sentence_names).encode())
        return digest.hexdigest()


def packed(pca: MotionPca, face: np.ndarray) -> np.ndarray:
    """Return the coefficients of a sentence's frames as they are stored, float32, shape (n_frames, n_dims)."""
    with threadpool_limits(1):  # as in `MotionPca.fit`: equal captures give equal bytes
        return pca.coefficients(face.astype(float)).astype(np.float32)


def _table(columns: dict[str, np.ndarray], sentence_names: Sequence[str]) -> NodeTable:
    typed = {name: columns[name].astype(dtype) for name, dtype in NodeTable.COLUMNS.items()}
    return NodeTable(**typed, sentence_names=tuple(sentence_names))
