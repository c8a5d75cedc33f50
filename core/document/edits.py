"""The edits: tiny frozen objects, each of which does and undoes one thing an animator can name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from types import MappingProxyType
from typing import Any, Self

from core.document.change import ANSWER, NOTHING, Change
from core.document.document import EMPTY, Document, ProjectState
from core.document.parts import AlignedSpeech, DatabaseReference, FaceChoice, OutputSettings, ReferenceVideo
from core.errors import UserFacingError
from core.motion.curation import Removal
from core.motion.database import MotionDatabase
from core.search.weights import SearchWeights
from core.speech.emotion import EmotionModifier
from core.synthesis.control_edits import ControlEdits
from core.synthesis.polish import Polish
from core.synthesis.registry import engine_kind

# Two of these are the same only if they are one object; to compare their arrays would take long.
_BY_IDENTITY = ("database", "speech")


@dataclass(frozen=True, eq=False)
class FieldEdit:
    """An edit that sets some fields of the document.

    label : what the menu says; change : what of the document it is about
    after, before : field to value
    gesture : number of the drag that it belongs to, or None; edits of one drag become one entry of the menu
    note : a sentence about what had to go with it, for the status bar
    """

    label: str
    change: Change
    after: Mapping[str, Any]
    before: Mapping[str, Any]
    gesture: int | None = field(default=None, kw_only=True)
    note: str = field(default="", kw_only=True)

    @classmethod
    def setting(
        cls, document: Document, label: str, change: Change, *, gesture: int | None = None, note: str = "", **after: Any
    ) -> Self:
        """Return the edit that sets the fields ``after`` of ``document`` as it is now."""
        before = {name: getattr(document, name) for name in after}
        return cls(label, change, after, before, gesture=gesture, note=note)

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.after)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, self.before)

    def followed_by(self, later: FieldEdit) -> FieldEdit | None:
        """See `core.document.document.Edit`."""
        if type(self) is not type(later) or self.gesture is None or self.gesture != later.gesture:
            return None
        before = {**later.before, **self.before}
        note = later.note or self.note
        return replace(self, after={**self.after, **later.after}, before=before, note=note, label=later.label,
                       change=self.change | later.change)  # fmt: skip

    def _set(self, document: Document, values: Mapping[str, Any]) -> Change:
        if all(_same(name, getattr(document, name), value) for name, value in values.items()):
            return NOTHING
        n_slots = _n_slots(document)
        for name, value in values.items():
            setattr(document, name, value)
        # with as many slots, the motion from before may be looked at until the search answers
        if self.change & (Change.SPEECH | Change.NODES) or _n_slots(document) != n_slots:
            document.forget_answer()
            return self.change | ANSWER
        return self.change


def _same(name: str, one: object, other: object) -> bool:
    return one is other or (name not in _BY_IDENTITY and one == other)


def _n_slots(document: Document) -> int | None:
    return None if document.speech is None else len(document.speech.transcript.phonemes)


class SetSpeech(FieldEdit):
    """Take other speech, or the same with another transcript; pins and locks belong to slots and go with the old."""

    @classmethod
    def on(cls, document: Document, speech: AlignedSpeech, label: str = "Choose speech") -> SetSpeech:
        """Return the edit for ``document`` as it is now."""
        same_sound = document.speech is not None and document.speech.audio is speech.audio
        change = Change.ALIGNMENT | Change.CONSTRAINTS | (NOTHING if same_sound else Change.SPEECH)
        return cls.setting(document, label, change, speech=speech, pins=EMPTY, locks=EMPTY)


class SetDatabase(FieldEdit):
    """Search another motion database. Pins and locks stay: they name nodes as ``sentence:order``.

    Those that the other database does not have tie nothing as long as it is open.
    """

    @classmethod
    def on(cls, document: Document, database: MotionDatabase, shared: Mapping[str, Removal] = EMPTY) -> SetDatabase:
        """Return the edit for ``document`` as it is now; ``shared`` is the database's own curation list."""
        change = Change.NODES | Change.CLUSTERS | Change.CURATION | Change.CONSTRAINTS
        reference = DatabaseReference.to(database)
        return cls.setting(document, "Open motion database", change, database=database,
                           database_reference=reference, shared_removals=MappingProxyType(dict(shared)))  # fmt: skip


