"""The page of polish: more or less of what the search found, laid over it."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QLabel, QSlider

from app import texts
from app.authoring import Authoring
from app.editing import new_gesture
from app.panels.fold import FoldedPage
from app.panels.pane import Choice, label
from app.theme import STEP
from core.document.change import Change
from core.synthesis.polish import NO_POLISH, REGIONS

_STEPS_A_GAIN = 50
_HIGHEST_GAIN = 2.0
_STICKS_WITHIN = 2  # steps about 1, or nobody would find it again


class PolishPage(FoldedPage):
    """Sliders for the whole, and which region's curve the timeline shows.

    region_chosen(region) : the curve of another region is to be shown
    """

    region_chosen = Signal(str)

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.POLISH, texts.POLISH_TIP, texts.WEIGHTS_RESET, texts.POLISH_RESET_TIP)
        self._authoring = authoring
        self._gesture: int | None = None
        self.reset.clicked.connect(lambda: authoring.set_polish(NO_POLISH, texts.EDIT_POLISH_RESET))
        grid = QGridLayout(self.body)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(STEP // 2)
        self.sliders: dict[str, QSlider] = {}
        self._values: dict[str, QLabel] = {}
        for row, (name, (title, tip)) in enumerate(texts.POLISH_GAINS.items()):
            slider = QSlider(Qt.Orientation.Horizontal, minimum=0, maximum=round(_STEPS_A_GAIN * _HIGHEST_GAIN),
                             toolTip=tip)  # fmt: skip
            slider.setValue(_STEPS_A_GAIN)
            slider.sliderPressed.connect(self._begin)
            slider.sliderReleased.connect(self._end)
            slider.valueChanged.connect(lambda place, of=name: self.on_moved(of, place))
            value = label("", "small", tip)
            value.setMinimumWidth(4 * STEP)
            value.setAlignment(Qt.AlignmentFlag.AlignRight)
            for column, widget in enumerate((label(title, "small", tip), slider, value)):
                grid.addWidget(widget, row, column)
            self.sliders[name], self._values[name] = slider, value
        grid.addWidget(label(texts.POLISH_CURVE, "small", texts.POLISH_CURVE_TIP), len(self.sliders), 0)
        self.region = Choice([(region, region, texts.POLISH_CURVE_TIP) for region in REGIONS])
        self.region.choose(REGIONS[0])
        self.region.group.idClicked.connect(lambda _: self.region_chosen.emit(self.region.key))
        grid.addWidget(self.region, len(self.sliders), 1, 1, 2)
        self.column.addWidget(self.body)
        authoring.document.changed.connect(self.on_document_changed)
        self.on_document_changed(Change.POLISH, None)

    def on_moved(self, name: str, place: int) -> None:
        """Lay another gain over the motion; a drag is one entry of the menu."""
        gain = 1.0 if abs(place - _STEPS_A_GAIN) <= _STICKS_WITHIN else place / _STEPS_A_GAIN
        polish = replace(self._authoring.document.polish, **{name: gain})
        title = texts.POLISH_GAINS[name][0]
        self._authoring.set_polish(polish, texts.EDIT_POLISH.format(name=title), self._gesture)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show the gains of the project."""
        if not change & Change.POLISH:
            return
        polish = self._authoring.document.polish
        self.reset.setEnabled(polish != NO_POLISH)
        for name, slider in self.sliders.items():
            gain = getattr(polish, name)
            self._values[name].setText(f"{gain:.2f}")
            if not slider.isSliderDown():
                slider.blockSignals(True)
                slider.setValue(round(_STEPS_A_GAIN * gain))
                slider.blockSignals(False)

    def _begin(self) -> None:
        self._gesture = new_gesture()

    def _end(self) -> None:
        self._gesture = None
        self.on_document_changed(Change.POLISH, None)
