"""The dominance functions under the curves: which phoneme's shape wins, moment by moment."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from app.panels.timeline.lanes import TimeScale
from app.panels.timeline.shown_curves import FoundCurves
from app.theme import STEP, THEMES, colour, small_font, theme
from core.speech.phoneme import PAU, PHONEME_INDEX

_STEP_PX = 2
_GOLDEN = 0.618034  # neighbours in the list of phonemes get hues far apart


def phoneme_colour(phone: str, alpha: float = 1.0) -> QColor:
    """Return the colour that a phoneme has everywhere in the curves; silence is grey."""
    is_dark = theme().canvas == THEMES["dark"].canvas
    lightness = 0.64 if is_dark else 0.42
    saturation = 0.0 if phone == PAU else 0.55
    return QColor.fromHslF((PHONEME_INDEX[phone] * _GOLDEN) % 1.0, saturation, lightness, alpha)


def paint_dominances(
    painter: QPainter, area: QRectF, scale: TimeScale, curves: FoundCurves, hovered: int | None
) -> None:
    """Each phoneme's share as a hill in its colour; the one under the pointer stands out."""
    shares, said = curves.ruling.shares, curves.transcript.phonemes
    rate_hz = curves.found.rate_hz
    left, right = max(area.left(), scale.x(0.0)), min(area.right(), scale.x((shares.shape[1] - 1) / rate_hz))
    if right <= left:
        return
    xs = np.arange(left, right, _STEP_PX)
    frames = (scale.start_s + (xs - scale.left_px) / scale.px_per_s) * rate_hz
    room = area.height() - 4
    for j, utterance in enumerate(said):
        begin, stop = curves.reigns[j]
        rows = slice(*np.searchsorted(frames, (begin - 1, stop + 1)))
        if begin == stop or rows.start == rows.stop:
            continue
        heights = np.interp(frames[rows], np.arange(begin, stop), shares[j, begin:stop])
        line = [QPointF(x, area.bottom() - height * room) for x, height in zip(xs[rows], heights)]
        hill = QPolygonF([QPointF(line[0].x(), area.bottom()), *line, QPointF(line[-1].x(), area.bottom())])
        faded = hovered is not None and hovered != j
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(phoneme_colour(utterance.phone, 0.08 if faded else 0.55 if hovered == j else 0.26))
        painter.drawPolygon(hill)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(phoneme_colour(utterance.phone, 0.35 if faded else 1.0), 2.0 if hovered == j else 1.2))
        painter.drawPolyline(QPolygonF(line))
    _paint_names(painter, area, scale, curves, hovered)


def _paint_names(painter: QPainter, area: QRectF, scale: TimeScale, curves: FoundCurves, hovered: int | None) -> None:
    """Each phoneme within its hill, over all hills, where there is room."""
    painter.setFont(small_font())
    metrics = painter.fontMetrics()
    for j, utterance in enumerate(curves.transcript.phonemes):
        left, right = scale.x(utterance.start_s), scale.x(utterance.end_s)
        middle = min(round((utterance.start_s + utterance.end_s) / 2 * curves.found.rate_hz), len(curves.found) - 1)
        hill_px = curves.ruling.shares[j, middle] * (area.height() - 4)
        fits = metrics.horizontalAdvance(utterance.phone) + 2 < right - left and hill_px > metrics.height()
        if utterance.phone != PAU and (fits or hovered == j):
            painter.setPen(colour(theme().text, 1.0 if hovered in (None, j) else 0.35))
            box = QRectF(left - STEP, area.bottom() - hill_px + 1, right - left + 2 * STEP, metrics.height())
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, utterance.phone)


def paint_asked(painter: QPainter, scale: TimeScale, curves: FoundCurves, control: str, y_of) -> None:
    """A dash at the middle of each phoneme: where it alone would hold the control.

    y_of : value to height
    """
    values = curves.ruling.asked[:, curves.found.names.index(control)]
    for utterance, value in zip(curves.transcript.phonemes, values):
        middle = scale.x((utterance.start_s + utterance.end_s) / 2)
        half = min(max((utterance.end_s - utterance.start_s) * scale.px_per_s * 0.3, 3.0), 14.0)
        painter.setPen(QPen(phoneme_colour(utterance.phone, 0.9), 2.5))
        painter.drawLine(QLineF(middle - half, y_of(value), middle + half, y_of(value)))


def ruler_at(curves: FoundCurves, time_s: float) -> int | None:
    """Return the phoneme that rules a moment, or None beyond the curves."""
    frame = round(time_s * curves.found.rate_hz)
    if curves.ruling is None or not 0 <= frame < curves.ruling.shares.shape[1]:
        return None
    return int(curves.ruling.shares[:, frame].argmax())