class SetEmotion(FieldEdit):
    """Replace all emotion spans; see `core.speech.emotion_painting` for what a brush makes of them."""

    @classmethod
    def on(
        cls, document: Document, modifiers: tuple[EmotionModifier, ...], label: str, gesture: int | None = None
    ) -> SetEmotion:
        """Return the edit for ``document`` as it is now."""
        return cls.setting(document, label, Change.EMOTIONS, gesture=gesture, modifiers=tuple(modifiers))


class PinMotionNode(FieldEdit):
    """Tie a motion node to a slot (a motion-node constraint); ``node`` None frees the slot."""

    @classmethod
    def on(cls, document: Document, slot: int, node: str | None) -> PinMotionNode:
        """Return the edit for ``document`` as it is now; raises `UserFacingError` for a slot that is locked."""
        if slot in document.locks and node not in (None, document.locks[slot]):
            raise UserFacingError(f"Slot {slot} is locked to the node {document.locks[slot]}.", "Unlock it first.")
        pins = {p: name for p, name in document.pins.items() if p != slot}
        if node is not None:
            pins[slot] = node
        label = f"Pin node {node}" if node is not None else f"Unpin node {document.pins.get(slot)}"
        return cls.setting(document, label, Change.CONSTRAINTS, pins=MappingProxyType(pins))


class LockSlots(FieldEdit):
    """Keep slots as they are: tie each to the motion node that it uses now (hard), so that no later edit moves it."""

    @classmethod
    def on(cls, document: Document, slots: Iterable[int]) -> LockSlots:
        """Return the edit for ``document`` as it is now; raises `UserFacingError` while there is no motion to keep."""
        slots = sorted(set(slots))
        if document.answer is None or document.database is None:
            raise UserFacingError("There is no motion to lock yet.", "Synthesise first (Ctrl+Return).")
        if document.path is None:
            raise UserFacingError("The motion on show is no path of motion nodes.", "Choose a search as the engine.")
        used = document.path.nodes
        names = {slot: document.database.nodes.name(used[slot]) for slot in slots if 0 <= slot < len(used)}
        locks = MappingProxyType({**document.locks, **names})
        return cls.setting(document, f"Lock {_slots_in_words(document, slots)}", Change.CONSTRAINTS, locks=locks)


class UnlockSlots(FieldEdit):
    """Let the search choose again in slots that were locked."""

    @classmethod
    def on(cls, document: Document, slots: Iterable[int]) -> UnlockSlots:
        """Return the edit for ``document`` as it is now."""
        slots = sorted(set(slots))
        locks = MappingProxyType({slot: node for slot, node in document.locks.items() if slot not in slots})
        return cls.setting(document, f"Unlock {_slots_in_words(document, slots)}", Change.CONSTRAINTS, locks=locks)


def _slots_in_words(document: Document, slots: list[int]) -> str:
    phones = document.speech.transcript.phones if document.speech is not None else ()
    return " ".join(f"/{phones[slot]}/" for slot in slots[:4] if slot < len(phones)) + (" …" if len(slots) > 4 else "")


class SetFace(FieldEdit):
    """Show another face, or markers alone."""

    @classmethod
    def on(cls, document: Document, face: FaceChoice | None) -> SetFace:
        """Return the edit for ``document`` as it is now."""
        return cls.setting(document, "Choose face", Change.FACE, face=face)


class SetWeights(FieldEdit):
    """Search under other weights; None are the database's own."""

    @classmethod
    def on(
        cls, document: Document, weights: SearchWeights | None, label: str, gesture: int | None = None
    ) -> SetWeights:
        """Return the edit for ``document`` as it is now."""
        return cls.setting(document, label, Change.WEIGHTS, gesture=gesture, weights=weights)


