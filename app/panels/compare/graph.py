"""The curves of both motions over time, what lies between them, and what is said."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPen, QPixmap, QPolygonF
from PySide6.QtWidgets import QWidget

from app.authoring import Authoring
from app.panels.compare.lanes import Lane
from app.panels.compare.pens import side_colour, side_pen
from app.panels.focus_ring import FocusRing
from app.panels.timeline.lanes import TimeScale, paint_boxes, paint_playhead
from app.panels.timeline.ruler import Ruler, paint_ruler
from app.report.charts import rounded_span
from app.texts import compare as texts
from app.theme import STEP, colour, small_font, theme
from core.speech.transcript import Transcript

_LEFT_PX, _RIGHT_PX, _RULER_PX, _PHONES_PX, _LANE_PX = 72, 8, 20, 22, 62
_ZOOM_PER_STEP, _STEP_ANGLE, _LONGEST_ZOOM = 1.25, 120.0, 60.0
_DRAG_PX = 3


class CompareGraph(QWidget):
    """One lane below the other on one axis of time.

    lanes : what is drawn, see `app.panels.compare.lanes`
    """

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self._authoring = authoring
        self.lanes: tuple[Lane, ...] = ()
        self._transcript: Transcript | None = None
        self._rate_hz = 1.0
        self._start_s, self._zoom = 0.0, 1.0
        self._hovered_s: float | None = None
        self._pressed: QPointF | None = None
        self._picture: QPixmap | None = None
        self.focus_ring = FocusRing(self)
        self.setStatusTip(texts.GRAPH_HINT)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumHeight(_RULER_PX + _PHONES_PX + 2 * _LANE_PX)
        authoring.view.playhead_moved.connect(self._on_playhead_moved)

    def show_lanes(self, lanes: tuple[Lane, ...], transcript: Transcript | None, rate_hz: float) -> None:
        """Draw other lines; the zoom stays as long as the speech has the same length."""
        if self._transcript is None or transcript is None or transcript.duration_s != self._transcript.duration_s:
            self._start_s, self._zoom = 0.0, 1.0
        self.lanes, self._transcript, self._rate_hz = lanes, transcript, rate_hz
        self.renew()

    def renew(self) -> None:
        """Paint anew."""
        self._picture = None
        self.update()

    def zoom_all(self) -> None:
        """Show all of the speech."""
        self._start_s, self._zoom = 0.0, 1.0
        self.renew()

    # What is where

    @property
    def _duration_s(self) -> float:
        return 1.0 if self._transcript is None else self._transcript.duration_s

    @property
    def scale(self) -> TimeScale:
        """Where times are."""
        room_px = max(self.width() - _LEFT_PX - _RIGHT_PX, 1)
        return TimeScale(self._start_s, self._zoom * room_px / self._duration_s, _LEFT_PX)

    def lane_area(self, n: int) -> QRectF:
        """Return where a lane is."""
        room = (self.height() - _RULER_PX - _PHONES_PX) / max(len(self.lanes), 1)
        return QRectF(_LEFT_PX, _RULER_PX + n * room, self.width() - _LEFT_PX - _RIGHT_PX, room)

    @property
    def _phones_area(self) -> QRectF:
        return QRectF(_LEFT_PX, self.height() - _PHONES_PX, self.width() - _LEFT_PX - _RIGHT_PX, _PHONES_PX)

    def readings(self, time_s: float) -> tuple[tuple[tuple[str, float], ...], ...]:
        """Return for each lane (key, value) of its lines at the frame that is nearest to a time."""
        frame = max(round(time_s * self._rate_hz), 0)
        return tuple(
            tuple((line.key, float(line.values[min(frame, len(line.values) - 1)])) for line in lane.lines)
            for lane in self.lanes
        )

    @property
    def read_at_s(self) -> float:
        """The time that values are read at: under the pointer, else at the playhead."""
        return self._authoring.view.playhead_s if self._hovered_s is None else self._hovered_s

    # Painting

    def _paint_still(self, picture: QPixmap) -> None:
        picture.fill(colour(theme().canvas))
        painter = QPainter(picture)
        painter.setFont(small_font())
        scale, phones = self.scale, self._phones_area
        whole = QRectF(phones.left(), 0, phones.width(), self.height())
        spans = [self._paint_axis(painter, n) for n in range(len(self.lanes))]
        painter.setClipRect(whole)
        paint_ruler(painter, QRectF(phones.left(), 0, phones.width(), _RULER_PX), scale, self._duration_s, Ruler())
        painter.setPen(QPen(colour(theme().line, 0.5), 1))
        for utterance in self._transcript.phonemes:
            painter.drawLine(QLineF(scale.x(utterance.end_s), _RULER_PX, scale.x(utterance.end_s), phones.top()))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for n, (lane, span) in enumerate(zip(self.lanes, spans)):
            for line in reversed(lane.lines):  # A lies above B, and both above the capture
                painter.setPen(side_pen(line.key))
                for piece in self._pieces(line.values, self.lane_area(n), span):
                    painter.drawPolyline(piece)
        said = [(u.phone, u.start_s, u.end_s) for u in self._transcript.phonemes]
        paint_boxes(painter, phones, scale, said, None)
        painter.end()

    def _paint_axis(self, painter: QPainter, n: int) -> tuple[float, float]:
        """Draw the frame of a lane; return the values at its bottom and top."""
        lane, area = self.lanes[n], self.lane_area(n)
        known = np.concatenate([line.values[np.isfinite(line.values)] for line in lane.lines])
        known = known if len(known) else np.zeros(1)
        low, high = rounded_span(0.0 if lane.begins_at_0 else known.min(), known.max())
        painter.setPen(QPen(colour(theme().line), 1))
        painter.drawLine(QLineF(0, area.top(), self.width(), area.top()))
        painter.setPen(colour(theme().text))
        left = QRectF(STEP, area.top() + STEP // 2, _LEFT_PX - STEP, 2 * STEP)
        painter.drawText(left, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop, _fitting(painter, lane.title))
        painter.setPen(colour(theme().dim))
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for value, y in ((high, area.top() + 3 * STEP), (low, area.bottom() - STEP)):
            text = f"{value:g} {lane.unit}".strip()
            painter.drawText(QRectF(0, y - STEP, _LEFT_PX - STEP, 2 * STEP), right, text)
        return low, high

    def _pieces(self, values: np.ndarray, area: QRectF, span: tuple[float, float]) -> list[QPolygonF]:
        """The polylines of one line within the lane; where values are missing it is broken."""
        scale, (low, high) = self.scale, span
        inside = area.adjusted(0, 2 * STEP + 2, 0, -4)
        first, last = (scale.time_s(x) * self._rate_hz for x in (area.left(), area.right()))
        frames = np.arange(max(int(first), 0), min(int(last) + 2, len(values)))
        xs = scale.left_px + (frames / self._rate_hz - scale.start_s) * scale.px_per_s
        ys = inside.bottom() - (values[frames] - low) / (high - low) * inside.height()
        pieces = []
        for run in np.split(np.arange(len(frames)), np.flatnonzero(np.diff(np.isfinite(ys))) + 1):
            if len(run) and np.isfinite(ys[run[0]]):
                pieces.append(QPolygonF([QPointF(x, y) for x, y in zip(xs[run], ys[run])]))
        return pieces

    def _paint_readings(self, painter: QPainter) -> None:
        painter.setFont(small_font())
        metrics = painter.fontMetrics()
        for n, (lane, values) in enumerate(zip(self.lanes, self.readings(self.read_at_s))):
            area = self.lane_area(n)
            x = area.left() + STEP
            for key, value in values:
                shown = texts.UNKNOWN if np.isnan(value) else f"{value:.2f}"
                text = f"{texts.GRAPH_NAMES[key]} {shown} {lane.unit}".strip()
                painter.setPen(side_colour(key))
                painter.drawText(QPointF(x, area.top() + 2 * STEP - 2), text)
                x += metrics.horizontalAdvance(text) + 2 * STEP

    # Reactions

    def _on_playhead_moved(self, time_s: float) -> None:
        scale, area = self.scale, self._phones_area
        if self._zoom > 1.0 and self._pressed is None and not area.left() <= scale.x(time_s) <= area.right():
            self._look_from(time_s)
        self.update()

    def _look_from(self, start_s: float) -> None:
        self._start_s = min(max(start_s, 0.0), self._duration_s * (1 - 1 / self._zoom))
        self.renew()

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for room for four lanes."""
        return QSize(900, _RULER_PX + _PHONES_PX + 4 * _LANE_PX)

    def resizeEvent(self, event) -> None:
        """Paint anew."""
        super().resizeEvent(event)
        self.focus_ring.fit()
        self.renew()

    def paintEvent(self, _event) -> None:
        """Paint the kept picture, the values, and the playhead over it."""
        with QPainter(self) as painter:
            if not self.lanes:
                painter.fillRect(self.rect(), colour(theme().canvas))
                return
            if self._picture is None:
                ratio = self.devicePixelRatioF()
                self._picture = QPixmap(self.size() * ratio)
                self._picture.setDevicePixelRatio(ratio)
                self._paint_still(self._picture)
            painter.drawPixmap(0, 0, self._picture)
            self._paint_readings(painter)
            scale, area = self.scale, self._phones_area
            whole = QRectF(area.left(), 0, area.width(), self.height())
            if self._hovered_s is not None:
                painter.setPen(QPen(colour(theme().dim, 0.7), 1))
                painter.drawLine(QLineF(scale.x(self._hovered_s), 0, scale.x(self._hovered_s), self.height()))
            x = scale.x(self._authoring.view.playhead_s)
            if whole.left() - 1 <= x <= whole.right() + 1:
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                paint_playhead(painter, whole, x)

    def _time_at(self, x: float) -> float:
        return min(max(self.scale.time_s(x), 0.0), self._duration_s)

    def mousePressEvent(self, event) -> None:
        """Take the playhead to the pointer."""
        if event.button() == Qt.MouseButton.LeftButton and self.lanes:
            self._pressed = event.position()
            self._authoring.seek(self._time_at(event.position().x()))

    def mouseMoveEvent(self, event) -> None:
        """Read values, or drag the playhead with its sound."""
        at = event.position()
        self._hovered_s = self._time_at(at.x()) if self.lanes and at.x() >= _LEFT_PX else None
        if self._pressed is not None and abs(at.x() - self._pressed.x()) >= _DRAG_PX:
            self._authoring.scrub(self._time_at(at.x()))
        self.update()

    def mouseReleaseEvent(self, _event) -> None:
        """Let the playhead go."""
        if self._pressed is not None:
            self._pressed = None
            self._authoring.end_scrub()

    def leaveEvent(self, _event) -> None:
        """Read at the playhead again."""
        self._hovered_s = None
        self.update()

    def wheelEvent(self, event) -> None:
        """Zoom about the pointer."""
        at_s, before = self._time_at(event.position().x()), self._zoom
        factor = _ZOOM_PER_STEP ** (event.angleDelta().y() / _STEP_ANGLE)
        self._zoom = min(max(before * factor, 1.0), _LONGEST_ZOOM)
        self._look_from(at_s - (at_s - self._start_s) * before / self._zoom)


def _fitting(painter: QPainter, text: str) -> str:
    return painter.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, _LEFT_PX - STEP)
