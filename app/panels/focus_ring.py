"""A thin line around the canvas that takes the keys."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QWidget

from app.theme import colour, theme


class FocusRing(QWidget):
    """Lies over a canvas while that has the focus; the pointer goes through it."""

    def __init__(self, canvas: QWidget) -> None:
        super().__init__(canvas)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setVisible(canvas.hasFocus())
        canvas.installEventFilter(self)

    def eventFilter(self, canvas: QObject, event: QEvent) -> bool:
        """Come and go with the focus of the canvas, and keep to its size."""
        if event.type() in (QEvent.Type.FocusIn, QEvent.Type.Resize):
            self.setGeometry(canvas.rect())
            self.raise_()
        if event.type() in (QEvent.Type.FocusIn, QEvent.Type.FocusOut):
            self.setVisible(event.type() == QEvent.Type.FocusIn)
        return False

    def paintEvent(self, _event) -> None:
        """Draw the line."""
        with QPainter(self) as painter:
            painter.setPen(QPen(colour(theme().accent, 0.8), 1))
            painter.drawRect(self.rect().adjusted(0, 0, -1, -1))
