"""Motion nodes: the runs of captured frames of one phoneme occurrence each."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from core.errors import UserFacingError
from core.speech.emotion import EMOTIONS
from core.speech.phoneme import PAU, PHONEMES, VISEME_OF_PHONEME

NIL = -1
CONTEXT_REACH = 5  # phones to either side that a motion node knows of
_ORDER = re.compile("[0-9]{1,9}")


@dataclass(frozen=True)
class MotionNode:
    """One row of a `NodeTable`, spelt out for a reader.

    ``triphone`` is (previous, this, next) phone; beyond a sentence's edge or a silence stands ``pau``.
    """

    name: str
    row: int
    sentence: str
    order: int
    phone: str
    viseme: int
    emotion: str
    triphone: tuple[str, str, str]
    start_frame: int
    stop_frame: int

    @property
    def n_frames(self) -> int:
        """Number of captured frames."""
        return self.stop_frame - self.start_frame


@dataclass(frozen=True)
class NodeTable:
    """All motion nodes of a database as columns, each of shape (n_nodes,).

    sentence : int32, row of the sentence
    order : int32, place among the sentence's phones that are not silence, from 0
    phoneme : uint8, index into `PHONEMES`; never silence
    emotion : uint8, index into `EMOTIONS`
    previous, following : uint8, phoneme index of the neighbours in the sentence, silence included
    start, stop : int64, frames of the database
    pre, suc : int32, rows of the captured predecessor and successor, `NIL` at a sentence's edge and beside a silence
    """

    sentence: np.ndarray
    order: np.ndarray
    phoneme: np.ndarray
    emotion: np.ndarray
    previous: np.ndarray
    following: np.ndarray
    start: np.ndarray
    stop: np.ndarray
    pre: np.ndarray
    suc: np.ndarray
    sentence_names: tuple[str, ...]

    COLUMNS: ClassVar = {
        "sentence": np.int32, "order": np.int32, "phoneme": np.uint8, "emotion": np.uint8, "previous": np.uint8,
        "following": np.uint8, "start": np.int64, "stop": np.int64, "pre": np.int32, "suc": np.int32,
    }  # fmt: skip

    def __len__(self) -> int:
        return len(self.phoneme)

    @property
    def viseme(self) -> np.ndarray:
        """Viseme class of each node, int, shape (n_nodes,)."""
        return np.asarray(VISEME_OF_PHONEME)[self.phoneme]

    @property
    def n_frames(self) -> np.ndarray:
        """Number of frames of each node, shape (n_nodes,)."""
        return self.stop - self.start

    @cached_property
    def context(self) -> np.ndarray:
        """Phones captured around each node, uint8, shape (2, `CONTEXT_REACH`, n_nodes): before, after; nearest first.

        From the first silence on, and beyond the sentence's edge, stands ``pau``.
        """
        pau = PHONEMES.index(PAU)
        around = np.full((2, CONTEXT_REACH, len(self)), pau, np.uint8)
        for side, (nearest, link) in enumerate(((self.previous, self.pre), (self.following, self.suc))):
            at = np.arange(len(self))
            for d in range(CONTEXT_REACH):
                known = at != NIL
                around[side, d, known] = nearest[at[known]]
                at = np.where(known, link[at], NIL)
        return around

    def name(self, row: int) -> str:
        """Return the public name, ``sentence:order``, which survives a database that grows."""
        return f"{self.sentence_names[self.sentence[row]]}:{self.order[row]}"

    def row(self, name: str) -> int:
        """Return the row of a public name; raises `UserFacingError` when there is none."""
        sentence, _, order = name.rpartition(":")
        if sentence in self.sentence_names and _ORDER.fullmatch(order):
            of_sentence = self.sentence == self.sentence_names.index(sentence)
            found = np.flatnonzero(of_sentence & (self.order == int(order)))
            if len(found):
                return int(found[0])
        raise UserFacingError(
            f"The database has no motion node '{name}'.",
            "A node is named sentence:order, as `efase synth --json` shows.",
        )

    def __getitem__(self, row: int) -> MotionNode:
        phone = PHONEMES[self.phoneme[row]]
        triphone = (PHONEMES[self.previous[row]], phone, PHONEMES[self.following[row]])
        return MotionNode(
            self.name(row), int(row), self.sentence_names[self.sentence[row]], int(self.order[row]), phone,
            int(self.viseme[row]), EMOTIONS[self.emotion[row]], triphone, int(self.start[row]), int(self.stop[row]),
        )  # fmt: skip


class NodeTableBuilder:
    """Cuts sentences into motion nodes, one sentence after the other."""

    def __init__(self) -> None:
        self._columns: dict[str, list[int]] = {name: [] for name in NodeTable.COLUMNS}
        self._names: list[str] = []

    def add_sentence(
        self,
        name: str,
        emotion: int,
        phones: list[int],
        start_frames: np.ndarray,
        stop_frames: np.ndarray,
        masked: np.ndarray,
        first_frame: int,
    ) -> int:
        """Add the nodes of one sentence and return how many were left out for want of good frames.

        Silence makes no node and breaks the pre/suc chain, and so does a phone of no frame or with a masked one.

        phones : phoneme indices, silence included
        start_frames, stop_frames : int, frames of the sentence, one pair a phone
        masked : bool, shape (n_frames of the sentence,)
        first_frame : where the sentence starts among the frames of the database
        """
        pau = PHONEMES.index(PAU)
        sentence = len(self._names)
        self._names.append(name)
        column = self._columns
        order, left_out, before = 0, 0, NIL
        for p, phone in enumerate(phones):
            start, stop = int(start_frames[p]), int(stop_frames[p])
            if phone == pau:
                before = NIL
                continue
            if stop <= start or masked[start:stop].any():
                left_out += 1
                order += 1
                before = NIL
                continue
            row = len(column["phoneme"])
            if before != NIL:
                column["suc"][before] = row
            values = (sentence, order, phone, emotion, phones[p - 1] if p else pau,
                      phones[p + 1] if p + 1 < len(phones) else pau, first_frame + start, first_frame + stop,
                      before, NIL)  # fmt: skip
            for key, value in zip(NodeTable.COLUMNS, values):
                column[key].append(value)
            before = row
            order += 1
        return left_out

    def table(self) -> NodeTable:
        """Return all nodes added so far."""
        columns = {name: np.array(self._columns[name], dtype) for name, dtype in NodeTable.COLUMNS.items()}
        return NodeTable(**columns, sentence_names=tuple(self._names))
