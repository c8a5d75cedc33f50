"""The lanes of the timeline. They paint themselves: text and heights stay in pixels while time is stretched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QBrush, QLinearGradient, QPainter, QPen

from app.theme import colour, small_font, theme
from core.speech.emotion import EMOTIONS, EmotionModifier, emotion_weights
from core.speech.phoneme import PAU

_MIX_COLUMN_PX = 2


@dataclass(frozen=True)
class TimeScale:
    """Where a time is on screen.

    left_px : x of ``start_s``; px_per_s : stretch
    """

    start_s: float
    px_per_s: float
    left_px: float

    def x(self, time_s: float) -> float:
        """Return the place of a time, pixels."""
        return self.left_px + (time_s - self.start_s) * self.px_per_s

    def time_s(self, x: float) -> float:
        """Return the time at a place."""
        return self.start_s + (x - self.left_px) / self.px_per_s


def paint_boxes(
    painter: QPainter, area: QRectF, scale: TimeScale, boxes: list[tuple[str, float, float]], chosen: int | None,
    pinned: frozenset[int] = frozenset(),
) -> None:  # fmt: skip
    """Words or phonemes between their boundaries; a text that does not fit is left out.

    boxes : (text, start_s, end_s); chosen, pinned : rows of boxes
    """
    painter.setFont(small_font())
    metrics = painter.fontMetrics()
    for i, (text, start_s, end_s) in enumerate(boxes):
        box = QRectF(scale.x(start_s), area.top(), scale.x(end_s) - scale.x(start_s), area.height())
        if box.right() < area.left() or box.left() > area.right():
            continue
        if i == chosen:
            painter.fillRect(box.adjusted(0.5, 1, -0.5, -1), colour(theme().accent))
        painter.setPen(colour(theme().line))
        painter.drawLine(QLineF(box.right(), box.top() + 3, box.right(), box.bottom() - 3))
        painter.drawLine(QLineF(box.left(), box.top() + 3, box.left(), box.bottom() - 3))
        if text != PAU and metrics.horizontalAdvance(text) + 2 < box.width():
            painter.setPen(colour(theme().on_accent if i == chosen else theme().text))
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)
        if i in pinned:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(colour(theme().on_accent if i == chosen else theme().accent))
            painter.drawEllipse(QRectF(box.center().x() - 2.5, box.top() + 1, 5, 5))
            painter.setBrush(Qt.BrushStyle.NoBrush)


def paint_emotions(
    painter: QPainter, area: QRectF, scale: TimeScale, modifiers: tuple[EmotionModifier, ...], end_s: float
) -> None:
    """The mix of emotions over time: a band for each, as high as its share; neutral is the ground line."""
    left, right = max(area.left(), scale.x(0.0)), min(area.right(), scale.x(end_s))
    if right <= left:
        return
    columns = np.arange(left, right, _MIX_COLUMN_PX)
    times_s = scale.start_s + (columns - scale.left_px) / scale.px_per_s
    shares = emotion_weights(times_s, times_s + _MIX_COLUMN_PX / scale.px_per_s, modifiers)
    inside = area.adjusted(0, 4, 0, -4)
    painter.fillRect(QRectF(left, inside.bottom() - 2, right - left, 2), colour(theme().emotion["neutral"], 0.8))
    for x, share in zip(columns, shares):
        bottom = inside.bottom()
        for e in range(1, len(EMOTIONS)):
            height = share[e] * inside.height()
            if height > 0:
                bottom -= height
                painter.fillRect(QRectF(x, bottom, min(_MIX_COLUMN_PX, right - x), height),
                                 colour(theme().emotion[EMOTIONS[e]], 0.7))  # fmt: skip


def paint_locks(painter: QPainter, area: QRectF, scale: TimeScale, slots: list[tuple[float, float]]) -> None:
    """Hatch the slots that no edit may move."""
    hatch = QBrush(colour(theme().dim, 0.45), Qt.BrushStyle.BDiagPattern)
    for start_s, end_s in slots:
        painter.fillRect(QRectF(scale.x(start_s), area.top() + 1, scale.x(end_s) - scale.x(start_s), area.height() - 2),
                         hatch)  # fmt: skip


def paint_changed(painter: QPainter, area: QRectF, scale: TimeScale, slots: list[tuple[float, float]]) -> None:
    """Outline the slots that the last edit gave another motion node."""
    painter.setPen(QPen(colour(theme().accent), 1))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for start_s, end_s in slots:
        left, right = scale.x(start_s), scale.x(end_s)
        painter.drawRect(QRectF(left + 1.5, area.top() + 1.5, max(right - left - 3, 1), area.height() - 3))


def paint_playhead(painter: QPainter, area: QRectF, x: float) -> None:
    """A thin line with a head in the ruler."""
    painter.setPen(QPen(colour(theme().accent), 1))
    painter.drawLine(QLineF(x, area.top(), x, area.bottom()))
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour(theme().accent))
    painter.drawPolygon([QLineF(x - 5, area.top(), x, 0).p1(), QLineF(x + 5, area.top(), x, 0).p1(),
                         QLineF(x, area.top() + 7, x, 0).p1()])  # fmt: skip
    painter.setBrush(Qt.BrushStyle.NoBrush)


def paint_selection(painter: QPainter, area: QRectF, left: float, right: float) -> None:
    """The selected utterance, through all lanes."""
    shade = QLinearGradient(0, area.top(), 0, area.bottom())
    shade.setColorAt(0, colour(theme().accent, 0.05))
    shade.setColorAt(1, colour(theme().accent, 0.14))
    painter.fillRect(QRectF(left, area.top(), right - left, area.height()), shade)
