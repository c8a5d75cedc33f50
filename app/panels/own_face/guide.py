"""The guided list: which point comes now, how it is found, and which are set."""

from __future__ import annotations

from collections.abc import Collection

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QBrush
from PySide6.QtWidgets import QHBoxLayout, QListWidget, QListWidgetItem, QPushButton, QToolButton, QVBoxLayout, QWidget

from app.panels.pane import label
from app.texts import own_face as texts
from app.theme import STEP, colour, theme
from core.face.own_face_points import feature_points

_SET, _OPEN = "●", "○"
_HINT_PX = 56


class Guide(QWidget):
    """chosen(key) : another point is to be set now; the buttons are joined by the window."""

    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.count = label("", "small")
        self.list = QListWidget(toolTip=texts.POINTS_TIP)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.hint = label("", "small")
        self.hint.setWordWrap(True)
        self.hint.setFixedHeight(_HINT_PX)
        self.hint.setAlignment(Qt.AlignmentFlag.AlignTop | Qt.AlignmentFlag.AlignLeft)
        for _ in feature_points():
            self.list.addItem(QListWidgetItem())
        self.skip_button = QPushButton(texts.SKIP, toolTip=texts.SKIP_TIP)
        self.remove_button = QPushButton(texts.REMOVE, toolTip=texts.REMOVE_TIP)
        self.undo_button = QToolButton(text=texts.UNDO, toolTip=texts.UNDO_TIP)
        self.redo_button = QToolButton(text=texts.REDO, toolTip=texts.REDO_TIP)
        self.load_button = QPushButton(texts.LOAD_POINTS, toolTip=texts.LOAD_POINTS_TIP)
        self.save_button = QPushButton(texts.SAVE_POINTS, toolTip=texts.SAVE_POINTS_TIP)
        top = QHBoxLayout()
        top.addWidget(label(texts.POINTS, "title"))
        top.addWidget(self.count)
        top.addStretch(1)
        for button in (self.undo_button, self.redo_button):
            top.addWidget(button)
        steps = QHBoxLayout()
        for button in (self.skip_button, self.remove_button):
            steps.addWidget(button)
        column = QVBoxLayout(self)
        column.setContentsMargins(STEP + 4, STEP, STEP, STEP)
        column.setSpacing(STEP)
        column.addLayout(top)
        column.addWidget(self.list, 1)
        column.addWidget(self.hint)
        column.addLayout(steps)
        for button in (self.load_button, self.save_button):
            column.addWidget(button)
        self.list.currentRowChanged.connect(self._on_row)
        self.list.setCurrentRow(0)

    @property
    def key(self) -> str:
        """The point that is to be set now."""
        return feature_points()[max(self.list.currentRow(), 0)].key

    def choose(self, key: str) -> None:
        """Go to a point."""
        self.list.setCurrentRow([point.key for point in feature_points()].index(key))

    def go_on(self, is_set: Collection[str]) -> None:
        """Go to the next point that is not set, round to the first again; stay where all are."""
        points, row = feature_points(), self.list.currentRow()
        for step in range(1, len(points)):
            following = (row + step) % len(points)
            if points[following].key not in is_set:
                self.list.setCurrentRow(following)
                return

    def show_set(self, is_set: Collection[str], doubtful: Collection[str] = ()) -> None:
        """Mark which points are set, and which of them others contradict."""
        for row, point in enumerate(feature_points()):
            item = self.list.item(row)
            mark = _SET if point.key in is_set else _OPEN
            needed = f" {texts.NEEDED}" if point.is_needed and point.key not in is_set else ""
            item.setText(f"{mark}  {row + 1}  {point.title}{needed}")
            css = theme().emotion["anger"] if point.key in doubtful else theme().text
            item.setForeground(QBrush(colour(css if point.key in is_set else theme().dim)))
        self.count.setText(texts.DONE.format(done=len(is_set), all=len(feature_points())))

    def _on_row(self, row: int) -> None:
        if row >= 0:
            point = feature_points()[row]
            self.hint.setText(texts.NEEDED_HINT.format(hint=point.hint) if point.is_needed else point.hint)
            self.chosen.emit(self.key)
