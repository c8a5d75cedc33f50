"""The edits: tiny frozen objects, each of which does and undoes one thing an animator can name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from core.document.change import NOTHING, Change
from core.document.document import AlignedSpeech, Document, FaceChoice
from core.motion.database import MotionDatabase
from core.speech.emotion import EmotionModifier

NO_PINS: Mapping[int, str] = MappingProxyType({})


@dataclass(frozen=True, eq=False)
class SetSpeech:
    """Take other speech, or the same with another transcript; pins belong to slots and go with the old one."""

    speech: AlignedSpeech
    before: AlignedSpeech | None
    pins_before: Mapping[int, str]
    label: str = "Choose speech"

    @classmethod
    def on(cls, document: Document, speech: AlignedSpeech, label: str = "Choose speech") -> SetSpeech:
        """Return the edit for ``document`` as it is now."""
        return cls(speech, document.speech, document.pins, label)

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.speech, NO_PINS)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.before, self.pins_before)

    def _set(self, document: Document, speech: AlignedSpeech | None, pins: Mapping[int, str]) -> Change:
        document.speech, document.pins, document.answer = speech, pins, None
        return Change.ALIGNMENT | Change.CONSTRAINTS | Change.PATH


@dataclass(frozen=True, eq=False)
class SetDatabase:
    """Search another motion database; pins name nodes of the old one and go with it."""

    database: MotionDatabase
    before: MotionDatabase | None
    pins_before: Mapping[int, str]
    label: str = "Open motion database"

    @classmethod
    def on(cls, document: Document, database: MotionDatabase) -> SetDatabase:
        """Return the edit for ``document`` as it is now."""
        return cls(database, document.database, document.pins)

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.database, NO_PINS)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.before, self.pins_before)

    def _set(self, document: Document, database: MotionDatabase | None, pins: Mapping[int, str]) -> Change:
        document.database, document.pins, document.answer = database, pins, None
        return Change.NODES | Change.CLUSTERS | Change.CONSTRAINTS | Change.PATH


@dataclass(frozen=True)
class SetEmotion:
    """Replace all emotion spans."""

    modifiers: tuple[EmotionModifier, ...]
    before: tuple[EmotionModifier, ...]
    label: str = "Set emotion"

    @classmethod
    def on(cls, document: Document, modifiers: tuple[EmotionModifier, ...], label: str) -> SetEmotion:
        """Return the edit for ``document`` as it is now."""
        return cls(modifiers, document.modifiers, label)

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.modifiers)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.before)

    def _set(self, document: Document, modifiers: tuple[EmotionModifier, ...]) -> Change:
        if document.modifiers == modifiers:
            return NOTHING
        document.modifiers = modifiers
        return Change.EMOTIONS


@dataclass(frozen=True)
class PinMotionNode:
    """Tie a motion node to a slot (a motion-node constraint); ``node`` None frees the slot."""

    slot: int
    node: str | None
    before: str | None

    @classmethod
    def on(cls, document: Document, slot: int, node: str | None) -> PinMotionNode:
        """Return the edit for ``document`` as it is now."""
        return cls(slot, node, document.pins.get(slot))

    @property
    def label(self) -> str:
        """What the menu says."""
        return f"Pin node {self.node}" if self.node is not None else f"Unpin node {self.before}"

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.node)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.before)

    def _set(self, document: Document, node: str | None) -> Change:
        if document.pins.get(self.slot) == node:
            return NOTHING
        pins = {slot: name for slot, name in document.pins.items() if slot != self.slot}
        if node is not None:
            pins[self.slot] = node
        document.pins = MappingProxyType(pins)
        return Change.CONSTRAINTS


@dataclass(frozen=True)
class SetFace:
    """Show another face, or markers alone."""

    face: FaceChoice | None
    before: FaceChoice | None
    label: str = "Choose face"

    @classmethod
    def on(cls, document: Document, face: FaceChoice | None) -> SetFace:
        """Return the edit for ``document`` as it is now."""
        return cls(face, document.face)

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.face)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.before)

    def _set(self, document: Document, face: FaceChoice | None) -> Change:
        if document.face == face:
            return NOTHING
        document.face = face
        return Change.FACE
