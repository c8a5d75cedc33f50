"""What each slot costs, and what it would cost to say it otherwise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from PySide6.QtCore import QRectF
from PySide6.QtGui import QColor, QPainter

from app.panels.timeline.lanes import TimeScale
from app.theme import colour, theme

# Terms of a slot's cost in the order in which they are stacked.
TERMS = ("observation", "position", "velocity", "smoothing", "viseme", "no_predecessor", "emotion")
_SHADE = {
    "observation": 0.9, "position": 0.85, "velocity": 0.65, "smoothing": 0.45, "viseme": 0.3, "no_predecessor": 0.3,
    "emotion": 0.9,
}  # fmt: skip
_LEAST_PX = 1.0


def term_colour(term: str) -> QColor:
    """Return the colour of a cost term: joins in shades of the accent, the phone dim, emotions red."""
    if term == "observation":
        css = theme().dim
    elif term == "emotion":
        css = theme().emotion["anger"]
    else:
        css = theme().accent
    return colour(css, _SHADE[term])


def paint_costs(
    painter: QPainter, area: QRectF, scale: TimeScale, slots: Sequence[tuple[float, float]],
    breakdown: Sequence[Mapping[str, float]],
) -> None:  # fmt: skip
    """One stacked bar a slot, on the scale of the dearest.

    slots : (start_s, end_s); breakdown : cost by term, in the same order
    """
    dearest = max((sum(row.values()) for row in breakdown), default=0.0)
    if dearest <= 0.0:
        return
    for (start_s, end_s), row in zip(slots, breakdown):
        left, right = scale.x(start_s) + 0.5, scale.x(end_s) - 0.5
        if right < area.left() or left > area.right():
            continue
        bottom = area.bottom() - 1
        for term in TERMS:
            height = row.get(term, 0.0) / dearest * (area.height() - 3)
            if height > 0.0:
                painter.fillRect(QRectF(left, bottom - height, max(right - left, 1.0), height), term_colour(term))
                bottom -= height


def paint_prices(
    painter: QPainter, area: QRectF, scale: TimeScale, slots: Sequence[tuple[float, float]], prices: np.ndarray,
    unit: float,
) -> None:  # fmt: skip
    """One bar a slot: what the next best node would add; low where the choice hardly matters.

    prices : float64, shape (n_slots,), NaN where there is no other node; unit : the price of a full bar
    """
    for (start_s, end_s), price in zip(slots, prices):
        left, right = scale.x(start_s) + 0.5, scale.x(end_s) - 0.5
        if right < area.left() or left > area.right() or not np.isfinite(price):
            continue
        height = max(min(price / unit, 1.0) * (area.height() - 3), _LEAST_PX)
        bar = QRectF(left, area.bottom() - 1 - height, max(right - left, 1.0), height)
        painter.fillRect(bar, colour(theme().text, 0.45))
