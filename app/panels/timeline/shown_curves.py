"""The control curves of the motion on show, found in the background while somebody looks at them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.authoring import Authoring
from app.texts import curves as texts
from core.animeme.animeme import AnimemeModel
from core.animeme.controls import ControlTrack
from core.animeme.ruling import Ruling, ruling_of
from core.document.change import Change
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.rig.control_layer import ControlBasis, control_basis, edited_curves, motion_curves
from core.speech.emotion import EmotionModifier
from core.speech.transcript import Transcript
from core.synthesis.control_edits import ControlEdits
from core.synthesis.marker_motion import MarkerMotion


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

    def span(self, control: str) -> tuple[float, float]:
        """Return the values between which a control is drawn."""
        if self.basis.has_units:
            return 0.0, 1.0
        values = np.stack([self.found.values, self.edited.values])[:, :, [self.found.names.index(n) for n in
                                                                        {control, *self.basis.shown}]]  # fmt: skip
        return float(values.min()), float(max(values.max(), values.min() + 1e-3))


@dataclass(frozen=True)
class _Request:
    motion: MarkerMotion
    database: MotionDatabase
    model: AnimemeModel | None
    transcript: Transcript
    modifiers: tuple[EmotionModifier, ...]


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
                               document.speech.transcript, document.modifiers)  # fmt: skip
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
        ruling = ruling_of(request.model, request.transcript, request.modifiers, found.rate_hz, len(found))
        alone = MarkerMotion(request.database.pca.positions(ruling.asked), found.rate_hz, request.motion.markers)
        ruling = replace(ruling, asked=basis.curves(alone, request.database).values)
    return FoundCurves(request.transcript, basis, found, ruling, ControlEdits())
