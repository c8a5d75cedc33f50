"""How many units: by the share that they shall cover, or by hand; and what they cover."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDoubleSpinBox, QHBoxLayout, QSpinBox, QVBoxLayout, QWidget

from app.panels.pane import Choice, label
from app.texts import units as texts
from app.theme import STEP

_MOST = 60
_SHARE, _COUNT = texts.BY_SHARE[0], texts.BY_COUNT[0]


class HowMany(QWidget):
    """asked() : another number of units is wanted, see `how_many`."""

    asked = Signal()

    def __init__(self, title: str, share: float, count: int, by_share: bool) -> None:
        super().__init__()
        self.choice = Choice([texts.BY_SHARE, texts.BY_COUNT])
        self.share = QDoubleSpinBox(minimum=1.0, maximum=99.99, decimals=2, value=100.0 * share, suffix=" %",
                                    toolTip=texts.SHARE_TIP, singleStep=0.5)  # fmt: skip
        self.count = QSpinBox(minimum=1, maximum=_MOST, value=count, toolTip=texts.COUNT_TIP)
        self.covered = label()
        self.covered.setWordWrap(True)
        for box in (self.share, self.count):
            box.setKeyboardTracking(False)
            box.setFixedWidth(9 * STEP)
            # the platform's arrows do not show on our ground
            box.setStyleSheet("::up-button, ::down-button { width: 0; border: none; }")
            box.valueChanged.connect(lambda _: self.asked.emit())
        row = QHBoxLayout()
        row.setSpacing(STEP)
        for widget in (self.choice, self.share, self.count):
            row.addWidget(widget)
        row.addStretch(1)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(STEP // 2)
        column.addWidget(label(title, "plain"))
        column.addLayout(row)
        column.addWidget(self.covered)
        self.choice.group.button(0 if by_share else 1).setChecked(True)
        self.choice.group.idClicked.connect(self._on_choice)
        self._show_boxes()

    @property
    def how_many(self) -> int | float:
        """A number of units, or the share (below 1) that they shall cover."""
        return self.share.value() / 100.0 if self.choice.key == _SHARE else self.count.value()

    def show_covered(self, sentence: str, count: int, share: float) -> None:
        """Say what so many units cover; the way that is not chosen starts from there."""
        self.covered.setText(sentence)
        for box, value in ((self.share, 100.0 * share), (self.count, count)):
            if box.isHidden():
                box.blockSignals(True)
                box.setValue(value)
                box.blockSignals(False)

    def _on_choice(self, _id: int) -> None:
        self._show_boxes()
        self.asked.emit()

    def _show_boxes(self) -> None:
        self.share.setVisible(self.choice.key == _SHARE)
        self.count.setVisible(self.choice.key == _COUNT)
