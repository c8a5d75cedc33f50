"""The one document that panels look at and edits change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, Protocol

from psygnal import Signal

from core.document.change import NOTHING, Change
from core.media.audio import Audio
from core.motion.database import MotionDatabase
from core.search.engine import SearchAnswer
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript
from core.synthesis.engine import SpeechInput


class AlignedSpeech(Protocol):
    """Sound, what is said in it, and when."""

    audio: Audio
    transcript: Transcript
    text: str


@dataclass(frozen=True)
class FaceChoice:
    """A face by name: ``default``, or the path of a mesh, with the marker file that tells where its markers sit."""

    name: str
    marker_file: str | None = None


DEFAULT_FACE = FaceChoice("default")


class Edit(Protocol):
    """One change that can undo itself; ``label`` stands in the menu."""

    label: str

    def do(self, document: Document) -> Change:
        """Change the document and say what of it."""

    def undo(self, document: Document) -> Change:
        """Take `do` back."""


class Document:
    """Speech, emotions, pins, database and face; and the motion that was found for them.

    Nothing here repairs anything else: only edits (see `core.document.edits`) write to it, and they say what changed.

    database, speech : None until they are opened
    modifiers : emotion spans; one that covers all of the speech ends at infinity
    pins : slot to the public name of the motion node that is tied to it
    removed : public names of motion nodes that must not be used
    face : None for markers alone
    answer : the motion that is shown, or None; until a new search answers it may be the one from before an edit
    """

    changed: ClassVar[Signal] = Signal(object, object)

    def __init__(self, face: FaceChoice | None = DEFAULT_FACE) -> None:
        self.database: MotionDatabase | None = None
        self.speech: AlignedSpeech | None = None
        self.modifiers: tuple[EmotionModifier, ...] = ()
        self.pins: Mapping[int, str] = MappingProxyType({})
        self.removed: frozenset[str] = frozenset()
        self.face = face
        self.answer: SearchAnswer | None = None

    def apply(self, edit: Edit, origin: object = None) -> None:
        """Do ``edit`` and tell the views once; ``origin`` is the view that already shows it."""
        self._tell(edit.do(self), origin)

    def revert(self, edit: Edit, origin: object = None) -> None:
        """Undo ``edit`` and tell the views once."""
        self._tell(edit.undo(self), origin)

    def show_answer(self, answer: SearchAnswer | None, origin: object = None) -> None:
        """Take what a search found for the document as it is now."""
        if answer is not self.answer:
            self.answer = answer
            self._tell(Change.PATH, origin)

    def speech_input(self) -> SpeechInput | None:
        """Return the question to the search, frozen; None while there is no speech."""
        if self.speech is None:
            return None
        return SpeechInput(self.speech.transcript, self.modifiers, dict(self.pins), self.removed)

    def _tell(self, change: Change, origin: object) -> None:
        if change != NOTHING:
            self.changed.emit(change, origin)
