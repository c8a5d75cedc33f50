"""The poses that an artist works on: edits with undo, and the jobs that make some of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.jobs import JobRunner
from app.panels.poses.posing import PosedFace, Posing, lip_rows
from app.panels.poses.work import Guess, GuessRequest, find_keys, guess, open_rig, read_poses
from app.texts import poses as texts
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.synthesis.marker_motion import MarkerMotion

_MERGING = 1
_RESTS_WITHIN_MM = 0.2


class PosingDraft(QObject):
    """Every change replaces `posing` and can be taken back; a job that is cancelled or fails changes nothing.

    changed() : something else is to be shown
    failed(sentence, remedy), noted(sentence) : for the window's lines
    """

    changed = Signal()
    failed = Signal(str, str)
    noted = Signal(str)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.posing = Posing()
        self.undo_stack = QUndoStack(self)
        self._jobs = jobs
        jobs.failed.connect(self.failed)

    def show(self, posing: Posing) -> None:
        """Take other poses; without undo, for the commands on the stack."""
        self.posing = posing
        self.changed.emit()

    def _push(self, posing: Posing, text: str, gesture: tuple[int, str] | None = None) -> None:
        self.undo_stack.push(_Replace(self, posing, text, gesture))

    # The rig

    def open_rig(self, name: str) -> None:
        """Pose another rig, see `core.rig.rig_files.load_rig`; the shapes stay, and controls go over by name."""
        self._jobs.start("rig", texts.OPENING_RIG, name, open_rig, self._on_rig, self._on_failed)

    def _on_rig(self, face: PosedFace) -> None:
        if self.posing.face is None:  # nothing to take back
            self.show(self.posing.on(face))
        else:
            self._push(self.posing.on(face), texts.EDIT_RIG.format(rig=face.face.name))

    def _on_failed(self, error: UserFacingError) -> None:
        self.failed.emit(error.message, error.remedy)
        self.changed.emit()  # what was asked for is not what is shown

    # The shapes

    def find(self, database: MotionDatabase | None, n_keys: int) -> None:
        """Choose key lip shapes among the captures, in place of those in the list."""
        if database is None:
            self.failed.emit(texts.NEEDS_DATABASE, texts.OPEN_ONE)
            return

        def found(answer: tuple[Posing, str]) -> None:
            posing, trouble = answer
            self._push(posing.on(self.posing.face), texts.EDIT_FIND)
            self.noted.emit(trouble)

        self._jobs.start("keys", texts.FINDING, (self.posing.face, database, n_keys), find_keys, found)

    def add(self, motion: MarkerMotion | None, at_s: float) -> None:
        """Take one frame of a motion as a key lip shape."""
        if motion is None:
            self.failed.emit(texts.NEEDS_MOTION, texts.MAKE_MOTION)
            return
        markers = motion.markers
        names = tuple(markers.groups.get("lips", ())) if self.posing.poses is None else self.posing.poses.markers
        rows = lip_rows(markers, names)
        if not names:
            self.failed.emit(texts.NO_LIPS, "")
            return
        if rows is None:
            self.failed.emit(texts.OTHER_MARKERS, texts.START_ANEW)
            return
        frame = motion.displacements[min(round(at_s * motion.rate_hz), len(motion.positions) - 1)]
        if np.abs(frame[rows]).max() < _RESTS_WITHIN_MM:
            self.failed.emit(texts.AT_REST, "")
            return

        def guessed(answer: Guess) -> None:
            added = Posing(poses=answer.poses).on(self.posing.face).poses  # which may be another by now
            self._push(self.posing.with_added(added, frame), texts.EDIT_ADD)
            self.noted.emit(answer.trouble)

        request = GuessRequest(self.posing.face, markers, rows, frame[None, rows].astype(float))
        self._jobs.start("guess", texts.GUESSING, request, guess, guessed)

    def remove(self, row: int) -> None:
        """Take a shape out of the list."""
        self._push(self.posing.without(row), texts.EDIT_REMOVE.format(name=self.posing.keys[row]))

    def rename(self, row: int, name: str) -> None:
        """Give a shape another name; one that is taken is refused."""
        before = self.posing.keys[row]
        if name in self.posing.keys and name != before:
            self.failed.emit(texts.NAME_TAKEN.format(name=name[:40]), "")
        elif name and name != before:
            self._push(self.posing.renamed(row, name), texts.EDIT_RENAME.format(name=before))
            return
        self.changed.emit()

    # The poses

    def set_control(self, row: int, name: str, value: float, gesture: int | None = None) -> None:
        """Move one control of a pose; moves of one ``gesture`` are one entry of undo."""
        values = self.posing.poses.values[row].copy()
        values[self.posing.poses.controls.index(name)] = value
        merging = None if gesture is None else (gesture, name)
        self._push(self.posing.with_values(row, values), texts.EDIT_CONTROL.format(control=name), merging)

    def reset(self, row: int) -> None:
        """Put all controls of a pose to rest."""
        name = self.posing.keys[row]
        if self.posing.poses.values[row].any():
            at_rest = np.zeros(len(self.posing.poses.controls))
            self._push(self.posing.with_values(row, at_rest), texts.EDIT_RESET.format(name=name))

    def guess(self, row: int, markers: MarkerSet | None) -> None:
        """Pose one shape as near to the captured lips as controls allow."""
        poses, face = self.posing.poses, self.posing.face
        rows = None if markers is None else lip_rows(markers, poses.markers)
        if rows is None:
            self.failed.emit(texts.NO_DATABASE, "")
            return
        name = poses.keys[row]

        def guessed(answer: Guess) -> None:
            same = self.posing.face is face and name in self.posing.keys
            if answer.trouble:
                self.noted.emit(answer.trouble)
            elif same:
                now = self.posing.keys.index(name)
                self._push(self.posing.with_values(now, answer.poses.values[0]), texts.EDIT_GUESS.format(name=name))

        request = GuessRequest(face, markers, rows, poses.lips_mm[[row]])
        self._jobs.start("guess", texts.GUESSING, request, guess, guessed)

    # Files

    def load(self, path: Path, database: MotionDatabase | None) -> None:
        """Go on with poses in a file, on the character that they were made for."""

        def loaded(posing: Posing) -> None:
            self._push(posing, texts.EDIT_LOAD)
            self.undo_stack.setClean()
            self.noted.emit(texts.LOADED.format(path=path))

        self._jobs.start("poses", texts.READING, (path, self.posing.face, database), read_poses, loaded)

    def save(self, path: Path) -> None:
        """Write the poses; see `core.rig.key_poses.KeyPoses.save`."""
        try:
            self.posing.poses.save(path)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self.undo_stack.setClean()
        self.noted.emit(texts.SAVED.format(path=path, rig=self.posing.poses.rig))


class _Replace(QUndoCommand):
    """Other poses, as a whole; those of one drag are one."""

    def __init__(self, draft: PosingDraft, after: Posing, text: str, gesture: tuple[int, str] | None) -> None:
        super().__init__(text)
        self._draft, self._before, self._after, self._gesture = draft, draft.posing, after, gesture

    def redo(self) -> None:
        """Do it."""
        self._draft.show(self._after)

    def undo(self) -> None:
        """Take it back."""
        self._draft.show(self._before)

    def id(self) -> int:
        """Let Qt try to merge."""
        return _MERGING

    def mergeWith(self, other: QUndoCommand) -> bool:
        """Take in the next move of the same drag."""
        if self._gesture is None or other._gesture != self._gesture:
            return False
        self._after = other._after
        return True
