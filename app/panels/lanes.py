"""The lanes of the timeline. They paint themselves: text and heights stay in pixels while time is stretched."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QLinearGradient, QPainter, QPen

from app.theme import colour, small_font, theme
from core.media.audio import Audio
from core.speech.emotion import EMOTIONS, EmotionModifier, emotion_weights
from core.speech.phoneme import PAU

_TICKS_S = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 600.0)
_TICK_PX = 72
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


@dataclass(frozen=True)
class Peaks:
    """Lowest and highest sample of each block, at which a waveform is drawn whatever its length.

    low, high : float32, shape (n_blocks,); block_s : seconds a block
    """

    low: np.ndarray
    high: np.ndarray
    block_s: float

    @classmethod
    def of(cls, audio: Audio, block_s: float = 0.002) -> Peaks:
        """Measure a sound."""
        block = max(1, round(audio.rate_hz * block_s))
        edges = np.arange(0, len(audio.samples), block)
        return cls(np.minimum.reduceat(audio.samples, edges), np.maximum.reduceat(audio.samples, edges),
                   block / audio.rate_hz)  # fmt: skip

    def columns(self, times_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return lowest and highest sample between neighbouring ``times_s`` (ascending), one fewer than times."""
        at = np.clip((times_s / self.block_s).astype(int), 0, len(self.low) - 1)
        # reduceat gives the single block where two columns share one
        low = np.minimum.reduceat(self.low[: at[-1] + 1], at)[:-1]
        return low, np.maximum.reduceat(self.high[: at[-1] + 1], at)[:-1]


def paint_ruler(painter: QPainter, area: QRectF, scale: TimeScale, end_s: float) -> None:
    """Ticks in seconds, as many as have room."""
    step = next((s for s in _TICKS_S if s * scale.px_per_s >= _TICK_PX), _TICKS_S[-1])
    digits = 0 if step >= 1 else 1 if step >= 0.1 else 2
    painter.setFont(small_font())
    first = int(max(scale.start_s, 0.0) / step)
    last = int(min(end_s, scale.time_s(area.right())) / step + 1e-9)
    for i in range(first, last + 1):
        x = scale.x(i * step)
        painter.setPen(colour(theme().line))
        painter.drawLine(QLineF(x, area.top() + 4, x, area.bottom()))
        text = f"{i * step:.{digits}f} s"
        if x + 4 + painter.fontMetrics().horizontalAdvance(text) <= area.right():
            painter.setPen(colour(theme().dim))
            painter.drawText(QRectF(x + 4, area.top(), _TICK_PX, area.height()), Qt.AlignmentFlag.AlignVCenter, text)


def paint_wave(painter: QPainter, area: QRectF, scale: TimeScale, peaks: Peaks, end_s: float) -> None:
    """Lowest and highest sample of each pixel column, on the scale of the loudest."""
    loudest = max(float(np.abs(peaks.low).max()), float(np.abs(peaks.high).max()), 1e-6)
    middle, half = area.center().y(), area.height() / 2 - 2
    left, right = int(max(area.left(), scale.x(0.0))), int(min(area.right(), scale.x(end_s)))
    if right <= left:
        return
    places = np.arange(left, right + 1)
    low, high = peaks.columns(scale.start_s + (places - scale.left_px) / scale.px_per_s)
    tops, bottoms = middle - half * high / loudest - 0.5, middle - half * low / loudest + 0.5
    lines = [QLineF(x + 0.5, top, x + 0.5, bottom) for x, top, bottom in zip(places, tops, bottoms)]
    painter.setPen(QPen(colour(theme().dim, 0.9), 1))
    painter.drawLines(lines)


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
