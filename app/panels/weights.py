"""The page of weights: what the search minds most, as sliders that it answers while they move."""

from __future__ import annotations

import math
from dataclasses import fields, replace

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QSlider

from app import texts
from app.authoring import Authoring
from app.editing import new_gesture
from app.panels.fold import FoldedPage
from app.panels.pane import label
from app.theme import STEP
from core.document.change import Change
from core.motion.stored_weights import AS_PRINTED, SEARCH
from core.search.weights import SearchWeights
from core.synthesis.registry import PRINTED, weights_of

_STEPS = 200
_DECADES = 2.0  # to either side of the database's weight
BEYOND_THE_PAPER = ("context_before", "context_after", "context_decay", "duration")
_SHARES = ("alpha4", "context_decay")  # between 0 and 1; all others have no upper end


class WeightsPage(FoldedPage):
    """One slider a weight, in its logarithm about the database's; its left end is 0. Folded until it is wanted."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(texts.WEIGHTS, texts.WEIGHTS_TIP, texts.WEIGHTS_RESET, texts.WEIGHTS_RESET_TIP)
        self._authoring = authoring
        self._gesture: int | None = None
        self.reset.clicked.connect(lambda: authoring.set_weights(None, texts.EDIT_WEIGHTS_RESET))
        self.origin = label()
        self.column.addWidget(self.origin)
        grid = QGridLayout(self.body)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(2)
        self.sliders: dict[str, QSlider] = {}
        self._values = {}
        for row, field in enumerate(fields(SearchWeights)):
            name, tip = texts.WEIGHT_NAMES.get(field.name, (field.name, ""))
            slider = QSlider(Qt.Orientation.Horizontal, minimum=0, maximum=_STEPS, pageStep=10, toolTip=tip)
            slider.sliderPressed.connect(self._begin)
            slider.sliderReleased.connect(self._end)
            slider.valueChanged.connect(lambda place, of=field.name: self.on_moved(of, place))
            value = label("", "small", tip)
            value.setAlignment(Qt.AlignmentFlag.AlignRight)
            value.setMinimumWidth(6 * STEP)
            grid.addWidget(label(name, "small", tip), row, 0)
            grid.addWidget(slider, row, 1)
            grid.addWidget(value, row, 2)
            self.sliders[field.name], self._values[field.name] = slider, value
        self.column.addWidget(self.body)
        authoring.document.changed.connect(self.on_document_changed)
        self.on_document_changed(Change.WEIGHTS, None)

    def on_moved(self, name: str, place: int) -> None:
        """Search under what the slider of ``name`` says; a drag is one entry of the menu."""
        weights = self._weights
        if weights is not None:
            changed = replace(weights, **{name: weight_at(name, place, self._own(name))})
            text = texts.EDIT_WEIGHT.format(name=texts.WEIGHT_NAMES.get(name, (name,))[0])
            self._authoring.set_weights(changed, text, self._gesture)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show the weights in use, and whose they are."""
        if not change & (Change.WEIGHTS | Change.NODES | Change.ENGINE):
            return
        document, weights = self._authoring.document, self._weights
        self.setEnabled(weights is not None)
        self.reset.setEnabled(document.weights is not None)
        if weights is None:
            self.origin.setText("")
            return
        tuned = document.database.tuning.get(AS_PRINTED if document.engine == PRINTED else SEARCH)
        if document.weights is not None:
            self.origin.setText(texts.WEIGHTS_OWN)
        elif tuned:
            self.origin.setText(texts.WEIGHTS_TUNED.format(sentences=tuned["sentences"]))
        else:
            self.origin.setText(texts.WEIGHTS_UNTUNED)
        for name, slider in self.sliders.items():
            value = getattr(weights, name)
            slider.setEnabled(document.engine != PRINTED or name not in BEYOND_THE_PAPER)
            self._values[name].setText(f"{value:.3g}")
            if not slider.isSliderDown():
                slider.blockSignals(True)
                slider.setValue(place_of(value, self._own(name)))
                slider.blockSignals(False)

    @property
    def _weights(self) -> SearchWeights | None:
        return None if self._authoring.document.database is None else self._authoring.document.search_weights

    def _own(self, name: str) -> float:
        document = self._authoring.document
        return getattr(weights_of(document.engine, document.database), name)

    def _begin(self) -> None:
        self._gesture = new_gesture()

    def _end(self) -> None:
        self._gesture = None
        self.on_document_changed(Change.WEIGHTS, None)


def weight_at(name: str, place: int, own: float) -> float:
    """Weight at a place of its slider; the middle is the database's ``own``, or 1 where that is 0."""
    if place == 0:
        return 0.0
    value = (own or 1.0) * 10.0 ** (_DECADES * (2.0 * place / _STEPS - 1.0))
    return min(value, 1.0) if name in _SHARES else value


def place_of(value: float, own: float) -> int:
    """Inverse of `weight_at`, as near as the slider comes."""
    if value <= 0:
        return 0
    place = round((math.log10(value / (own or 1.0)) / _DECADES + 1.0) / 2.0 * _STEPS)
    return min(max(place, 1), _STEPS)
