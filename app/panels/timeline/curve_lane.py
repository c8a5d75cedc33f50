"""The lane of the polish curve: how much of the motion of one region of the face, over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen, QPolygonF

from app import texts
from app.editing import new_gesture
from app.panels.timeline.lanes import TimeScale
from app.theme import colour, theme
from core.synthesis.polish import Curve, Polish

if TYPE_CHECKING:
    from app.panels.timeline.timeline import Timeline

LANE = "curve"
_HIGHEST_GAIN = 2.0  # shown; 1 is the middle
_KEY_PX, _REACH_PX = 3.5, 7.0
_STEP_PX = 3


def gain_at(area: QRectF, y: float) -> float:
    """Return the gain at a height of the lane, 0..2."""
    share = (area.bottom() - y) / area.height()
    return round(min(max(share, 0.0), 1.0) * _HIGHEST_GAIN, 2)


def y_of(area: QRectF, gain: float) -> float:
    """Inverse of `gain_at`, within the lane."""
    return area.bottom() - min(gain / _HIGHEST_GAIN, 1.0) * area.height()


def key_at(area: QRectF, scale: TimeScale, keys: Curve, at: QPointF) -> int | None:
    """Return the key under the pointer, or None."""
    apart = [np.hypot(scale.x(time_s) - at.x(), y_of(area, gain) - at.y()) for time_s, gain in keys]
    nearest = int(np.argmin(apart)) if apart else None
    return nearest if nearest is not None and apart[nearest] <= _REACH_PX else None


def paint_curve(painter: QPainter, area: QRectF, scale: TimeScale, polish: Polish, region: str, end_s: float) -> None:
    """The curve through its keys, over the line of what was found."""
    area = area.adjusted(0, 3, 0, -3)
    left, right = max(area.left(), scale.x(0.0)), min(area.right(), scale.x(end_s))
    if right <= left:
        return
    middle = y_of(area, 1.0)
    painter.setPen(QPen(colour(theme().line), 1))
    painter.drawLine(QLineF(left, middle, right, middle))
    keys = polish.curves.get(region, ())
    if not keys:
        return
    xs = np.arange(left, right, _STEP_PX)
    gains = polish.gain(region, scale.start_s + (xs - scale.left_px) / scale.px_per_s)
    line = QPolygonF([QPointF(x, y_of(area, gain)) for x, gain in zip(xs, gains)])
    painter.setPen(QPen(colour(theme().accent), 1.4))
    painter.drawPolyline(line)
    painter.setBrush(colour(theme().canvas))
    for time_s, gain in keys:
        painter.drawEllipse(QPointF(scale.x(time_s), y_of(area, gain)), _KEY_PX, _KEY_PX)
    painter.setBrush(Qt.BrushStyle.NoBrush)


class DragKey:
    """Moves one key of the curve; pressed where there is none, it makes one."""

    def __init__(self, timeline: Timeline, at: QPointF) -> None:
        self._timeline, self._gesture = timeline, new_gesture()
        keys = list(self._polish.curves.get(self._region, ()))
        grabbed = key_at(self._area, timeline.scale, tuple(keys), at)
        self._before = self._polish
        self._others = tuple(key for i, key in enumerate(keys) if i != grabbed)
        if grabbed is None:
            self.move(at)

    def move(self, at: QPointF) -> None:
        """See `app.panels.timeline.gestures.Gesture`."""
        time_s = min(max(self._timeline.scale.time_s(at.x()), 0.0), self._timeline.duration_s)
        key = round(time_s, 3), gain_at(self._area, at.y())
        self._set(self._polish.with_curve(self._region, (*self._others, key)))

    def release(self, at: QPointF) -> None:
        """See `app.panels.timeline.gestures.Gesture`."""

    def cancel(self) -> None:
        """See `app.panels.timeline.gestures.Gesture`."""
        self._set(self._before)

    def paint(self, painter: QPainter) -> None:
        """See `app.panels.timeline.gestures.Gesture`."""

    @property
    def _polish(self) -> Polish:
        return self._timeline.authoring.document.polish

    @property
    def _region(self) -> str:
        return self._timeline.region

    @property
    def _area(self) -> QRectF:
        return self._timeline.lanes()[LANE].adjusted(0, 3, 0, -3)

    def _set(self, polish: Polish) -> None:
        label = texts.EDIT_CURVE.format(region=self._region)
        self._timeline.authoring.set_polish(polish, label, self._gesture)


def remove_key(timeline: Timeline, at: QPointF) -> None:
    """Take the key under the pointer away."""
    polish, region = timeline.authoring.document.polish, timeline.region
    keys = polish.curves.get(region, ())
    grabbed = key_at(timeline.lanes()[LANE].adjusted(0, 3, 0, -3), timeline.scale, keys, at)
    if grabbed is not None:
        kept = tuple(key for i, key in enumerate(keys) if i != grabbed)
        timeline.authoring.set_polish(polish.with_curve(region, kept), texts.EDIT_CURVE.format(region=region))
