"""Sliders in a list that can be replaced as a whole: names, values with a unit, and a middle to return to."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QScrollArea, QSlider, QVBoxLayout, QWidget

from app.panels.pane import ElidedLabel, label
from app.theme import STEP

_NAME_PX, _VALUE_PX = 96, 56


class ValueSlider(QSlider):
    """A number in steps; a double click puts it back to 0, and the wheel scrolls the list instead.

    set_to(value) : it was moved by hand
    """

    set_to = Signal(float)

    def __init__(self, lowest: float, highest: float, step: float, tip: str) -> None:
        super().__init__(Qt.Orientation.Horizontal, minimum=round(lowest / step), maximum=round(highest / step),
                         toolTip=tip)  # fmt: skip
        self._step = step
        self.setPageStep(max(1, (self.maximum() - self.minimum()) // 10))
        self.valueChanged.connect(lambda place: self.set_to.emit(place * step))

    def show_value(self, value: float) -> None:
        """Stand where ``value`` is, or at the end that is nearest to it, and tell nobody."""
        self.blockSignals(True)
        self.setValue(int(np.clip(round(value / self._step), self.minimum(), self.maximum())))
        self.blockSignals(False)

    def mouseDoubleClickEvent(self, _event) -> None:
        """Go back to 0."""
        self.setValue(0)

    def wheelEvent(self, event) -> None:
        """Leave it to the list."""
        event.ignore()


class SliderList(QWidget):
    """moved(row, value) : a slider was moved by hand."""

    moved = Signal(int, float)

    def __init__(self, step: float, tip: str, in_words: Callable[[float], str]) -> None:
        super().__init__()
        self.sliders: list[ValueSlider] = []
        self.values: list[QLabel] = []
        self._step, self._tip, self._in_words = step, tip, in_words
        self._made_for: tuple = ()
        self._area = QScrollArea(widgetResizable=True)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self._area)

    def show_values(self, names: Sequence[str], values: np.ndarray, lowest: float, highest: float) -> None:
        """Show so many sliders between two ends; a value beyond them is told by its number."""
        if self._made_for != (made_for := (tuple(names), lowest, highest)):
            self._made_for = made_for
            self._make(names, lowest, highest)
        for slider, shown, value in zip(self.sliders, self.values, values):
            slider.show_value(float(value))
            shown.setText(self._in_words(float(value)))

    def _make(self, names: Sequence[str], lowest: float, highest: float) -> None:
        self.sliders, self.values = [], []
        scrolled = QWidget(objectName="scrolled")
        grid = QGridLayout(scrolled)
        grid.setContentsMargins(0, 0, STEP, 0)
        grid.setHorizontalSpacing(STEP)
        grid.setVerticalSpacing(STEP // 2)
        for row, name in enumerate(names):
            shown, slider = ElidedLabel(), ValueSlider(lowest, highest, self._step, self._tip)
            shown.setText(name)
            shown.setFixedWidth(_NAME_PX)
            value = label("", "small")
            value.setFixedWidth(_VALUE_PX)
            value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            slider.setAccessibleName(name)
            slider.set_to.connect(lambda to, row=row: self.moved.emit(row, to))
            for column, widget in enumerate((shown, slider, value)):
                grid.addWidget(widget, row, column)
            self.sliders.append(slider)
            self.values.append(value)
        grid.setRowStretch(len(names), 1)
        self._area.setWidget(scrolled)
