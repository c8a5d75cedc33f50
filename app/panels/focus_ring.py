"""A thin line around the canvas that takes the keys."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QApplication, QWidget

from app.theme import colour, theme


class FocusRing(QWidget):
    """Lies over a canvas while that has the focus; the pointer goes through it.

    It listens to the application, not to the canvas by an event filter: a canvas loses the focus while it is being
    destroyed, too. The canvas calls `fit` when its size changes.
    """

    def __init__(self, canvas: QWidget) -> None:
        super().__init__(canvas)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.hide()
        QApplication.instance().focusChanged.connect(self.on_focus_changed)

    def on_focus_changed(self, _old: QWidget | None, now: QWidget | None) -> None:
        """Come and go with the focus of the canvas."""
        is_wanted = now is not None and now is self.parentWidget()
        if is_wanted:
            self.fit()
        if is_wanted == self.isHidden():
            self.setVisible(is_wanted)

    def fit(self) -> None:
        """Take the size of the canvas, above all that lies on it."""
        self.setGeometry(self.parentWidget().rect())
        self.raise_()

    def paintEvent(self, _event) -> None:
        """Draw the line."""
        with QPainter(self) as painter:
            painter.setPen(QPen(colour(theme().accent, 0.8), 1))
            painter.drawRect(self.rect().adjusted(0, 0, -1, -1))
