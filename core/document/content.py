"""A project as plain values: what goes into its file, and what is believed when it comes out of one."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from types import MappingProxyType
from typing import Any

from core.document import content_checks as door
from core.document.content_checks import Unbelievable
from core.document.document import EMPTY, Document, ProjectState
from core.document.parts import (
    DEFAULT_FACE,
    DEFAULT_OUTPUT,
    DatabaseReference,
    FaceChoice,
    OutputSettings,
    ReferenceVideo,
    SoundReference,
    Speech,
    View,
)
from core.document.pins_met import NodeContent
from core.document.view_state import ViewState
from core.errors import UserFacingError
from core.media.audio import Audio
from core.motion.curation import Removal
from core.motion.database import MotionDatabase
from core.search.weights import SearchWeights
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript
from core.synthesis.control_edits import NO_CONTROL_EDITS, ControlEdits
from core.synthesis.polish import NO_POLISH, Polish
from core.synthesis.registry import DEFAULT_ENGINE


@dataclass(frozen=True)
class ProjectContent:
    """All of a project but its sound; see `core.document.document.Document` for the names.

    tied : what the nodes of pins and locks held when they were last seen, by name; see `core.document.pins_met`
    others : what a newer minor version wrote and this one does not know; it is kept
    """

    sound: SoundReference | None = None
    transcript: Transcript | None = None
    text: str = ""
    modifiers: tuple[EmotionModifier, ...] = ()
    pins: Mapping[int, str] = field(default_factory=lambda: EMPTY)
    locks: Mapping[int, str] = field(default_factory=lambda: EMPTY)
    removed_here: Mapping[str, Removal] = field(default_factory=lambda: EMPTY)
    kept: frozenset[str] = frozenset()
    engine: str = DEFAULT_ENGINE
    holds: bool = False
    weights: SearchWeights | None = None
    face: FaceChoice | None = DEFAULT_FACE
    reference_video: ReferenceVideo | None = None
    output: OutputSettings = DEFAULT_OUTPUT
    controls: ControlEdits = NO_CONTROL_EDITS
    polish: Polish = NO_POLISH
    database: DatabaseReference | None = None
    tied: Mapping[str, NodeContent] = field(default_factory=lambda: EMPTY)
    view: View = field(default_factory=View)
    others: Mapping[str, Any] = field(default_factory=lambda: EMPTY)

    @classmethod
    def of(
        cls,
        document: Document,
        view: ViewState | None = None,
        others: Mapping[str, Any] = EMPTY,
        tied: Mapping[str, NodeContent] = EMPTY,
    ) -> ProjectContent:
        """Return what ``document`` holds now; ``tied`` is what was known before of nodes that its database lacks."""
        speech = document.speech
        path = None if speech is None or speech.audio.path is None else str(speech.audio.path)
        return cls(
            sound=None if speech is None else SoundReference(speech.audio.digest, path),
            transcript=None if speech is None else speech.transcript,
            text="" if speech is None else speech.text,
            modifiers=document.modifiers, pins=document.pins, locks=document.locks,
            removed_here=document.removed_here, kept=document.kept, engine=document.engine,
            holds=document.holds, weights=document.weights, face=document.face,
            reference_video=document.reference_video, output=document.output, polish=document.polish,
            controls=document.controls,
            database=document.database_reference, tied=_tied(document, tied),
            view=View() if view is None else View(view.slot, view.playhead_s, view.map_phone), others=others,
        )  # fmt: skip

    def state(self, audio: Audio | None, database: MotionDatabase | None) -> ProjectState:
        """Return what a document takes, with the sound and the database (None: it is missing) that are referred to."""
        speech = None
        if audio is not None and self.transcript is not None:
            speech = Speech(audio, self.transcript, self.text)
        return ProjectState(
            database=database, database_reference=self.database, speech=speech, modifiers=self.modifiers,
            pins=self.pins, locks=self.locks, removed_here=self.removed_here, kept=self.kept, engine=self.engine,
            holds=self.holds, weights=self.weights, face=self.face, reference_video=self.reference_video,
            output=self.output, polish=self.polish, controls=self.controls,
        )  # fmt: skip

    def to_json(self) -> str:
        """Return it as a project file keeps it."""
        transcript = self.transcript
        return json.dumps({
            **self.others,
            "sound": None if self.sound is None else asdict(self.sound),
            "transcript": None if transcript is None else {
                "duration_s": transcript.duration_s, "warnings": transcript.warnings,
                "phonemes": [[u.phone, u.start_s, u.end_s] for u in transcript.phonemes],
                "words": [[w.word, w.start_s, w.end_s] for w in transcript.words],
            },
            "text": self.text,
            # JSON has no infinity: a span without an end covers all of the speech
            "emotions": [[m.start_s, m.end_s if math.isfinite(m.end_s) else None, m.emotion, m.intensity]
                         for m in self.modifiers],
            "pins": sorted(self.pins.items()), "locks": sorted(self.locks.items()),
            "removed_here": {node: asdict(removal) for node, removal in sorted(self.removed_here.items())},
            "kept": sorted(self.kept),
            "engine": self.engine,
            "holds": self.holds,
            "weights": None if self.weights is None else self.weights.as_dict(),
            "face": None if self.face is None else asdict(self.face),
            "reference_video": None if self.reference_video is None else asdict(self.reference_video),
            "output": asdict(self.output),
            "polish": {"articulation": self.polish.articulation, "expression": self.polish.expression,
                       "curves": {region: list(keys) for region, keys in sorted(self.polish.curves.items())}},
            "controls": {name: {"keys": [[key.time_s, key.amount, key.reach_s] for key in edits.keys],
                                "smoothed": list(edits.smoothed), "is_muted": edits.is_muted}
                         for name, edits in sorted(self.controls.by_control.items())},
            "database": None if self.database is None else asdict(self.database),
            "tied": {name: asdict(node) for name, node in sorted(self.tied.items())},
            "view": asdict(self.view),
        }, allow_nan=False)  # fmt: skip

    @classmethod
    def from_json(cls, text: str) -> ProjectContent:
        """Inverse of `to_json`; what an older minor version did not know takes its default.

        Raises `Unbelievable` for what cannot be: a phone that does not exist, times that run backwards, absurd numbers.
        """
        try:
            entries = json.loads(text, parse_constant=door.no_constant)
            return cls._believed(door.of_type(entries, dict))
        except (KeyError, TypeError, ValueError, RecursionError, OverflowError, UserFacingError) as error:
            if isinstance(error, Unbelievable):
                raise
            raise Unbelievable(f"an entry is not what it should be: {type(error).__name__}") from error

    @classmethod
    def _believed(cls, entries: dict[str, Any]) -> ProjectContent:
        transcript = door.optional(entries.pop("transcript", None), door.transcript)
        sound = door.optional(
            entries.pop("sound", None),
            lambda e: SoundReference(door.digest(e["digest"]), door.optional(e.get("path"), door.name_text)),
        )
        door.require((transcript is None) == (sound is None), "it has sound or words alone")
        n_slots = 0 if transcript is None else len(transcript.phonemes)
        return cls(
            sound=sound,
            transcript=transcript,
            text=door.text(entries.pop("text", "")),
            modifiers=tuple(door.modifier(e) for e in door.listed(entries.pop("emotions", []), door.MOST_SPANS)),
            pins=door.ties(entries.pop("pins", []), n_slots),
            locks=door.ties(entries.pop("locks", []), n_slots),
            removed_here=door.removals(entries.pop("removed_here", {})),
            kept=frozenset(door.name_text(node) for node in door.listed(entries.pop("kept", []), door.MOST_NODES)),
            engine=door.name_text(entries.pop("engine", DEFAULT_ENGINE)),
            holds=door.of_type(entries.pop("holds", False), bool),
            weights=door.optional(entries.pop("weights", None), SearchWeights.from_dict),
            face=door.optional(entries.pop("face", asdict(DEFAULT_FACE)), lambda e: FaceChoice(
                door.name_text(e["name"]), door.optional(e.get("marker_file"), door.name_text))),
            reference_video=door.optional(entries.pop("reference_video", None), lambda e: ReferenceVideo(
                door.name_text(e["path"]), door.number(e["offset_s"], -door.FARTHEST_S, door.FARTHEST_S))),
            output=door.output_settings(entries.pop("output", {})),
            controls=door.control_edits(entries.pop("controls", {})),
            polish=door.polish(entries.pop("polish", {})),
            database=door.optional(entries.pop("database", None), lambda e: DatabaseReference(
                *(door.name_text(e[key]) for key in ("name", "content_hash")),
                door.optional(e.get("path"), door.name_text))),
            tied=door.tied(entries.pop("tied", {})),
            view=door.view_entry(entries.pop("view", {}), n_slots),
            others=MappingProxyType(entries),
        )  # fmt: skip


def _tied(document: Document, before: Mapping[str, NodeContent]) -> Mapping[str, NodeContent]:
    database, names = document.database, {*document.pins.values(), *document.locks.values()}
    here = names & document.node_names if database is not None and names else frozenset()
    tied = {name: node for name, node in before.items() if name in names}
    return MappingProxyType({**tied, **{name: NodeContent.of(database, name) for name in here}})
