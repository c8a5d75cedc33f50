"""The level of a microphone as a bar, with a line for its peak and a mark for clipping."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QToolButton, QWidget

from app.panels.pane import label
from app.texts import live as texts
from app.theme import STEP, colour, theme

_LOWEST_DB, _HOT_DB = -60.0, -6.0
_HEIGHT_PX = 10


class _Bar(QWidget):
    """Paints decibels of full scale, -60 to 0; what is over -6 is in the accent colour."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(_HEIGHT_PX)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.rms_db = self.peak_db = _LOWEST_DB

    def paintEvent(self, _event) -> None:
        """Draw groove, bar and peak."""
        t, painter = theme(), QPainter(self)
        painter.setPen(Qt.PenStyle.NoPen)
        for from_db, to_db, css in (
            (_LOWEST_DB, 0.0, t.line), (_LOWEST_DB, min(self.rms_db, _HOT_DB), t.text),
            (_HOT_DB, self.rms_db, t.accent), (self.peak_db - 0.4, self.peak_db + 0.4, t.text),
        ):  # fmt: skip
            left, right = self._x(from_db), self._x(to_db)
            if right > left:
                painter.fillRect(QRectF(left, 2, right - left, self.height() - 4), colour(css))
        painter.end()

    def _x(self, db: float) -> float:
        return self.width() * min(1.0, max(0.0, 1.0 - db / _LOWEST_DB))


class Meter(QWidget):
    """Bar, peak in figures, and a mark that stays lit once samples clipped, until it is clicked.

    clip_cleared() : the mark was put out
    """

    clip_cleared = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setToolTip(texts.METER_TIP)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(STEP)
        self._bar = _Bar()
        row.addWidget(self._bar, 1)
        self._value = label()
        self._value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self._value.setFixedWidth(5 * STEP)
        row.addWidget(self._value)
        self.clip = QToolButton(text=texts.CLIPPED, toolTip=texts.CLIP_TIP, checkable=True, enabled=False)
        self.clip.clicked.connect(self._on_clip_clicked)
        row.addWidget(self.clip)
        self.show_level(_LOWEST_DB, _LOWEST_DB)

    def show_level(self, rms_db: float, peak_db: float) -> None:
        """Show a level, decibels of full scale."""
        self._bar.rms_db, self._bar.peak_db = rms_db, peak_db
        self._value.setText(texts.LEVEL_VALUE.format(db=peak_db) if peak_db > _LOWEST_DB else "")
        self._bar.update()

    def light_clip(self, is_lit: bool) -> None:
        """Light the mark of clipping, or put it out."""
        self.clip.setEnabled(is_lit)
        self.clip.setChecked(is_lit)

    def _on_clip_clicked(self) -> None:
        self.light_clip(False)
        self.clip_cleared.emit()
