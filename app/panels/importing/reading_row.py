"""What is said of files that do not tell it themselves: rate, unit, axes, and names of weights."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
from PySide6.QtWidgets import QComboBox, QDoubleSpinBox, QFileDialog, QHBoxLayout, QPushButton, QWidget

from app.panels.importing.draft import ImportDraft
from app.panels.pane import label
from app.settings import last_folder, window_settings
from app.texts import importing as texts
from app.theme import STEP
from core.importing.plan import Reading, axes_matrix
from core.motion.length_units import MM_PER_UNIT

_FOLDER = "captures"
_ARRAY = ".npy"


class ReadingRow(QWidget):
    """Changes `core.importing.plan.Reading` of the draft."""

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__()
        self._draft = draft
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(STEP)
        self.rate = QDoubleSpinBox(
            decimals=3, minimum=0.0, maximum=1000.0, suffix=" Hz", toolTip=texts.READING_RATE_TIP
        )
        self.rate.setSpecialValueText(texts.AS_FILED)
        self.unit, self.axes = QComboBox(toolTip=texts.READING_UNIT_TIP), QComboBox(toolTip=texts.READING_AXES_TIP)
        self.unit.addItem(texts.AS_FILED, None)
        for unit in MM_PER_UNIT:
            self.unit.addItem(unit, unit)
        for axes in _turns():
            self.axes.addItem(" · ".join(axes), axes)
        self.names = QPushButton(texts.READING_NAMES, toolTip=texts.READING_NAMES_TIP)
        self.sheet = QPushButton(texts.READING_SHEET, toolTip=texts.READING_SHEET_TIP)
        for widget in (label(texts.READING_RATE, "plain"), self.rate, label(texts.READING_UNIT, "plain"), self.unit,
                       label(texts.READING_AXES, "plain"), self.axes, self.names, self.sheet):  # fmt: skip
            row.addWidget(widget)
        row.addStretch(1)
        self.rate.editingFinished.connect(lambda: self._change(rate_hz=self.rate.value() or None))
        self.unit.activated.connect(lambda _: self._change(unit=self.unit.currentData()))
        self.axes.activated.connect(lambda _: self._change(axes=tuple(self.axes.currentData())))
        self.names.clicked.connect(lambda: self._ask("shape_names", texts.READING_NAMES, texts.FILTER_NAMES))
        self.sheet.clicked.connect(lambda: self._ask("shape_sheet", texts.READING_SHEET, texts.FILTER_SHEET))

    def renew(self) -> None:
        """Show what the plan says."""
        reading = self._draft.plan.reading
        self.rate.setValue(reading.rate_hz or 0.0)
        self.unit.setCurrentIndex(max(self.unit.findData(reading.unit), 0))
        self.axes.setCurrentIndex(self.axes.findText(" · ".join(reading.axes)))
        is_array = any(s.motion.lower().endswith(_ARRAY) for s in self._draft.sentences)
        for button in (self.names, self.sheet):
            button.setVisible(is_array)

    def _change(self, **fields: object) -> None:
        if self._draft.plan is not None:
            self._draft.set_reading(replace(self._draft.plan.reading, **fields))

    def _ask(self, field: str, title: str, pattern: str) -> None:
        name, _ = QFileDialog.getOpenFileName(self, title, last_folder(window_settings(), _FOLDER), pattern)
        if name:
            self._change(**{field: name})


def _turns() -> list[tuple[str, str, str]]:
    """All ways to turn a capture; mirrored ones are none. As captured comes first."""
    signed = [[f"{sign}{axis}" for sign in ("", "-")] for axis in "xyz"]
    every = [turn for order in itertools.permutations(signed) for turn in itertools.product(*order)]
    turns = [turn for turn in every if np.linalg.det(axes_matrix(turn)) > 0]
    return sorted(turns, key=lambda turn: turn != Reading().axes)
