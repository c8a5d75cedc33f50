"""A small drawing of a face that shows which point is to be clicked, and the sentence that says so."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.theme import colour, theme

# where the points are in a face of width 1 and height 1.3, from the left and from the top, as seen in a picture
PLACES = {
    "mouth_corner_right": (0.34, 0.95), "mouth_corner_left": (0.66, 0.95),
    "outer_eye_right": (0.17, 0.55), "outer_eye_left": (0.83, 0.55),
}  # fmt: skip
_HEIGHT = 1.3


class GuidePicture(QWidget):
    """Paints a face; one point of it is ringed, those that are done are filled."""

    def __init__(self) -> None:
        super().__init__()
        self._asked: str | None = None
        self._done: frozenset[str] = frozenset()
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Fixed)
        self.setFixedHeight(172)

    @property
    def asked(self) -> str | None:
        """The ringed point."""
        return self._asked

    def show_points(self, asked: str | None, done: frozenset[str]) -> None:
        """Ring ``asked`` and fill ``done``."""
        self._asked, self._done = asked, done
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for room for a face."""
        return QSize(200, 172)

    def paintEvent(self, _event) -> None:
        """Paint the face."""
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._paint(painter)

    def _paint(self, painter: QPainter) -> None:
        t = theme()
        size = min(self.width() / 1.1, (self.height() - 12) / _HEIGHT)
        left, top = (self.width() - size) / 2, 6.0

        def at(x: float, y: float) -> QPointF:
            return QPointF(left + x * size, top + y * size)

        painter.setPen(QPen(colour(t.dim), 1.4))
        painter.setBrush(colour(t.raised))
        head = QPainterPath(at(0.5, 0.0))
        head.cubicTo(at(0.98, 0.0), at(1.06, 0.62), at(0.86, 0.98))
        head.cubicTo(at(0.74, 1.2), at(0.62, 1.29), at(0.5, 1.29))
        head.cubicTo(at(0.38, 1.29), at(0.26, 1.2), at(0.14, 0.98))
        head.cubicTo(at(-0.06, 0.62), at(0.02, 0.0), at(0.5, 0.0))
        painter.drawPath(head)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for x in (0.28, 0.72):
            eye = QPainterPath(at(x - 0.11, 0.55))
            eye.quadTo(at(x, 0.46), at(x + 0.11, 0.55))
            eye.quadTo(at(x, 0.62), at(x - 0.11, 0.55))
            painter.drawPath(eye)
            painter.drawEllipse(at(x, 0.545), 0.028 * size, 0.028 * size)
            brow = QPainterPath(at(x - 0.13, 0.44))
            brow.quadTo(at(x, 0.37), at(x + 0.13, 0.44))
            painter.drawPath(brow)
        nose = QPainterPath(at(0.47, 0.6))
        nose.quadTo(at(0.43, 0.77), at(0.44, 0.79))
        nose.quadTo(at(0.5, 0.83), at(0.56, 0.79))
        painter.drawPath(nose)
        lips = QPainterPath(at(0.34, 0.95))
        lips.quadTo(at(0.45, 0.9), at(0.5, 0.92))
        lips.quadTo(at(0.55, 0.9), at(0.66, 0.95))
        lips.quadTo(at(0.5, 1.07), at(0.34, 0.95))
        lips.quadTo(at(0.5, 0.97), at(0.66, 0.95))
        painter.drawPath(lips)
        for name, place in PLACES.items():
            if name in self._done:
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(colour(t.accent))
                painter.drawEllipse(at(*place), 3.5, 3.5)
            elif name == self._asked:
                painter.setBrush(colour(t.accent, 0.25))
                painter.setPen(QPen(colour(t.accent), 2.2))
                painter.drawEllipse(at(*place), 9.0, 9.0)
                painter.drawRect(QRectF(at(*place) - QPointF(0.5, 0.5), at(*place) + QPointF(0.5, 0.5)))
