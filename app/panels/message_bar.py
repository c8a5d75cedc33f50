"""Where errors are told: one sentence over the panes, that waits and never blocks."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QToolButton

from app import texts
from app.icons import put_icon
from app.theme import STEP


class MessageBar(QFrame):
    """Hidden until something is to be said; the newest message stands."""

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "message")
        row = QHBoxLayout(self)
        row.setContentsMargins(2 * STEP, STEP, STEP, STEP)
        self._label = QLabel(wordWrap=True)
        self._label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._label.setTextFormat(Qt.TextFormat.PlainText)
        row.addWidget(self._label, 1)
        self.close_button = QToolButton(toolTip=texts.CLOSE_TIP)
        put_icon(self.close_button, "cross")
        self.close_button.clicked.connect(self.hide)
        row.addWidget(self.close_button, 0, Qt.AlignmentFlag.AlignTop)
        self.hide()

    def say(self, sentence: str, remedy: str = "") -> None:
        """Show a sentence, and what to do about it."""
        self._label.setText(f"{sentence} {remedy}".strip())
        self.show()

    @property
    def text(self) -> str:
        """What it says; nothing while it is hidden."""
        return self._label.text() if self.isVisible() else ""
