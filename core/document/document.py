"""The one document that panels look at and edits change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import ClassVar, Protocol

import numpy as np
from psygnal import Signal

from core.document.change import ANSWER, NOTHING, Change
from core.document.parts import (
    DEFAULT_FACE,
    DEFAULT_OUTPUT,
    AlignedSpeech,
    DatabaseReference,
    FaceChoice,
    OutputSettings,
    ReferenceVideo,
)
from core.motion.curation import Removal
from core.motion.database import MotionDatabase
from core.search.best_path import MotionPath
from core.search.weights import SearchWeights
from core.speech.emotion import EmotionModifier
from core.synthesis.control_edits import NO_CONTROL_EDITS, ControlEdits
from core.synthesis.engine import EngineAnswer, SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.polish import NO_POLISH, Polish
from core.synthesis.registry import DEFAULT_ENGINE, ENGINES, weights_of

EMPTY: Mapping = MappingProxyType({})


class Edit(Protocol):
    """One change that can undo itself; ``label`` stands in the menu."""

    label: str

    def do(self, document: Document) -> Change:
        """Change the document and say what of it."""

    def undo(self, document: Document) -> Change:
        """Take `do` back."""

    def followed_by(self, later: Edit) -> Edit | None:
        """Return the one edit that this and ``later``, of the same drag, make together; None when they are two."""


@dataclass(frozen=True, eq=False)
class ProjectState:
    """All that belongs to a project, as it is at one moment; see `Document` for what the names mean."""

    database: MotionDatabase | None = None
    database_reference: DatabaseReference | None = None
    speech: AlignedSpeech | None = None
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


class Document:
    """Speech, emotions, pins, database and face; and the motion that was found for them.

    Nothing here repairs anything else: only edits (see `core.document.edits`) write to it, and they say what changed.

    database, speech : None until they are opened
    database_reference : the database that the project asks for; it may be missing while ``database`` is None
    modifiers : emotion spans; one that covers all of the speech ends at infinity
    pins : slot to the public name of the motion node that is tied to it
    locks : slot to the public name of the node that was in use when its span was approved
    shared_removals : the database's own curation list, node to who removed it, when and why
    removed_here : nodes that only this project removes; kept : nodes that it uses although the list removes them
    engine : which engine makes the motion, by its name in `core.synthesis.registry.ENGINES`; one that is not there, of
        a newer workstation, is kept
    holds : whether engines that can keep dragged sounds at their middle
    weights : of the search; None for the database's own
    face : None for markers alone
    controls : the artist's layer over the control curves; polish : the layer over the motion that they make
    answer : what the engine made, or None; until a new one answers it may be the one from before an edit
    motion : the motion on show: that of ``answer`` under both layers, or None
    prices : float64, shape (n_slots, n_nodes), what forcing a node into a slot would add to the cost of ``answer``, in
        the unit of COST; None until they are known
    breakdown : cost of each slot of ``answer`` by term (`core.search.session.SearchSession.breakdown`), or None
    """

    changed: ClassVar[Signal] = Signal(object, object)

    def __init__(self, face: FaceChoice | None = DEFAULT_FACE) -> None:
        self.database: MotionDatabase | None = None
        self.database_reference: DatabaseReference | None = None
        self.speech: AlignedSpeech | None = None
        self.modifiers: tuple[EmotionModifier, ...] = ()
        self.pins: Mapping[int, str] = EMPTY
        self.locks: Mapping[int, str] = EMPTY
        self.shared_removals: Mapping[str, Removal] = EMPTY
        self.removed_here: Mapping[str, Removal] = EMPTY
        self.kept: frozenset[str] = frozenset()
        self.engine = DEFAULT_ENGINE
        self.holds = False
        self.weights: SearchWeights | None = None
        self.face = face
        self.reference_video: ReferenceVideo | None = None
        self.output = DEFAULT_OUTPUT
        self.controls = NO_CONTROL_EDITS
        self.polish = NO_POLISH
        self.answer: EngineAnswer | None = None
        self.motion: MarkerMotion | None = None
        self.prices: np.ndarray | None = None
        self.breakdown: Sequence[Mapping[str, float]] | None = None
        self._names: tuple[MotionDatabase | None, frozenset[str]] = (None, frozenset())

    # Changing

    def apply(self, edit: Edit, origin: object = None) -> None:
        """Do ``edit`` and tell the views once; ``origin`` is the view that already shows it."""
        self._tell(edit.do(self), origin)

    def revert(self, edit: Edit, origin: object = None) -> None:
        """Undo ``edit`` and tell the views once."""
        self._tell(edit.undo(self), origin)

    def show_answer(self, answer: EngineAnswer, motion: MarkerMotion) -> None:
        """Take what an engine made for the document as it is now, and its motion under both layers.

        Its prices are still to come.
        """
        if answer is not self.answer:
            self.answer, self.motion, self.prices, self.breakdown = answer, motion, None, None
            self._tell(Change.PATH | Change.MOTION | Change.PRICES, None)

    def show_motion(self, motion: MarkerMotion) -> None:
        """Take the motion of the same answer under other layers."""
        self.motion = motion
        self._tell(Change.MOTION, None)

    def forget_answer(self) -> None:
        """Show no motion; whoever asks tells the views."""
        self.answer = self.motion = self.prices = self.breakdown = None

    def show_prices(self, prices: np.ndarray | None, breakdown: Sequence[Mapping[str, float]] | None) -> None:
        """Take what the alternatives to the motion on show would cost, and what its slots cost by term."""
        self.prices, self.breakdown = prices, breakdown
        self._tell(Change.PRICES, None)

    def read_curation(self, shared: Mapping[str, Removal], origin: object = None) -> None:
        """Take the database's curation list as it stands on disk, where another window may have changed it."""
        if dict(shared) != dict(self.shared_removals):
            self.shared_removals = MappingProxyType(dict(shared))
            self._tell(Change.CURATION, origin)

    def load(self, state: ProjectState) -> None:
        """Take another project whole; there is no way back, so views and undo stack begin anew."""
        for part in fields(ProjectState):
            setattr(self, part.name, getattr(state, part.name))
        self.shared_removals = EMPTY
        self.forget_answer()
        everything = NOTHING
        for change in Change:
            everything |= change
        self._tell(everything, None)

    def take_database(self, database: MotionDatabase, shared: Mapping[str, Removal]) -> None:
        """Take the database that the project refers to, once it was found."""
        self.database, self.database_reference = database, DatabaseReference.to(database)
        self.shared_removals = MappingProxyType(dict(shared))
        self.forget_answer()
        self._tell(Change.NODES | Change.CLUSTERS | Change.CURATION | ANSWER, None)

    def state(self) -> ProjectState:
        """Return all that belongs to the project."""
        return ProjectState(**{part.name: getattr(self, part.name) for part in fields(ProjectState)})

    # Asking

    def speech_input(self) -> SpeechInput | None:
        """Return the question to the engine, frozen; None while there is no speech."""
        if self.speech is None:
            return None
        hard, removed = {**self.pins, **self.locks}, self.removed
        if self.database is not None:
            known = self.node_names
            hard = {slot: node for slot, node in hard.items() if node in known}
            removed = frozenset(node for node in removed if node in known)
        return SpeechInput(self.speech.transcript, self.modifiers, hard, removed, self.speech.audio, self.holds)

    @property
    def path(self) -> MotionPath | None:
        """The motion nodes that ``answer`` is made of, the best path where several were blended.

        None while there is no answer, and for an engine that takes no path through the database.
        """
        return getattr(self.answer, "path", None)

    @property
    def has_no_path(self) -> bool:
        """Whether the engine that is chosen takes no path through the database: no costs, prices, pins or weights."""
        return self.engine in ENGINES and not ENGINES[self.engine].searches

    @property
    def removed(self) -> frozenset[str]:
        """Public names of the motion nodes that must not be used."""
        return (frozenset(self.shared_removals) - self.kept) | frozenset(self.removed_here)

    @property
    def node_names(self) -> frozenset[str]:
        """Public names of all motion nodes of the database."""
        if self._names[0] is not self.database:
            nodes = self.database.nodes
            self._names = self.database, frozenset(nodes.name(row) for row in range(len(nodes)))
        return self._names[1]

    @property
    def unresolved(self) -> tuple[str, ...]:
        """Nodes that pins and locks name but the database does not have; they are kept, and tie nothing."""
        asked = {**self.pins, **self.locks}.values()
        return () if self.database is None else tuple(sorted(set(asked) - self.node_names))

    @property
    def search_weights(self) -> SearchWeights | None:
        """The weights that the search uses: the project's, else the database's, as the engine takes them."""
        return self.weights if self.database is None else weights_of(self.engine, self.database, self.weights)

    @property
    def cost_unit(self) -> float:
        """PNT, the unit in which costs are shown."""
        return 1.0 if self.search_weights is None else self.search_weights.pnt

    @property
    def next_best_prices(self) -> np.ndarray | None:
        """What the next best node of each slot would add; float64, shape (n_slots,); None until prices are known.

        Infinite for a slot that is pinned or locked.
        """
        if self.prices is None or self.path is None or self.prices.shape[1] < 2:
            return None
        others = self.prices.copy()
        others[range(len(others)), self.path.nodes] = np.inf
        return others.min(axis=1)

    def _tell(self, change: Change, origin: object) -> None:
        if change != NOTHING:
            self.changed.emit(change, origin)
