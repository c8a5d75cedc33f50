"""What an animator can change. Each wish becomes an edit on the undo stack; one that cannot be is one sentence."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from dataclasses import replace

from PySide6.QtCore import QObject
from PySide6.QtGui import QUndoStack

from app import texts
from app.looking import Looking
from app.undo import EditCommand
from core.document import transcript_edits
from core.document.curation_edits import RemoveMotionNodes, RestoreMotionNodes
from core.document.document import Edit
from core.document.edits import (
    LockSlots,
    PinMotionNode,
    SetControls,
    SetEmotion,
    SetEngine,
    SetHolds,
    SetOutput,
    SetPolish,
    SetReferenceVideo,
    SetWeights,
    UnlockSlots,
)
from core.document.parts import FaceChoice, ReferenceVideo
from core.errors import UserFacingError
from core.motion.curation import Removal
from core.search.weights import SearchWeights
from core.speech.emotion import EmotionModifier
from core.speech.emotion_painting import painted
from core.synthesis.control_edits import ControlEdits
from core.synthesis.polish import Polish

_gestures = itertools.count()


def new_gesture() -> int:
    """Return a number for one drag, from the press of the mouse to its release; see `core.document.edits`."""
    return next(_gestures)


class Editing(Looking):
    """The undo stack, and one method a wish."""

    def __init__(self, face: FaceChoice | None, parent: QObject | None = None) -> None:
        super().__init__(face, parent)
        self.undo_stack = QUndoStack(self)
        self.removes_only_here = False

    def push(self, edit: Edit, origin: object = None) -> None:
        """Do an edit that can be undone."""
        self.undo_stack.push(EditCommand(self.document, edit, origin))
        note = getattr(edit, "note", "")
        if note:
            self.noted.emit(note)

    def attempt(self, make: Callable[[], Edit]) -> bool:
        """Push what ``make`` returns, or say why there is no such edit."""
        try:
            edit = make()
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return False
        self.push(edit)
        return True

    # Emotions

    def set_emotion(
        self, modifiers: tuple[EmotionModifier, ...], label: str, origin: object = None, gesture: int | None = None
    ) -> None:
        """Replace the emotion spans."""
        if modifiers != self.document.modifiers:
            self.push(SetEmotion.on(self.document, modifiers, label, gesture), origin)

    def paint_emotion(self, start_s: float, end_s: float, emotion: str, intensity: float = 1.0) -> None:
        """Paint an emotion from ``start_s`` to ``end_s``; neutral erases."""
        modifiers = painted(self.document.modifiers, start_s, end_s, emotion, intensity)
        label = texts.EDIT_ERASE_EMOTION if emotion == "neutral" else texts.EDIT_PAINT.format(emotion=emotion)
        self.set_emotion(modifiers, label)

    # Phonemes

    def move_boundary(self, slot: int, time_s: float, gesture: int | None = None) -> None:
        """End a phoneme, and begin the next, at ``time_s``."""
        self.attempt(lambda: transcript_edits.MovePhonemeBoundary.on(self.document, slot, time_s, gesture))

    def rename_phoneme(self, slot: int, phone: str) -> bool:
        """Say that another phone is spoken in a slot; tells whether there is such a phone."""
        return self.attempt(lambda: transcript_edits.RenamePhoneme.on(self.document, slot, phone))

    def split_phoneme(self, slot: int, time_s: float | None = None) -> None:
        """Make two utterances of one."""
        self.attempt(lambda: transcript_edits.SplitPhoneme.on(self.document, slot, time_s))

    def merge_phoneme(self, slot: int) -> None:
        """Let a phoneme take over the time of the next one."""
        self.attempt(lambda: transcript_edits.MergePhonemes.on(self.document, slot))

    # Constraints

    def toggle_pin(self, node: str) -> None:
        """Tie ``node`` to the selected slot, or free the slot if it is tied to just that node."""
        slot = self.view.map_slot
        if self.document.has_no_path:
            self.failed.emit(texts.PIN_NEEDS_SEARCH, texts.CHOOSE_A_SEARCH)
            return
        if slot is None:
            self.noted.emit(texts.SELECT_TO_PIN.format(phone=self.view.map_phone))
            return
        pinned = self.document.pins.get(slot)
        self.attempt(lambda: PinMotionNode.on(self.document, slot, None if pinned == node else node))

    def unpin(self) -> None:
        """Free the selected slot."""
        slot = self.view.slot
        if slot is not None and slot in self.document.pins:
            self.push(PinMotionNode.on(self.document, slot, None))

    def lock(self) -> None:
        """Keep the selected utterances as they are."""
        if self.view.span is None:
            self.noted.emit(texts.SELECT_TO_LOCK)
            return
        first, last = self.view.span
        self.attempt(lambda: LockSlots.on(self.document, range(first, last + 1)))

    def unlock(self) -> None:
        """Let the search choose again in the selected utterances."""
        first, last = self.view.span or (0, -1)
        slots = [slot for slot in range(first, last + 1) if slot in self.document.locks]
        if slots:
            self.push(UnlockSlots.on(self.document, slots))

    # Polish

    def set_polish(self, polish: Polish, label: str, gesture: int | None = None) -> None:
        """Lay other gains over the motion."""
        if polish != self.document.polish:
            self.push(SetPolish.on(self.document, polish, label, gesture))

    # Control curves

    def set_controls(self, controls: ControlEdits, label: str, gesture: int | None = None) -> None:
        """Lay other edits over the control curves."""
        if controls != self.document.controls:
            self.push(SetControls.on(self.document, controls, label, gesture))

    # Motion nodes

    def remove_nodes(self, nodes: Iterable[str], why: str) -> None:
        """Let no search use these nodes any more; the database's own list remembers who said so, when and why."""
        nodes = tuple(nodes)
        if nodes:
            self.push(RemoveMotionNodes.on(self.document, nodes, Removal.now(why), self.removes_only_here))

    def restore_nodes(self, nodes: Iterable[str], only_here: bool = False) -> None:
        """Let the search use removed nodes again: in any project, or in this one only."""
        nodes = tuple(nodes)
        if nodes:
            self.push(RestoreMotionNodes.on(self.document, nodes, only_here or self.removes_only_here))

    # Engine and search

    def set_engine(self, name: str) -> None:
        """Let another engine make the motion, one of `core.synthesis.registry.ENGINES`."""
        if name != self.document.engine:
            self.attempt(lambda: SetEngine.on(self.document, name))

    def set_holds(self, holds: bool) -> None:
        """Keep dragged sounds at their middle, or let them fade."""
        if holds != self.document.holds:
            self.push(SetHolds.on(self.document, holds))

    def set_weights(self, weights: SearchWeights | None, label: str, gesture: int | None = None) -> None:
        """Search under other weights; None are the database's own."""
        if weights != self.document.weights:
            self.push(SetWeights.on(self.document, weights, label, gesture))

    # Output

    def set_reference_video(self, video: ReferenceVideo | None, gesture: int | None = None) -> None:
        """Show a film of the actor, or none."""
        self.push(SetReferenceVideo.on(self.document, video, gesture))

    def set_frame_rate(self, name: str) -> None:
        """Make films at another rate, one of `core.media.video.FRAME_RATES`."""
        self._set_output(texts.EDIT_FRAME_RATE.format(name=name), frame_rate=name)

    def set_start_frame(self, number: int) -> None:
        """Number the first frame of films."""
        self._set_output(texts.EDIT_START_FRAME.format(number=number), start_frame=number)

    def set_head_moves(self, moves: bool) -> None:
        """Let head and gaze move by themselves, or keep them still."""
        self._set_output(texts.EDIT_HEAD_MOVES if moves else texts.EDIT_HEAD_STILL, head_moves=moves)

    def _set_output(self, label: str, **change: object) -> None:
        output = replace(self.document.output, **change)
        if output != self.document.output:
            self.push(SetOutput.on(self.document, output, label))
