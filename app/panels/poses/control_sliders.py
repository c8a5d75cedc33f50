"""The controls of a rig as sliders, to be searched by name."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QLineEdit, QScrollArea, QSlider, QVBoxLayout, QWidget

from app.editing import new_gesture
from app.panels.pane import ElidedLabel, label, toggle
from app.texts import poses as texts
from app.theme import STEP

_STEPS = 100
_SEEN = 0.5 / _STEPS
_NAME_PX, _VALUE_PX = 168, 32


class ControlSlider(QSlider):
    """0 to 1 in hundredths; the wheel scrolls the list instead."""

    def __init__(self, tip: str) -> None:
        super().__init__(Qt.Orientation.Horizontal, minimum=0, maximum=_STEPS, toolTip=tip)
        self.setPageStep(_STEPS // 10)

    def wheelEvent(self, event) -> None:
        """Leave it to the list."""
        event.ignore()


class ControlSliders(QWidget):
    """moved(name, value, gesture) : a slider was moved; gesture is a number for a drag, else None."""

    moved = Signal(str, float, object)

    def __init__(self) -> None:
        super().__init__()
        self.sliders: dict[str, ControlSlider] = {}
        self._rows: dict[str, tuple[QWidget, ...]] = {}
        self._values: dict[str, QLabel] = {}
        self._shown = np.zeros(0)
        self._gesture: int | None = None
        self.search = QLineEdit(placeholderText=texts.SEARCH, toolTip=texts.SEARCH_TIP, clearButtonEnabled=True)
        self.used = toggle(texts.USED, texts.USED_TIP, lambda _: self._filter())
        self.search.textChanged.connect(lambda _: self._filter())
        self._area = QScrollArea(widgetResizable=True)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        row = QHBoxLayout()
        row.addWidget(self.search, 1)
        row.addWidget(self.used)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(STEP)
        column.addLayout(row)
        column.addWidget(self._area, 1)

    @property
    def visible_names(self) -> tuple[str, ...]:
        """The controls that the search leaves."""
        return tuple(name for name, row in self._rows.items() if not row[0].isHidden())

    def show_controls(self, names: tuple[str, ...]) -> None:
        """Make sliders for the controls of a rig."""
        if names == tuple(self.sliders):
            return
        self.sliders, self._rows, self._values = {}, {}, {}
        scrolled = QWidget(objectName="scrolled")
        grid = QGridLayout(scrolled)
        grid.setContentsMargins(0, 0, STEP, 0)
        grid.setHorizontalSpacing(STEP)
        grid.setVerticalSpacing(STEP // 2)
        for row, name in enumerate(names):
            shown, slider, value = ElidedLabel(), ControlSlider(name), label("", "small")
            shown.setText(name)
            shown.setFixedWidth(_NAME_PX)
            value.setFixedWidth(_VALUE_PX)
            value.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            slider.setAccessibleName(name)
            slider.sliderPressed.connect(self._begin)
            slider.sliderReleased.connect(self._end)
            slider.valueChanged.connect(lambda place, of=name: self.moved.emit(of, place / _STEPS, self._gesture))
            self._rows[name] = (shown, slider, value)
            for column, widget in enumerate(self._rows[name]):
                grid.addWidget(widget, row, column)
            self.sliders[name], self._values[name] = slider, value
        grid.setRowStretch(len(names), 1)
        self._area.setWidget(scrolled)
        self._shown = np.zeros(len(names))
        self._filter()

    def show_values(self, values: np.ndarray | None) -> None:
        """Show a pose, values in the order of the controls; None for none that could be moved."""
        self._shown = np.zeros(len(self.sliders)) if values is None else np.asarray(values)
        self._area.setEnabled(values is not None)
        for (name, slider), value in zip(self.sliders.items(), self._shown):
            self._values[name].setText(f"{value:.2f}" if value >= _SEEN else "–")
            slider.blockSignals(True)
            slider.setValue(round(_STEPS * value))
            slider.blockSignals(False)
        if self._gesture is None:
            self._filter()

    def _filter(self) -> None:
        words = self.search.text().lower().split()
        for (name, row), value in zip(self._rows.items(), self._shown):
            fits = all(word in name.lower() for word in words) and (not self.used.isChecked() or bool(value >= _SEEN))
            for widget in row:
                widget.setVisible(fits)

    def _begin(self) -> None:
        self._gesture = new_gesture()

    def _end(self) -> None:
        self._gesture = None
        self._filter()
