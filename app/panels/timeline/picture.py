"""The still picture of all lanes; only the playhead and a drag are painted over it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QPainter, QPixmap

from app import texts
from app.panels.timeline.curve_lane import paint_curve
from app.panels.timeline.lanes import paint_boxes, paint_changed, paint_emotions, paint_locks, paint_selection
from app.panels.timeline.ruler import paint_ruler
from app.panels.timeline.strips import paint_costs, paint_prices
from app.panels.timeline.wave import paint_spectrogram, paint_wave
from app.theme import STEP, colour, small_font, theme

if TYPE_CHECKING:
    from app.panels.timeline.timeline import Timeline

_NAMES = {
    "wave": texts.LANE_WAVE, "words": texts.LANE_WORDS, "phonemes": texts.LANE_PHONEMES,
    "emotion": texts.LANE_EMOTION, "curve": texts.LANE_CURVE, "cost": texts.LANE_COST, "price": texts.LANE_PRICE,
}  # fmt: skip


def paint_lanes(timeline: Timeline, picture: QPixmap) -> None:
    """Paint everything that changes only with the document, the zoom or the selection."""
    picture.fill(colour(theme().canvas))
    painter = QPainter(picture)
    document, view = timeline.authoring.document, timeline.authoring.view
    lanes, scale, end_s = timeline.lanes(), timeline.scale, timeline.duration_s
    transcript = document.speech.transcript
    slots = [(u.start_s, u.end_s) for u in transcript.phonemes]
    _paint_names(painter, timeline, lanes)
    area = timeline.time_area()
    painter.setClipRect(area)
    if view.span is not None:
        first, last = view.span
        paint_selection(painter, area, scale.x(slots[first][0]), scale.x(slots[last][1]))
    paint_ruler(painter, lanes["ruler"], scale, end_s, timeline.ruler)
    if timeline.heard.spectrogram is not None:
        paint_spectrogram(painter, lanes["wave"], scale, timeline.heard.spectrogram, end_s)
    if timeline.heard.peaks is not None:
        paint_wave(
            painter, lanes["wave"], scale, timeline.heard.peaks, end_s, faint=timeline.heard.spectrogram is not None
        )
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    words = [(w.word, w.start_s, w.end_s) for w in transcript.words]
    paint_boxes(painter, lanes["words"], scale, words, None)
    paint_locks(painter, lanes["phonemes"], scale, [slots[p] for p in document.locks])
    phones = [(u.phone, u.start_s, u.end_s) for u in transcript.phonemes]
    paint_boxes(painter, lanes["phonemes"], scale, phones, view.slot, frozenset(document.pins))
    paint_changed(painter, lanes["phonemes"], scale, [slots[p] for p in timeline.authoring.changed_slots])
    paint_emotions(painter, lanes["emotion"], scale, document.modifiers, end_s)
    paint_curve(painter, lanes["curve"], scale, document.polish, timeline.region, end_s)
    if document.has_no_path:
        painter.setFont(small_font())
        painter.setPen(colour(theme().dim))
        painter.drawText(lanes["cost"].adjusted(STEP, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, texts.NO_STRIP)
    if document.breakdown is not None and len(document.breakdown) == len(slots):
        paint_costs(painter, lanes["cost"], scale, slots, document.breakdown)
    prices = document.next_best_prices
    if prices is not None and len(prices) == len(slots):
        finite = prices[np.isfinite(prices)]
        unit = float(np.quantile(finite, 0.95)) if len(finite) else 1.0
        paint_prices(painter, lanes["price"], scale, slots, prices, max(unit, 1e-9))
    painter.end()


def _paint_names(painter: QPainter, timeline: Timeline, lanes: dict[str, QRectF]) -> None:
    painter.setFont(small_font())
    for key, name in _NAMES.items():
        area = lanes[key]
        painter.setPen(colour(theme().dim))
        box = QRectF(STEP + 4, area.top(), area.left(), area.height())
        painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, name.format(region=timeline.region))
        painter.setPen(colour(theme().line, 0.6))
        painter.drawLine(0, round(area.top()), timeline.width(), round(area.top()))
