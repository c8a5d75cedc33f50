"""What the sections of the control panel are made of."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QComboBox, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from app.panels.pane import label
from app.theme import STEP


class Section(QWidget):
    """A title and what belongs to it.

    column : what is below the title; title_row : the row of the title, for a badge at its right
    """

    def __init__(self, title: str) -> None:
        super().__init__()
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, STEP, 0, 0)
        self.column.setSpacing(STEP)
        self.title_row = QHBoxLayout()
        self.title_row.addWidget(label(title, "title"), 1)
        self.column.addLayout(self.title_row)

    def add_row(self, left: QWidget, right: QWidget | None = None) -> None:
        """Add a row of quiet buttons."""
        row = QHBoxLayout()
        row.addWidget(left)
        row.addStretch(1)
        if right is not None:
            row.addWidget(right)
        self.column.addLayout(row)


def quiet_button(text: str, tip: str, asked: Callable[[], None]) -> QPushButton:
    """Make a button that does not ask for attention."""
    button = QPushButton(text, toolTip=tip)
    button.setProperty("role", "quiet")
    button.clicked.connect(lambda: asked())
    return button


def combo_box(tip: str) -> QComboBox:
    """Make a list that is as wide as the panel, however long its longest entry is."""
    combo = QComboBox(toolTip=tip, minimumContentsLength=1)
    combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    return combo
