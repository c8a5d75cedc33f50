"""The strip that asks why nodes are removed; it never blocks, and nothing is removed before it is answered."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLineEdit, QPushButton, QToolButton, QWidget

from app import texts
from app.panels.pane import label
from app.theme import STEP


class RemovalStrip(QWidget):
    """One line: what, why, Remove, Cancel. Enter removes, Escape does not.

    confirmed(reason), cancelled()
    """

    confirmed = Signal(str)
    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(STEP, 2, STEP, 2)
        row.setSpacing(STEP // 2)
        self.question = label("", "small")
        row.addWidget(self.question)
        for reason in texts.REMOVE_REASONS:
            button = QToolButton(text=reason)
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            button.clicked.connect(lambda _=False, reason=reason: self.confirmed.emit(reason))
            row.addWidget(button)
        self.reason = QLineEdit(placeholderText=texts.REMOVE_REASON_HINT)
        self.reason.setMinimumWidth(8 * STEP)
        self.reason.setToolTip(texts.REMOVE_TIP)
        self.reason.returnPressed.connect(self._confirm)
        row.addWidget(self.reason, 1)
        self.remove = QPushButton(texts.REMOVE, toolTip=texts.REMOVE_TIP)
        self.remove.setProperty("role", "quiet")
        self.remove.clicked.connect(self._confirm)
        row.addWidget(self.remove)
        self.cancel = QToolButton(text="✕", toolTip=texts.CANCEL_TIP)
        self.cancel.clicked.connect(self.cancelled)
        row.addWidget(self.cancel)
        self.hide()

    def ask(self, what: str, suggested: str) -> None:
        """Ask why ``what`` is removed; ``suggested`` is taken by Enter alone."""
        self.question.setText(texts.REMOVE_ASK.format(what=what))
        self.reason.setText(suggested)
        self.reason.selectAll()
        self.show()
        self.reason.setFocus()

    def _confirm(self) -> None:
        self.confirmed.emit(self.reason.text().strip() or texts.REMOVE_REASONS[0])

    def keyPressEvent(self, event) -> None:
        """Escape leaves everything as it is."""
        if event.key() == Qt.Key.Key_Escape:
            event.accept()
            self.cancelled.emit()
        else:
            super().keyPressEvent(event)
