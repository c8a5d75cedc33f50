"""The captured markers as dots: which are near-rigid, which is the origin. A click changes it."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QToolTip, QWidget

from app.panels.importing.face_picture import FrontView
from app.panels.importing.match_view import REACH_PX, Cloud, paint_name
from app.theme import colour, theme

_DOT_PX = 3.6
_RING_PX = 8.0
_MARGIN_PX = 40


class HeadView(QWidget):
    """toggled(name) : a dot was clicked; origin_asked(name) : with the right button, or Shift."""

    toggled = Signal(str)
    origin_asked = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setMouseTracking(True)
        self.setMinimumSize(280, 240)
        self._cloud = Cloud((), np.empty((0, 3)))
        self._rigid: frozenset[str] = frozenset()
        self._origin: str | None = None
        self._hovered: str | None = None

    def show_markers(self, cloud: Cloud, rigid: frozenset[str], origin: str | None) -> None:
        """Show other markers, or other parts of them."""
        self._cloud, self._rigid, self._origin = cloud, rigid, origin
        self.update()

    def place_of(self, name: str) -> QPointF:
        """Return where a marker is on screen."""
        return QPointF(*self._places()[self._cloud.names.index(name)])

    def _places(self) -> np.ndarray:
        return FrontView.fitting(self._cloud.points, self.rect().toRectF(), _MARGIN_PX).places(self._cloud.points)

    def _at(self, at: QPointF) -> str | None:
        places = self._places()
        if not len(places):
            return None
        away = np.hypot(places[:, 0] - at.x(), places[:, 1] - at.y())
        away = np.where(np.isfinite(away), away, np.inf)
        return self._cloud.names[int(away.argmin())] if away.min() < REACH_PX else None

    # Qt

    def paintEvent(self, _event) -> None:
        """Paint the dots."""
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), colour(theme().canvas))
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            places = self._places()
            for name, (x, y) in zip(self._cloud.names, places):
                if np.isfinite(x):
                    self._paint_dot(painter, QPointF(x, y), name)
            if self._hovered is not None:
                paint_name(painter, self.place_of(self._hovered), self._hovered, self.width())

    def _paint_dot(self, painter: QPainter, at: QPointF, name: str) -> None:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if name in self._rigid:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(colour(theme().accent))
            painter.drawEllipse(at, _DOT_PX, _DOT_PX)
        else:
            painter.setPen(QPen(colour(theme().dim), 1.2))
            painter.drawEllipse(at, _DOT_PX - 0.6, _DOT_PX - 0.6)
        if name == self._origin:
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(colour(theme().accent), 1.6))
            painter.drawEllipse(at, _RING_PX, _RING_PX)

    def mousePressEvent(self, event) -> None:
        """Change what a marker is taken for."""
        name = self._at(event.position())
        if name is None:
            return
        shifted = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        if event.button() == Qt.MouseButton.RightButton or shifted:
            self.origin_asked.emit(name)
        elif event.button() == Qt.MouseButton.LeftButton:
            self.toggled.emit(name)

    def mouseMoveEvent(self, event) -> None:
        """Name what is under the pointer."""
        hovered = self._at(event.position())
        if hovered != self._hovered:
            self._hovered = hovered
            self.setCursor(Qt.CursorShape.PointingHandCursor if hovered else Qt.CursorShape.ArrowCursor)
            self.update()

    def leaveEvent(self, event) -> None:
        """Forget the pointer."""
        super().leaveEvent(event)
        self._hovered = None
        self.update()

    def event(self, event) -> bool:
        """The name is beside the dot already."""
        if event.type() == event.Type.ToolTip:
            QToolTip.hideText()
            return True
        return super().event(event)
