"""How late the face is, as measured: capture, look-ahead, compute and frame, and drop-outs."""

from __future__ import annotations

from collections import deque

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QWidget

from app.panels.pane import label
from app.texts import live as texts
from app.theme import STEP
from core.iface.speech_features import RATE_HZ

_LATELY = 2 * RATE_HZ


class DelayTable(QWidget):
    """Medians of the last two seconds."""

    def __init__(self) -> None:
        super().__init__()
        self.setToolTip(texts.DELAY_TIP)
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(2 * STEP)
        grid.setVerticalSpacing(2)
        self.values = []
        for row, (name, tip) in enumerate(zip(texts.DELAY_PARTS, texts.DELAY_PART_TIPS)):
            value = label(texts.NO_DELAY, tip=tip)
            value.setAlignment(Qt.AlignmentFlag.AlignRight)
            grid.addWidget(label(name, tip=tip), row, 0)
            grid.addWidget(value, row, 1)
            self.values.append(value)
        self.total = label("", "")
        self.total.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.drops = label("", tip=texts.DROPS_TIP)
        self.drops.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignBottom)
        grid.addWidget(self.total, 0, 2, 2, 1)
        grid.addWidget(self.drops, 2, 2, 2, 1)
        grid.setColumnStretch(2, 1)
        self._parts: deque[tuple[float, float, float, float]] = deque(maxlen=_LATELY)

    def forget(self) -> None:
        """Begin anew, as with another source."""
        self._parts.clear()
        self.renew(0)

    def add(self, capture_s: float, look_ahead_s: float, compute_s: float, frame_s: float) -> None:
        """Take the parts of one frame that was painted."""
        self._parts.append((capture_s, look_ahead_s, compute_s, frame_s))

    @property
    def has_parts(self) -> bool:
        """Whether a frame was painted."""
        return bool(self._parts)

    @property
    def median_ms(self) -> float | None:
        """The whole delay, None while nothing was painted."""
        return 1000.0 * float(np.median(np.sum(self._parts, axis=1))) if self._parts else None

    def renew(self, n_drops: int) -> None:
        """Show the figures of the moment."""
        whole = self.median_ms
        self.total.setText("" if whole is None else texts.DELAY_TOTAL.format(ms=whole))
        self.drops.setText("" if whole is None else texts.DROPS.format(n=n_drops))
        medians = [None] * 4 if whole is None else np.median(np.array(self._parts), axis=0) * 1000.0
        for value, median in zip(self.values, medians):
            value.setText(texts.NO_DELAY if median is None else f"{median:.1f} ms")
