"""Taking motion nodes out of the search and bringing them back, always asked for by the animator."""

from __future__ import annotations

from PySide6.QtCore import QObject

from app import texts
from app.authoring import Authoring
from app.panels.isomap.removal import RemovalStrip
from core.document.change import Change


class Pruning(QObject):
    """Joins the removal strip with the document, and says what a removal did to the cost."""

    def __init__(self, authoring: Authoring, strip: RemovalStrip, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._authoring, self._strip = authoring, strip
        self._asked: tuple[str, ...] = ()
        self._removed = authoring.document.removed
        self._waiting: tuple[str, float] | None = None
        strip.confirmed.connect(self._on_confirmed)
        strip.cancelled.connect(strip.hide)
        authoring.document.changed.connect(self.on_document_changed)

    def ask(self, rows: frozenset[int], suggested: str = "") -> None:
        """Ask why these nodes are to be removed; those that are removed already are left out."""
        database, removed = self._authoring.document.database, self._authoring.document.removed
        names = tuple(database.nodes.name(row) for row in sorted(rows)) if database is not None else ()
        self._asked = tuple(name for name in names if name not in removed)
        if not self._asked:
            self._authoring.noted.emit(texts.REMOVE_NOTHING)
            return
        self._strip.ask(_what(self._asked), suggested or texts.REMOVE_REASONS[0])

    def restore(self, rows: frozenset[int]) -> None:
        """Let the search use these nodes again."""
        document = self._authoring.document
        names = [document.database.nodes.name(row) for row in sorted(rows)] if document.database is not None else []
        names = [name for name in names if name in document.removed]
        if names:
            self._authoring.restore_nodes(names)

    def _on_confirmed(self, reason: str) -> None:
        self._strip.hide()
        self._strip.cancelled.emit()
        asked, self._asked = self._asked, ()
        if asked:
            self._authoring.remove_nodes(asked, reason)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Remember the cost before nodes were removed or restored, and tell it beside the new one."""
        document = self._authoring.document
        if change & Change.CURATION:
            gone, back = document.removed - self._removed, self._removed - document.removed
            self._removed = document.removed
            if document.path is not None and (gone or back) and not change & Change.NODES:
                word = texts.NODES_REMOVED if gone else texts.NODES_RESTORED
                self._waiting = word.format(what=_what(tuple(gone or back))), self._cost
        elif change & Change.PATH and self._waiting is not None and document.path is not None:
            (what, before), self._waiting = self._waiting, None
            sentence = texts.COST_STAYED if abs(self._cost - before) < 5e-3 else texts.COST_MOVED
            self._authoring.noted.emit(sentence.format(what=what, before=before, after=self._cost))

    @property
    def _cost(self) -> float:
        return self._authoring.document.path.cost / self._authoring.document.cost_unit


def _what(names: tuple[str, ...]) -> str:
    if len(names) == 1:
        return texts.REMOVE_ONE.format(node=names[0])
    return texts.REMOVE_MANY.format(count=len(names))
