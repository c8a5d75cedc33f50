"""By which engine, what it minds, and what is laid over its motion."""

from __future__ import annotations

from PySide6.QtCore import Qt

from app import texts
from app.authoring import Authoring
from app.panels.control.section import Section, combo_box
from app.panels.pane import label, toggle
from app.panels.polish import PolishPage
from app.panels.weights import WeightsPage
from core.document.change import Change
from core.synthesis.registry import ENGINES


class EngineSection(Section):
    """Chooses among the engines that are offered; one without a path has no weights, and only animemes hold."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.ENGINE)
        self._authoring = authoring
        self.chosen = combo_box("")
        self._n_offered = 0
        for name, kind in reversed(ENGINES.items()):
            if kind.is_offered:
                self._add(name, kind.title, kind.tip)
        self._n_offered = self.chosen.count()
        self.chosen.activated.connect(lambda row: authoring.set_engine(self.chosen.itemData(row)))
        self.hold = toggle(texts.HOLD, texts.HOLD_TIP, authoring.set_holds)
        self.facts = label(texts.BACKEND_WAITING)
        self.facts.setWordWrap(True)
        self.weights, self.polish = WeightsPage(authoring), PolishPage(authoring)
        for widget in (self.chosen, self.hold, self.facts, self.weights, self.polish):
            self.column.addWidget(widget)
        self._backend = texts.BACKEND_WAITING, ""
        authoring.document.changed.connect(self.on_document_changed)
        authoring.backend_changed.connect(self.on_backend_changed)
        self.on_document_changed(Change.ENGINE, None)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show another engine, and whether it holds."""
        if not change & Change.ENGINE:
            return
        document = self._authoring.document
        kind = ENGINES.get(document.engine)
        while self.chosen.count() > self._n_offered:
            self.chosen.removeItem(self._n_offered)
        if self.chosen.findData(document.engine) < 0:
            self._add(
                document.engine, document.engine if kind is None else kind.title, "" if kind is None else kind.tip
            )
        row = self.chosen.findData(document.engine)
        self.chosen.setCurrentIndex(row)
        self.chosen.setToolTip(self.chosen.itemData(row, Qt.ItemDataRole.ToolTipRole))
        self.hold.setVisible(kind is not None and kind.can_hold)
        self.hold.setChecked(document.holds)
        self.weights.setVisible(not document.has_no_path)
        self._show_facts()

    def on_backend_changed(self, name: str, sentence: str) -> None:
        """Show which backend computes."""
        self._backend = texts.ENGINE_FACTS.format(backend=name), texts.ENGINE_TIP.format(sentence=sentence)
        self._show_facts()

    def _show_facts(self) -> None:
        facts, tip = (texts.NO_PATH, texts.NO_PATH_TIP) if self._authoring.document.has_no_path else self._backend
        self.facts.setText(facts)
        self.facts.setToolTip(tip)

    def _add(self, name: str, title: str, tip: str) -> None:
        self.chosen.addItem(title, name)
        self.chosen.setItemData(self.chosen.count() - 1, tip, Qt.ItemDataRole.ToolTipRole)
