"""A page of the control panel that is folded until it is wanted."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QToolButton, QVBoxLayout, QWidget

from app.theme import STEP


class FoldedPage(QWidget):
    """A headline that unfolds what is below it, with a way back to how things were.

    head : the headline's button; reset : the button at its right; body : what is folded
    """

    def __init__(self, title: str, tip: str, reset: str, reset_tip: str) -> None:
        super().__init__()
        self.column = QVBoxLayout(self)
        self.column.setContentsMargins(0, STEP, 0, 0)
        self.column.setSpacing(STEP // 2)
        row = QHBoxLayout()
        self.head = QToolButton(text=title, checkable=True, toolTip=tip)
        self.head.setArrowType(Qt.ArrowType.RightArrow)
        self.head.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.head.toggled.connect(self.unfold)
        row.addWidget(self.head)
        row.addStretch(1)
        self.reset = QToolButton(text=reset, toolTip=reset_tip)
        row.addWidget(self.reset)
        self.column.addLayout(row)
        self.body = QWidget()
        self.body.setVisible(False)

    def unfold(self, shown: bool) -> None:
        """Show what is below the headline, or hide it."""
        self.head.setArrowType(Qt.ArrowType.DownArrow if shown else Qt.ArrowType.RightArrow)
        self.body.setVisible(shown)
