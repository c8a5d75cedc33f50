"""How sure the tracker was, picture by picture: a strip to look along and to click into."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.texts import tracking as texts
from app.theme import colour, theme
from core.tracking.track import Track

UNSURE = 0.5
_MARK_PX = 8
_EDGE_PX = 12


class TrustStrip(QWidget):
    """Paints a bar a picture, a mark where a hand corrected, and the playhead.

    picture_asked(frame) : somebody clicked there
    """

    picture_asked = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self._trust, self._lost = np.zeros(0), np.zeros(0, bool)
        self._corrected: tuple[int, ...] = ()
        self._count, self._frame = 0, 0
        self.setToolTip(texts.STRIP_TIP)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.PointingHandCursor)

    def show_track(self, track: Track | None, n_frames: int, corrected: tuple[int, ...]) -> None:
        """Show another track, or how long one will be."""
        self._trust = np.zeros(0) if track is None else track.frame_trust
        self._lost = np.zeros(0, bool) if track is None else track.lost
        self._count, self._corrected = max(n_frames, len(self._trust)), corrected
        self.update()

    def show_frame(self, frame: int) -> None:
        """Move the playhead."""
        if frame != self._frame:
            self._frame = frame
            self.update()

    def frame_at(self, x: float) -> int:
        """The picture under a place of the widget."""
        share = (x - _EDGE_PX) / max(self.width() - 2 * _EDGE_PX, 1)
        return int(np.clip(share * self._count, 0, max(self._count - 1, 0)))

    def _x(self, frame: float) -> float:
        return _EDGE_PX + frame / max(self._count, 1) * (self.width() - 2 * _EDGE_PX)

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for little height."""
        return QSize(400, 52)

    def mousePressEvent(self, event) -> None:
        """Go there."""
        if self._count and event.button() == Qt.MouseButton.LeftButton:
            self.picture_asked.emit(self.frame_at(event.position().x()))

    def mouseMoveEvent(self, event) -> None:
        """Scrub."""
        if self._count and event.buttons() & Qt.MouseButton.LeftButton:
            self.picture_asked.emit(self.frame_at(event.position().x()))

    def paintEvent(self, _event) -> None:
        """Paint bars, marks and playhead."""
        with QPainter(self) as painter:
            self._paint(painter)

    def _paint(self, painter: QPainter) -> None:
        t = theme()
        ground = QRectF(_EDGE_PX, _MARK_PX + 2, self.width() - 2 * _EDGE_PX, self.height() - _MARK_PX - 6)
        painter.fillRect(ground, colour(t.canvas))
        lost, unsure, sure = colour(t.emotion["anger"]), colour(t.accent), colour(t.dim)
        # a bar a pixel: the worst picture under it is what must be seen
        n_bars = max(1, min(len(self._trust), int(ground.width())))
        edges = np.linspace(0, len(self._trust), n_bars + 1).astype(int) if len(self._trust) else []
        for first, stop in pairwise(edges):
            trust, is_lost = float(self._trust[first:stop].min()), bool(self._lost[first:stop].any())
            left, right = self._x(first), self._x(stop)
            high = ground.height() * (1.0 if is_lost else max(trust, 0.03))
            bar = QRectF(left, ground.bottom() - high, max(right - left, 1.0), high)
            painter.fillRect(bar, lost if is_lost else unsure if trust < UNSURE else sure)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour(t.accent))
        for frame in self._corrected:
            x = self._x(frame + 0.5)
            painter.drawPolygon(QPolygonF([QPointF(x - 4, 1), QPointF(x + 4, 1), QPointF(x, _MARK_PX)]))
        if self._count:
            x = self._x(self._frame + 0.5)
            painter.setPen(QPen(colour(t.text), 1.5))
            painter.drawLine(QPointF(x, _MARK_PX), QPointF(x, self.height() - 2.0))
