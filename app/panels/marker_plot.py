"""Where one marker goes and how fast, synthesised and captured (Deng and Neumann 2008, figures 15 and 16)."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QVBoxLayout, QWidget

from app import texts
from app.emotion_colours import emotion_colours
from app.panels.pane import Choice, label
from app.theme import STEP, colour, theme
from core.synthesis.marker_motion import MarkerMotion

_AXES = ("x", "y", "z")
_HEIGHT_PX = 150


class MarkerPlot(QWidget):
    """Two curves over time, of one marker along one axis; a click asks for that moment.

    time_asked(seconds) : a moment was clicked
    """

    time_asked = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumHeight(_HEIGHT_PX)
        self._synthesised: MarkerMotion | None = None
        self._captured: MarkerMotion | None = None
        column = QVBoxLayout(self)
        column.setContentsMargins(STEP, 0, STEP, 0)
        column.setSpacing(0)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        self.marker = QComboBox(toolTip=texts.PLOT_MARKER_TIP)
        self.marker.setProperty("role", "small")
        self.axis = Choice([(axis, axis, texts.PLOT_AXIS_TIP) for axis in _AXES])
        self.axis.choose("y")
        self.legend = label("", tip=texts.PLOT_LEGEND_TIP)
        self.legend.setTextFormat(Qt.TextFormat.RichText)
        for widget in (self.marker, self.axis):
            row.addWidget(widget)
        row.addStretch(1)
        row.addWidget(self.legend)
        column.addLayout(row)
        self._graphs = pg.GraphicsLayoutWidget()
        column.addWidget(self._graphs, 1)
        self._plots = [self._graphs.addPlot(row=i, col=0) for i in range(2)]
        self._playheads = []
        for plot, unit in zip(self._plots, (texts.PLOT_PLACE, texts.PLOT_SPEED)):
            plot.setMenuEnabled(False)
            plot.hideButtons()
            plot.setMouseEnabled(x=False, y=False)
            plot.setLabel("left", unit)
            plot.getAxis("left").setWidth(6 * STEP)
            line = pg.InfiniteLine(0.0, 90)
            plot.addItem(line, ignoreBounds=True)
            self._playheads.append(line)
        self._plots[1].setXLink(self._plots[0])
        self._plots[0].hideAxis("bottom")
        self._captured_curves = [plot.plot() for plot in self._plots]
        self._synthesised_curves = [plot.plot() for plot in self._plots]
        self.dress()
        emotion_colours.changed.connect(self.dress)
        self.marker.currentIndexChanged.connect(lambda _: self._draw())
        self.axis.group.idClicked.connect(lambda _: self._draw())
        self._graphs.scene().sigMouseClicked.connect(self._on_clicked)

    def show_motion(self, synthesised: MarkerMotion | None, captured: MarkerMotion | None) -> None:
        """Show other motion; the lower lip is chosen first, the paper's marker 79."""
        self._synthesised, self._captured = synthesised, captured
        names = () if synthesised is None else synthesised.markers.names
        if tuple(self.marker.itemText(i) for i in range(self.marker.count())) != names:
            self.marker.blockSignals(True)
            self.marker.clear()
            self.marker.addItems(list(names))
            lip = None if synthesised is None else synthesised.markers.landmark("lower_lip")
            self.marker.setCurrentIndex(0 if lip is None else lip)
            self.marker.blockSignals(False)
        self._show_legend()
        self._draw()

    def dress(self) -> None:
        """Take the colours of the theme in use."""
        t = theme()
        self._graphs.setBackground(colour(t.canvas))
        for plot in self._plots:
            for side in ("left", "bottom"):
                plot.getAxis(side).setPen(colour(t.line))
                plot.getAxis(side).setTextPen(colour(t.dim))
        pens = (
            (self._playheads, pg.mkPen(colour(t.accent), width=1)),
            (self._captured_curves, pg.mkPen(colour(t.text), width=1, style=Qt.PenStyle.DashLine)),
            (self._synthesised_curves, pg.mkPen(colour(t.accent), width=1.6)),
        )
        for lines, pen in pens:
            for line in lines:
                line.setPen(pen)
        self._show_legend()

    def _show_legend(self) -> None:
        mark = f"<span style='color:{theme().accent}'>━ {texts.PLOT_SYNTHESISED}</span>"
        beside = f" &nbsp; <span style='color:{theme().text}'>╌ {texts.PLOT_CAPTURED}</span>"
        self.legend.setText(mark + (beside if self._captured is not None else ""))

    def show_time(self, time_s: float) -> None:
        """Move the playhead."""
        for line in self._playheads:
            line.setValue(time_s)

    def _draw(self) -> None:
        marker, axis = self.marker.currentIndex(), _AXES.index(self.axis.key)
        for motion, curves in ((self._captured, self._captured_curves), (self._synthesised, self._synthesised_curves)):
            if motion is None or marker < 0:
                for curve in curves:
                    curve.clear()
                continue
            place_mm, speed = trajectory(motion, marker, axis)
            times_s = np.arange(len(place_mm)) / motion.rate_hz
            curves[0].setData(times_s, place_mm)
            curves[1].setData(times_s, speed)

    def _on_clicked(self, event) -> None:
        self.time_asked.emit(float(self._plots[0].vb.mapSceneToView(event.scenePos()).x()))


def trajectory(motion: MarkerMotion, marker: int, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Return displacement from rest (mm) and velocity (mm/s, central differences) of a marker along an axis."""
    place_mm = motion.positions[:, marker, axis].astype(float) - motion.markers.rest[marker, axis]
    speed = np.gradient(place_mm) * motion.rate_hz if len(place_mm) > 1 else np.zeros_like(place_mm)
    return place_mm, speed
