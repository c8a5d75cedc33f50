"""The control curves of the motion on show, found in the background while somebody looks at them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.authoring import Authoring
from app.texts import curves as texts
from core.animeme.animeme import AnimemeModel
from core.animeme.ruling import Ruling, ruling_of
from core.document.change import Change
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.rig.control_layer import ControlBasis, control_basis, edited_curves, motion_curves
from core.rig.control_track import ControlTrack
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript
from core.synthesis.control_edits import ControlEdits
from core.synthesis.marker_motion import MarkerMotion

LEAST_SHARE = 0.02


@dataclass(frozen=True, eq=False)
class FoundCurves:
    """Curves before and under the edits.

    ruling : who rules them, its ``asked`` in the controls of ``basis``; None for engines without dominance functions
    """

    transcript: Transcript
    basis: ControlBasis
    found: ControlTrack
    ruling: Ruling | None
    edits: ControlEdits

    @cached_property
    def edited(self) -> ControlTrack:
        """The curves under the edits."""
        return edited_curves(self.found, self.basis, self.edits)

    @cached_property
    def reigns(self) -> np.ndarray:
        """First frame in which each phoneme has a say worth drawing, and the one after the last; int, shape (J, 2)."""
        has_say = self.ruling.shares > LEAST_SHARE
        first, last = has_say.argmax(axis=1), has_say.shape[1] - has_say[:, ::-1].argmax(axis=1)
        return np.column_stack([first, np.where(has_say.any(axis=1), last, first)])

    @cached_property
    def _ranges(self) -> np.ndarray:
        both = np.concatenate([self.found.values, self.edited.values])
        return np.stack([both.min(axis=0), both.max(axis=0)])

    def span(self, control: str) -> tuple[float, float]:
        """Return the values between which a control is drawn."""
        if self.basis.has_units:
            return 0.0, 1.0
        lowest, highest = self._ranges[:, [self.found.names.index(name) for name in (control, *self.basis.shown)]]
        return float(lowest.min()), float(max(highest.max(), lowest.min() + 1e-3))


@dataclass(frozen=True)
class _Request:
    motion: MarkerMotion
    database: MotionDatabase
    model: AnimemeModel | None
    transcript: Transcript
    modifiers: tuple[EmotionModifier, ...]
    holds: bool


class ShownCurves(QObject):
    """Follows the document.

    curves : None while there are none, or nobody looks; trouble : why there are none, or ""
    changed : other curves, or other edits
    """

    changed = Signal()

    def __init__(self, authoring: Authoring, parent: QObject) -> None:
        super().__init__(parent)
        self._authoring = authoring
        self._is_wanted = False
        self._answer: object = None
        self.curves: FoundCurves | None = None
        self.trouble = ""
        authoring.document.changed.connect(self._on_document_changed)

    def want(self, wanted: bool) -> None:
        """Begin to look, or look no more."""
        self._is_wanted = wanted
        if wanted:
            self._find()

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        if change & (Change.PATH | Change.ALIGNMENT | Change.NODES) and self._is_wanted:
            self._find()
        elif change & Change.CONTROLS and self.curves is not None:
            self.curves = replace(self.curves, edits=self._authoring.document.controls)
            self.changed.emit()

    def _find(self) -> None:
        document, jobs = self._authoring.document, self._authoring.jobs
        answer = document.answer
        if answer is None or document.speech is None or document.database is None:
            jobs.cancel("controls")
            self._answer, self.curves, self.trouble = None, None, ""
            self.changed.emit()
        elif answer is not self._answer:
            self._answer = answer
            request = _Request(answer.motion, document.database, getattr(answer, "model", None),
                               document.speech.transcript, document.modifiers,
                               getattr(answer, "holds", False))  # fmt: skip
            jobs.start("controls", texts.FINDING, request, _found, self._on_found, self._on_failed)

    def _on_found(self, curves: FoundCurves) -> None:
        self.curves, self.trouble = replace(curves, edits=self._authoring.document.controls), ""
        self.changed.emit()

    def _on_failed(self, error: UserFacingError) -> None:
        self.curves, self.trouble = None, str(error)
        self.changed.emit()


def _found(request: _Request, progress: Progress) -> FoundCurves:
    basis = control_basis(request.database)
    progress.step(0.4)
    found = motion_curves(request.motion, request.database)
    progress.step(0.8)
    ruling = None
    if request.model is not None:
        ruling = ruling_of(
            request.model, request.transcript, request.modifiers, found.rate_hz, len(found), request.holds
        )
        alone = MarkerMotion(request.database.pca.positions(ruling.asked), found.rate_hz, request.motion.markers)
        ruling = replace(ruling, asked=basis.curves(alone, request.database).values)
    return FoundCurves(request.transcript, basis, found, ruling, ControlEdits())
