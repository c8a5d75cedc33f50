"""What a drag in the timeline does, from the press of the mouse to its release."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen

from app import texts
from app.panels.timeline.snapping import snapped
from app.theme import STEP, colour, small_font, theme
from core.speech.boundaries import SHORTEST_PHONEME_S

if TYPE_CHECKING:
    from app.panels.timeline.timeline import Timeline

_DRAG_PX = 4
_LEAST_INTENSITY, _INTENSITY_STEP = 0.05, 0.05


class Gesture(Protocol):
    """One drag. `cancel` leaves everything as it was."""

    def move(self, at: QPointF) -> None:
        """The pointer is at ``at``."""

    def release(self, at: QPointF) -> None:
        """It was let go there."""

    def cancel(self) -> None:
        """It was given up."""

    def paint(self, painter: QPainter) -> None:
        """Show what a release would do."""


class Scrub:
    """Moves the playhead, with picture and sound; a click selects what is under it. With Shift it extends a span."""

    def __init__(self, timeline: Timeline, at: QPointF, extends: bool) -> None:
        self._timeline, self._pressed_x, self._extends, self._dragging = timeline, at.x(), extends, False

    def move(self, at: QPointF) -> None:
        """See `Gesture`."""
        self._dragging = self._dragging or abs(at.x() - self._pressed_x) >= _DRAG_PX
        if self._dragging:
            self._timeline.authoring.scrub(self._timeline.scale.time_s(at.x()))

    def release(self, at: QPointF) -> None:
        """See `Gesture`."""
        if self._dragging:
            self.cancel()
            return
        slot = self._timeline.slot_at(at.x())
        if slot is None:
            return
        if self._extends:
            self._timeline.authoring.view.extend_to(slot)
        else:
            self._timeline.authoring.select_slot(slot, self._timeline.scale.time_s(at.x()))

    def cancel(self) -> None:
        """See `Gesture`."""
        self._timeline.authoring.end_scrub()

    def paint(self, painter: QPainter) -> None:
        """See `Gesture`."""


class DragBoundary:
    """Moves the boundary behind ``slot``, between its neighbours' other ends."""

    def __init__(self, timeline: Timeline, slot: int) -> None:
        self._timeline, self._slot = timeline, slot
        phonemes = timeline.authoring.document.speech.transcript.phonemes
        self._first_s, self._last_s = phonemes[slot].start_s, phonemes[slot + 1].end_s
        self._began_s = self._time_s = phonemes[slot].end_s

    def move(self, at: QPointF) -> None:
        """See `Gesture`."""
        low_s, high_s = self._first_s + SHORTEST_PHONEME_S, self._last_s - SHORTEST_PHONEME_S
        if low_s <= high_s:
            self._time_s = min(max(self._timeline.scale.time_s(at.x()), low_s), high_s)
        self._timeline.update()

    def release(self, at: QPointF) -> None:
        """See `Gesture`."""
        if self._time_s != self._began_s:
            self._timeline.authoring.move_boundary(self._slot, self._time_s)

    def cancel(self) -> None:
        """See `Gesture`."""
        self._time_s = self._began_s

    def paint(self, painter: QPainter) -> None:
        """See `Gesture`."""
        area = self._timeline.lanes()["phonemes"]
        x = self._timeline.scale.x(self._time_s)
        painter.setPen(QPen(colour(theme().accent), 2))
        painter.drawLine(QLineF(x, area.top(), x, area.bottom()))
        moved_ms = 1000.0 * (self._time_s - self._began_s)
        _paint_note(painter, self._timeline, x, area, texts.BOUNDARY_MOVED.format(milliseconds=moved_ms))


class PaintEmotion:
    """Paints the brush's emotion over time; the height of the pointer is the intensity."""

    def __init__(self, timeline: Timeline, at: QPointF) -> None:
        self._timeline, self._emotion = timeline, timeline.brush
        self._from_s = timeline.scale.time_s(at.x())
        self._span_s, self._intensity = (self._from_s, self._from_s), 1.0
        self.move(at)

    def move(self, at: QPointF) -> None:
        """See `Gesture`."""
        timeline = self._timeline
        to_s = timeline.scale.time_s(at.x())
        self._span_s = snapped(self._from_s, to_s, timeline.snap_units(), timeline.duration_s)
        area = timeline.lanes()["emotion"]
        height = (area.bottom() - at.y()) / area.height()
        # the upper quarter is full strength, or nobody would ever hit it
        share = min(max(height / 0.75, _LEAST_INTENSITY), 1.0)
        self._intensity = round(share / _INTENSITY_STEP) * _INTENSITY_STEP
        timeline.update()

    def release(self, at: QPointF) -> None:
        """See `Gesture`."""
        self._timeline.authoring.paint_emotion(*self._span_s, self._emotion, round(self._intensity, 2))

    def cancel(self) -> None:
        """See `Gesture`."""

    def paint(self, painter: QPainter) -> None:
        """See `Gesture`."""
        area = self._timeline.lanes()["emotion"].adjusted(0, 4, 0, -4)
        scale = self._timeline.scale
        left, right = scale.x(self._span_s[0]), scale.x(self._span_s[1])
        erases = self._emotion == "neutral"
        height = area.height() * (1.0 if erases else self._intensity)
        stroke = QRectF(left, area.bottom() - height, right - left, height)
        css = theme().emotion[self._emotion]
        painter.fillRect(stroke, colour(css, 0.25 if erases else 0.55))
        painter.setPen(QPen(colour(css), 1, Qt.PenStyle.DashLine if erases else Qt.PenStyle.SolidLine))
        painter.drawRect(stroke)
        note = texts.ERASING if erases else texts.PAINTING.format(emotion=self._emotion, intensity=self._intensity)
        _paint_note(painter, self._timeline, right, area, note)


def _paint_note(painter: QPainter, timeline: Timeline, x: float, area: QRectF, text: str) -> None:
    """Write beside the pointer, where there is room."""
    painter.setFont(small_font())
    width = painter.fontMetrics().horizontalAdvance(text) + 2 * STEP
    left = x + STEP if x + STEP + width <= timeline.width() else x - STEP - width
    box = QRectF(left, area.center().y() - 9, width, 18)
    painter.fillRect(box, colour(theme().raised, 0.95))
    painter.setPen(colour(theme().text))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)
