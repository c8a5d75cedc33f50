"""Beside the map: the nodes that look contaminated, which are looked for in the background, and those removed."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QStackedWidget, QToolButton

from app import texts
from app.authoring import Authoring
from app.panels.isomap.node_lists import NodeList, RemovedList, SuspectList
from app.panels.pane import toggle
from core.document.change import Change
from core.errors import UserFacingError
from core.suspicion.ranking import SuspicionList


class SideLists(QStackedWidget):
    """One of two lists, or neither, by its buttons.

    found() : suspicion is known for the database on show
    """

    found = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self._authoring = authoring
        self._by_database: dict[str, SuspicionList] = {}
        self.suspects, self.removed = SuspectList(), RemovedList()
        for page in (self.suspects, self.removed):
            self.addWidget(page)
        self.suspects_button = toggle(texts.SUSPECTS, texts.SUSPECTS_TIP, self.show_suspects)
        self.removed_button = toggle(texts.REMOVED, texts.REMOVED_TIP, self.show_removed)
        self.hide()
        authoring.document.changed.connect(self.on_document_changed)

    @property
    def suspicion(self) -> SuspicionList | None:
        """What is suspected of the database on show; None until it was looked for."""
        database = self._authoring.document.database
        return None if database is None else self._by_database.get(database.content_hash)

    @property
    def removed_rows(self) -> frozenset[int]:
        """Rows of the nodes that no search uses."""
        database, rows = self._authoring.document.database, set()
        for name in self._authoring.document.removed if database is not None else ():
            try:
                rows.add(database.nodes.row(name))
            except UserFacingError:
                continue  # the list may be older or newer than the database
        return frozenset(rows)

    def fault_of(self, rows: frozenset[int]) -> str:
        """Return the one fault that nodes are suspected of; nothing where there are several, or none."""
        suspicion = self.suspicion
        suspected = {} if suspicion is None else {s.row: s.fault.value for s in suspicion.worth_watching}
        faults = {suspected[row] for row in rows if row in suspected}
        return faults.pop() if len(faults) == 1 else ""

    def show_suspects(self, shows: bool) -> None:
        """Show the suspects beside the map."""
        self._show(self.suspects, shows, self.removed_button)
        if shows:
            self.look_for_suspects()
            self.suspects.view.setFocus()

    def show_removed(self, shows: bool) -> None:
        """Show the removed nodes beside the map."""
        self._show(self.removed, shows, self.suspects_button)

    def look_for_suspects(self) -> None:
        """List the suspects, once they are known."""
        database, jobs = self._authoring.document.database, self._authoring.jobs
        if database is None:
            return
        if self.suspicion is not None:
            self._list_suspects()
        elif not jobs.is_running("suspicion"):

            def found(suspicion: SuspicionList) -> None:
                self._by_database[database.content_hash] = suspicion
                self._list_suspects()
                self.found.emit()

            jobs.start("suspicion", texts.LOOKING_FOR_FAULTS, database, SuspicionList.of, found)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Another database, or other removals."""
        if change & Change.NODES:
            self.suspects.show_suspects(None, ())
            if self.suspects_button.isChecked():
                self.look_for_suspects()
        if change & (Change.CURATION | Change.NODES):
            document = self._authoring.document
            removals = {**document.shared_removals, **document.removed_here}
            shown = {node: removal for node, removal in removals.items() if node in document.removed}
            self.removed.show_removals(document.database, shown)
            self.suspects.show_removed(self.removed_rows)

    def _list_suspects(self) -> None:
        if self.suspicion is not None:
            self.suspects.show_suspects(self._authoring.document.database.nodes, self.suspicion.worth_watching)
            self.suspects.show_removed(self.removed_rows)

    def _show(self, page: NodeList, shows: bool, other: QToolButton) -> None:
        if shows:
            other.setChecked(False)
            self.setCurrentWidget(page)
        self.setVisible(self.suspects_button.isChecked() or self.removed_button.isChecked())
