"""Says which compute backend really answers, also after a device was lost in mid-work."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app.loading import OpenedDatabase
from core.document.change import Change
from core.document.document import Document
from core.search.compute import SearchKernels
from gpu.device import describe

_AFTER = Change.NODES | Change.PATH | Change.PRICES


class Backends(QObject):
    """The compute backends of the databases that were opened; looked at whenever the search has used one.

    changed(name, sentence) : which one searches the document's database, in a word and in full
    """

    changed = Signal(str, str)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._kernels: dict[str, tuple[SearchKernels, str]] = {}
        self._told: tuple[str, str] | None = None
        document.changed.connect(self._on_document_changed)

    def add(self, opened: OpenedDatabase) -> None:
        """Take the backend of a database that was opened; the first one for its content goes on searching it."""
        self._kernels.setdefault(opened.database.content_hash, (opened.engine.kernels, opened.backend))

    def _on_document_changed(self, change: Change, _origin: object) -> None:
        database = self._document.database
        if not change & _AFTER or database is None or database.content_hash not in self._kernels:
            return
        kernels, sentence = self._kernels[database.content_hash]
        report = kernels.report
        told = report.backend, f"{report.lost} ({describe(kernels)})" if report.lost else sentence
        if told != self._told:
            self._told = told
            self.changed.emit(*told)
