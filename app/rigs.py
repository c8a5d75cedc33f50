"""Faces that follow the markers of the open database, fitted in the background."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Signal

from app import texts
from app.jobs import JobRunner
from app.loading import fit_face
from app.pictures import FaceRig
from core.document.change import Change
from core.document.document import Document
from core.document.parts import FaceChoice
from core.errors import UserFacingError


class Rigs(QObject):
    """Keeps `rig` what the document's face and database ask for.

    changed() : another face, or none, is to be drawn
    failed(sentence, remedy) : a face does not fit
    """

    changed = Signal()
    failed = Signal(str, str)

    def __init__(self, document: Document, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.rig: FaceRig | None = None
        self._document, self._jobs = document, jobs
        # by content of the database, so that undo need not fit again
        self._fitted: dict[tuple[FaceChoice, str], FaceRig] = {}
        document.changed.connect(self._on_document_changed)

    def try_on(self, face: FaceChoice | None, then: Callable[[], None]) -> None:
        """Call ``then`` once ``face`` is known to fit; one that does not is told, and nothing more."""
        database = self._document.database
        if face is None or database is None or (face, database.content_hash) in self._fitted:
            then()
            return

        def fitted(rig: FaceRig) -> None:
            self._fitted[face, database.content_hash] = rig
            then()

        self._jobs.start("face", texts.FITTING_FACE, (face, database.markers), fit_face, fitted)

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        if not change & (Change.FACE | Change.NODES):
            return
        database, face = self._document.database, self._document.face
        self._jobs.cancel("face")
        if database is None or face is None:
            self._show(None)
            return
        key = face, database.content_hash
        if key in self._fitted:
            self._show(self._fitted[key])
            return

        def fitted(rig: FaceRig) -> None:
            self._fitted[key] = rig
            self._show(rig)

        self._jobs.start("face", texts.FITTING_FACE, (face, database.markers), fit_face, fitted, self._on_failed)

    def _on_failed(self, error: UserFacingError) -> None:
        self.failed.emit(error.message, error.remedy)
        self._show(None)

    def _show(self, rig: FaceRig | None) -> None:
        if rig is not self.rig:
            self.rig = rig
            self.changed.emit()
