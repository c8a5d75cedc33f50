"""Dots that lie over a view: points that are set, the one that is next, and where it is to be expected."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QWidget

from app.theme import colour, small_font, theme

DOT_PX, RING_PX = 4.0, 9.0
_BEHIND = 0.22


@dataclass(frozen=True)
class Dot:
    """One point on screen.

    label : its number; is_chosen : the one that is to be set; is_seen : not on the far side
    is_guess : only expected there; needs_look : others contradict it
    """

    at: QPointF
    label: str
    is_chosen: bool = False
    is_seen: bool = True
    is_guess: bool = False
    needs_look: bool = False


class DotLayer(QWidget):
    """Lies over a canvas; the pointer goes through it. ``dots`` is asked whenever it paints."""

    def __init__(self, canvas: QWidget, dots) -> None:
        super().__init__(canvas)
        self._dots = dots
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)

    def paintEvent(self, _event) -> None:
        """Paint the dots."""
        with QPainter(self) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setFont(small_font())
            for dot in self._dots():
                self._paint(painter, dot)

    def _paint(self, painter: QPainter, dot: Dot) -> None:
        strength = 1.0 if dot.is_seen else _BEHIND
        main = theme().accent if dot.is_chosen else theme().other
        if dot.is_guess or dot.is_chosen:
            style = Qt.PenStyle.DashLine if dot.is_guess else Qt.PenStyle.SolidLine
            painter.setBrush(Qt.BrushStyle.NoBrush)
            for width, css in ((3.6, theme().canvas), (1.8, theme().accent)):
                painter.setPen(QPen(colour(css, strength * (0.7 if width > 2 else 1.0)), width, style))
                painter.drawEllipse(dot.at, RING_PX, RING_PX)
        if dot.is_guess:
            return
        painter.setPen(QPen(colour(theme().canvas, 0.8 * strength), 1.4))
        painter.setBrush(colour(theme().emotion["anger"] if dot.needs_look else main, strength))
        painter.drawEllipse(dot.at, DOT_PX, DOT_PX)
        if dot.is_seen:
            painter.setPen(colour(theme().canvas, 0.9))
            painter.drawText(dot.at + QPointF(DOT_PX + 3, -DOT_PX + 1), dot.label)
            painter.setPen(colour(theme().text))
            painter.drawText(dot.at + QPointF(DOT_PX + 2, -DOT_PX), dot.label)
