"""How much so many units cover, as a curve for each set, with a dot at the number that is chosen."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.texts import units as texts
from app.theme import STEP, colour, small_font, theme

_HEIGHT_PX, _AXIS_PX, _MOST_UNITS, _DOT_PX = 132, 42, 12, 3.0
_AT_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class CoverageCurve(QWidget):
    """Units from 0 to twelve (or the most that is chosen) to the right, their share of the variance upwards."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(_HEIGHT_PX)
        self.setToolTip(texts.CURVE_TIP)
        self._shares: Mapping[str, np.ndarray] = {}
        self._counts: Mapping[str, int] = {}

    def show_shares(self, shares: Mapping[str, np.ndarray], counts: Mapping[str, int]) -> None:
        """Show a curve for each set, see `core.iface.coverage.covered_by_count`, and how many units it has."""
        self._shares, self._counts = shares, counts
        self.update()

    def point(self, n_units: int, share: float) -> QPointF:
        """Return where a share stands in the widget."""
        plot = self._plot()
        return QPointF(plot.left() + plot.width() * n_units / self._most, plot.bottom() - plot.height() * share)

    @property
    def _most(self) -> int:
        return max([_MOST_UNITS, *self._counts.values()])

    def _plot(self) -> QRectF:
        return QRectF(self.rect()).adjusted(_AXIS_PX, STEP, -STEP, -2 * STEP - 4)

    # Qt

    def paintEvent(self, _event) -> None:
        """Draw the axes, the curves and the dots."""
        if not self._shares:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(small_font())
        plot = self._plot()
        for share in (0.0, 0.5, 1.0):
            y = self.point(0, share).y()
            painter.setPen(QPen(colour(theme().line), 1))
            painter.drawLine(QPointF(plot.left(), y), QPointF(plot.right(), y))
            painter.setPen(colour(theme().dim))
            beside = QRectF(0, y - STEP, _AXIS_PX - 4, 2 * STEP)
            painter.drawText(beside, _AT_RIGHT, f"{100 * share:.0f} %")
        for n in range(0, self._most + 1, max(2, 2 * (self._most // 12))):
            x = self.point(n, 0.0).x()
            painter.drawText(QRectF(x - 2 * STEP, plot.bottom() + 2, 4 * STEP, 2 * STEP), Qt.AlignmentFlag.AlignHCenter,
                             str(n))  # fmt: skip
        for name, shares in self._shares.items():
            painter.setPen(QPen(colour(theme().emotion[name]), 1.5))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawPolyline(QPolygonF([self.point(n, s) for n, s in enumerate(shares[: self._most + 1])]))
            count = self._counts[name]
            painter.setBrush(colour(theme().emotion[name]))
            painter.drawEllipse(self.point(count, shares[min(count, len(shares) - 1)]), _DOT_PX, _DOT_PX)
        painter.end()
