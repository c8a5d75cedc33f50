"""From which captured motion."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout

from app import texts
from app.authoring import Authoring
from app.panels.control.section import Section, quiet_button
from app.panels.pane import ElidedLabel, label
from core.document.change import Change


class DatabaseSection(Section):
    """Names the motion database and what it holds.

    database_asked() : open a file of a database
    """

    database_asked = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.DATABASE)
        self._authoring = authoring
        self.badge = label(texts.SYNTHETIC, "badge", texts.SYNTHETIC_TIP)
        self.open_button = quiet_button(texts.OPEN_SHORT, texts.OPEN_DATABASE_TIP, self.database_asked.emit)
        self.title_row.addWidget(self.open_button)
        self.name, self.facts = ElidedLabel("plain"), label()
        named = QHBoxLayout()
        named.addWidget(self.name, 1)
        named.addWidget(self.badge, 0, Qt.AlignmentFlag.AlignVCenter)
        self.column.addLayout(named)
        self.column.addWidget(self.facts)
        authoring.document.changed.connect(self.on_document_changed)
        self.on_document_changed(Change.NODES, None)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show another database."""
        if not change & Change.NODES:
            return
        database = self._authoring.document.database
        self.badge.setVisible(database is not None and database.synthetic)
        self.facts.setVisible(database is not None)
        self.name.setText(texts.NO_DATABASE if database is None else database.name)
        if database is not None:
            self.facts.setText(texts.DATABASE_FACTS.format(
                sentences=len(database.sentences), nodes=len(database.nodes), frames=len(database.frames),
                markers=len(database.markers), rate=database.rate_hz,
            ))  # fmt: skip
            self.facts.setToolTip(texts.DATABASE_TIP.format(
                coverage=database.pca.coverage, dims=database.pca.n_dims, path=database.path or ""
            ))  # fmt: skip
