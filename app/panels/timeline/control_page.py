"""The page of control curves under the timeline: which control, what is done to it, and the graph."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.panels.control.section import combo_box
from app.panels.pane import Choice, ElidedLabel, label, toggle
from app.panels.timeline.control_graph import ControlGraph
from app.panels.timeline.timeline import Timeline
from app.texts import curves as texts
from app.theme import STEP
from core.document.change import Change
from core.synthesis.control_edits import NO_CURVE_EDITS

_CHOICE_PX = 24 * STEP


class ControlPage(QWidget):
    """Hidden until it is asked for; then it finds the curves of the motion on show."""

    def __init__(self, timeline: Timeline) -> None:
        super().__init__()
        self._authoring = timeline.authoring
        self.graph = ControlGraph(timeline)
        self.control = combo_box(texts.CHOOSE_TIP)
        self.control.setFixedWidth(_CHOICE_PX)
        self.control.activated.connect(lambda row: self.choose(self.control.itemData(row)))
        self.mute = toggle(texts.MUTE, texts.MUTE_TIP, self.graph.mute)
        self.smooth = _button(texts.SMOOTH, texts.SMOOTH_TIP, self.graph.smooth)
        self.clear = _button(texts.CLEAR, texts.CLEAR_TIP, self.graph.clear)
        self.width = Choice([(key, word, texts.WIDTH_TIP) for key, (word, _) in texts.WIDTHS.items()])
        self.width.choose("medium")
        self.width.group.idClicked.connect(lambda _: self.graph.set_reach(texts.WIDTHS[self.width.key][1]))
        self.hint = ElidedLabel("small")
        self.hint.setText(texts.HINT)
        bar = QWidget()
        bar.setFixedHeight(4 * STEP)
        row = QHBoxLayout(bar)
        row.setContentsMargins(STEP + 4, 0, STEP, 0)
        row.setSpacing(STEP)
        for widget in (label(texts.TITLE, "title"), self.control, self.mute, self.smooth, self.clear):
            row.addWidget(widget)
        row.addSpacing(STEP)
        row.addWidget(label(texts.WIDTH, tip=texts.WIDTH_TIP))
        row.addWidget(self.width)
        row.addSpacing(STEP)
        row.addWidget(self.hint, 1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(bar)
        column.addWidget(self.graph)
        self.graph.control_chosen.connect(self.choose)
        self.graph.shown.changed.connect(self._show_controls)
        self._authoring.document.changed.connect(self.on_document_changed)
        self.setVisible(False)
        self._show_controls()

    def open(self, is_open: bool) -> None:
        """Show the page, or put it away."""
        self.setVisible(is_open)
        self.graph.shown.want(is_open)

    def choose(self, control: str) -> None:
        """Edit another control."""
        self.graph.set_control(control)
        self._show_controls()

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show which controls are edited."""
        if change & Change.CONTROLS:
            self._show_controls()

    def _show_controls(self) -> None:
        curves, edits = self.graph.curves, self._authoring.document.controls
        names = () if curves is None else curves.found.names
        if [self.control.itemData(row) for row in range(self.control.count())] != list(names):
            self.control.clear()
            for name in names:
                self.control.addItem(name, name)
        for row, name in enumerate(names):
            self.control.setItemText(row, texts.EDITED.format(control=name) if name in edits.by_control else name)
        chosen = edits.of(self.graph.control)
        if curves is not None:
            self.control.setCurrentIndex(names.index(self.graph.control))
        self.mute.blockSignals(True)
        self.mute.setChecked(chosen.is_muted)
        self.mute.blockSignals(False)
        for widget in (self.control, self.mute, self.smooth, self.width):
            widget.setEnabled(curves is not None)
        self.clear.setEnabled(curves is not None and chosen != NO_CURVE_EDITS)


def _button(text: str, tip: str, done: Callable[[], None]) -> QToolButton:
    made = QToolButton(text=text, toolTip=tip)
    made.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    made.clicked.connect(lambda _checked=False: done())
    return made