class SetEngine(FieldEdit):
    """Let another engine make the motion, one of `core.synthesis.registry.ENGINES`."""

    @classmethod
    def on(cls, document: Document, engine: str) -> SetEngine:
        """Return the edit for ``document`` as it is now; raises `UserFacingError` for an engine that there is not."""
        return cls.setting(document, f"Choose engine “{engine_kind(engine).title}”", Change.ENGINE, engine=engine)


class SetHolds(FieldEdit):
    """Keep dragged sounds at their middle, or let them fade; engines that cannot keep them do not mind."""

    @classmethod
    def on(cls, document: Document, holds: bool) -> SetHolds:
        """Return the edit for ``document`` as it is now."""
        label = "Hold long sounds" if holds else "Let long sounds fade"
        return cls.setting(document, label, Change.ENGINE, holds=holds)


class SetReferenceVideo(FieldEdit):
    """Show another film of the actor, none, or the same at another offset."""

    @classmethod
    def on(cls, document: Document, video: ReferenceVideo | None, gesture: int | None = None) -> SetReferenceVideo:
        """Return the edit for ``document`` as it is now."""
        before = document.reference_video
        moved = video is not None and before is not None and video.path == before.path
        label = "Move reference video" if moved else "Choose reference video"
        return cls.setting(document, label, Change.REFERENCE_VIDEO, gesture=gesture, reference_video=video)


class SetOutput(FieldEdit):
    """Make films at another rate, from another first frame, or with the head still."""

    @classmethod
    def on(cls, document: Document, output: OutputSettings, label: str = "Set frame rate") -> SetOutput:
        """Return the edit for ``document`` as it is now."""
        return cls.setting(document, label, Change.OUTPUT, output=output)


class SetPolish(FieldEdit):
    """Lay other gains over the motion; those of one drag become one edit."""

    @classmethod
    def on(cls, document: Document, polish: Polish, label: str, gesture: int | None = None) -> SetPolish:
        """Return the edit for ``document`` as it is now."""
        return cls.setting(document, label, Change.POLISH, gesture=gesture, polish=polish)


class SetControls(FieldEdit):
    """Lay other keys, smoothings and mutings over the control curves; those of one drag become one edit."""

    @classmethod
    def on(cls, document: Document, controls: ControlEdits, label: str, gesture: int | None = None) -> SetControls:
        """Return the edit for ``document`` as it is now."""
        return cls.setting(document, label, Change.CONTROLS, gesture=gesture, controls=controls)


class RestoreVersion(FieldEdit):
    """Make the project what it was in a named version; nothing is lost, for it undoes."""

    CHANGES = MappingProxyType({
        "speech": Change.SPEECH | Change.ALIGNMENT, "database": Change.NODES | Change.CLUSTERS,
        "database_reference": Change.NODES | Change.CLUSTERS, "modifiers": Change.EMOTIONS, "pins": Change.CONSTRAINTS,
        "locks": Change.CONSTRAINTS, "removed_here": Change.CURATION, "kept": Change.CURATION,
        "engine": Change.ENGINE, "holds": Change.ENGINE, "weights": Change.WEIGHTS, "face": Change.FACE,
        "reference_video": Change.REFERENCE_VIDEO, "output": Change.OUTPUT, "polish": Change.POLISH,
        "controls": Change.CONTROLS,
    })  # fmt: skip

    @classmethod
    def on(cls, document: Document, state: ProjectState, name: str, gesture: int | None = None) -> RestoreVersion:
        """Return the edit for ``document`` as it is now."""
        after, change = {}, NOTHING
        for part in fields(ProjectState):
            now, then = getattr(document, part.name), getattr(state, part.name)
            if not _same(part.name, now, then):
                after[part.name] = then
                change |= cls.CHANGES[part.name]
        if "speech" in after and document.speech is not None and state.speech is not None:
            change &= ~Change.SPEECH if document.speech.audio is state.speech.audio else ~NOTHING
        return cls.setting(document, f"Switch to version “{name}”", change, gesture=gesture, **after)
