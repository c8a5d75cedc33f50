"""The two views side by side: the scan or a photo, and the generic face or what was made of it."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QSlider, QStackedWidget, QToolButton

from app.panels.own_face.point_view import PhotoView, PointView
from app.panels.own_face.work import Fitted, OpenedScan, StillFace
from app.panels.pane import Choice, ElidedLabel, Pane, label
from app.texts import own_face as texts
from core.face.characters import CHARACTERS

_STEPS = 100
_SHAPES_PX = 150
_GENERIC, _FITTED, _DISTANCE = (option[0] for option in (texts.SHOW_GENERIC, texts.SHOW_FITTED, texts.SHOW_DISTANCE))


class ScanPane(Pane):
    """Left: the scan, or a photo of the same person."""

    def __init__(self) -> None:
        self.view, self.photo_view = PointView(), PhotoView()
        self._both = QStackedWidget()
        self._both.addWidget(self.view)
        self._both.addWidget(self.photo_view)
        super().__init__(texts.SCAN, self._both, texts.NO_SCAN)
        self.shown = Choice([texts.ON_PHOTO, texts.ON_SCAN])
        self.shown.group.idClicked.connect(lambda _: self.refresh())
        self.header.addWidget(self.shown)
        self.open_button = QToolButton(text=texts.OPEN_SCAN, toolTip=texts.OPEN_SCAN_TIP)
        self.photo_button = QToolButton(text=texts.OPEN_PHOTO, toolTip=texts.OPEN_PHOTO_TIP)
        self.over_button = QToolButton(text=texts.TURN_OVER, toolTip=texts.TURN_OVER_TIP)
        self.round_button = QToolButton(text=texts.TURN_ROUND, toolTip=texts.TURN_ROUND_TIP)
        for button in (self.open_button, self.photo_button):
            self.footer.addWidget(button)
        self.footer.addStretch(1)
        for button in (self.over_button, self.round_button):
            self.footer.addWidget(button)
        self._scan: OpenedScan | None = None
        self._has_photo = False

    @property
    def on_photo(self) -> bool:
        """Whether points are set on the photo now."""
        return self.shown.key == texts.ON_PHOTO[0]

    def show_scan(self, scan: OpenedScan | None) -> None:
        """Show another scan."""
        if scan is not None and scan is not self._scan:
            self.view.show_still(scan.still)
            self.info.setText(scan.path.name)
        self._scan = scan
        self.refresh()

    def show_photo(self, photo: np.ndarray | None) -> None:
        """Show another photo, or none."""
        self._has_photo = photo is not None
        self.photo_view.show_photo(photo)
        if self._has_photo and not self.on_photo:
            self.shown.choose(texts.ON_PHOTO[0])
        self.refresh()

    def refresh(self) -> None:
        """Show what there is of what is asked for."""
        on_photo = self.on_photo
        self._both.setCurrentIndex(int(on_photo))
        if on_photo and not self._has_photo:
            self.show_empty(texts.NO_PHOTO)
        elif not on_photo and self._scan is None:
            self.show_empty(texts.NO_SCAN)
        else:
            self.show_content()
        for button in (self.over_button, self.round_button):
            button.setEnabled(self._scan is not None and not on_photo)


class FacePane(Pane):
    """Right: the generic face with its points, the fitted face, or what is left between it and the scan.

    changed() : another one of them is shown
    """

    changed = Signal()

    def __init__(self) -> None:
        self.view = PointView()
        super().__init__(texts.GENERIC, self.view, texts.OPENING_GENERIC + "…")
        self.characters = QComboBox(toolTip=texts.GENERIC_TIP)
        self.characters.setProperty("role", "small")
        for name, character in CHARACTERS.items():
            self.characters.addItem(character.description.split(",")[0].split(":")[0], name)
        self.shown = Choice([texts.SHOW_FITTED, texts.SHOW_DISTANCE, texts.SHOW_GENERIC])
        self.shown.group.idClicked.connect(lambda _: self.refresh())
        self.header.addWidget(self.shown)
        self.header.addWidget(self.characters)
        self.shapes = QComboBox(toolTip=texts.SHAPE_TIP)
        self.shapes.setProperty("role", "small")
        self.shapes.setMinimumWidth(_SHAPES_PX)
        self.strength = QSlider(Qt.Orientation.Horizontal, minimum=0, maximum=_STEPS, toolTip=texts.SHAPE_TIP)
        self.strength.setFixedWidth(120)
        self.strength.setAccessibleName(texts.SHAPE)
        self.distance = ElidedLabel()
        self.footer.addWidget(label(texts.SHAPE))
        self.footer.addWidget(self.shapes)
        self.footer.addWidget(self.strength)
        self.footer.addWidget(self.distance, 1)
        self.shapes.activated.connect(lambda _: self._on_shape())
        self.strength.valueChanged.connect(lambda _: self._pose())
        self._generic: StillFace | None = None
        self._fitted: Fitted | None = None
        self._drawn: object = None
        self.show_fitted(None)

    @property
    def on_generic(self) -> bool:
        """Whether the generic face is shown."""
        return self.shown.key == _GENERIC

    def show_generic(self, still: StillFace) -> None:
        """Show another generic face."""
        self._generic = still
        self.characters.setCurrentIndex(self.characters.findData(still.face.name))
        self.refresh()

    def show_fitted(self, fitted: Fitted | None) -> None:
        """Show another fitted face, or go back to the generic one."""
        is_new = fitted is not None and fitted is not self._fitted
        self._fitted = fitted
        for name in (_FITTED, _DISTANCE):
            self.shown.button(name).setEnabled(fitted is not None)
        if is_new:
            names = fitted.shown.rig.names
            if [self.shapes.itemText(n) for n in range(self.shapes.count())] != list(names):
                self.shapes.clear()
                self.shapes.addItems(names)
                self.shapes.setCurrentText("jawOpen")
            left = fitted.own.closed
            self.distance.setText(texts.LEFT_OVER.format(median=left.median, p95=left.p95))
            self.distance.setToolTip(texts.LEFT_OVER_TIP.format(covered=left.covered))
            self.strength.setValue(0)
            if self.on_generic:
                self.shown.choose(_FITTED)
        elif fitted is None:
            self.distance.setText("")
            if not self.on_generic:
                self.shown.choose(_GENERIC)
        self.refresh()

    def refresh(self) -> None:
        """Show what is asked for."""
        shaped = {_FITTED: "shown", _DISTANCE: "distance"}.get(self.shown.key)
        wanted = self._generic if shaped is None or self._fitted is None else getattr(self._fitted, shaped)
        for widget in (self.shapes, self.strength):
            widget.setEnabled(wanted is not None and wanted is not self._generic)
        if wanted is None:
            return
        if wanted is not self._drawn:
            self._drawn = wanted
            if wanted is self._generic:
                self.view.show_still(wanted)
            else:
                self.view.show_shaped(wanted)
                self._pose()
        self.show_content()
        self.changed.emit()

    def _on_shape(self) -> None:
        if self.strength.value() == 0:
            self.strength.setValue(_STEPS)
        self._pose()

    def _pose(self) -> None:
        if self._fitted is None or self._drawn is self._generic:
            return
        values = np.zeros(len(self._fitted.shown.rig.names))
        if self.shapes.currentIndex() >= 0:
            values[self.shapes.currentIndex()] = self.strength.value() / _STEPS
        self.view.show_pose(values)
