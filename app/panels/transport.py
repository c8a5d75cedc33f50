"""Buttons, slider and time of something that plays."""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QSlider, QStyle, QStyleOptionSlider, QToolButton, QWidget

from app import texts
from app.icons import put_icon
from app.panels.pane import label
from app.theme import STEP

_PER_SECOND = 1000


class TimeSlider(QSlider):
    """A slider that goes where it is clicked."""

    def __init__(self) -> None:
        super().__init__(Qt.Orientation.Horizontal)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)

    def mousePressEvent(self, event) -> None:
        """Jump to the pointer, then drag."""
        if event.button() == Qt.MouseButton.LeftButton:
            option = QStyleOptionSlider()
            self.initStyleOption(option)
            handle = self.style().subControlRect(
                QStyle.ComplexControl.CC_Slider, option, QStyle.SubControl.SC_SliderHandle, self
            )
            span = max(self.width() - handle.width(), 1)
            at = round(event.position().x() - handle.width() / 2)
            self.setSliderDown(True)
            self.setSliderPosition(QStyle.sliderValueFromPosition(self.minimum(), self.maximum(), at, span))
        super().mousePressEvent(event)


class Transport(QWidget):
    """Asks for playback; shows what it is told.

    play_asked(), step_asked(frames), end_asked(is_end), seek_asked(seconds) : what the animator did
    """

    play_asked = Signal()
    step_asked = Signal(int)
    end_asked = Signal(bool)
    seek_asked = Signal(float)

    def __init__(self, play_tip: str) -> None:
        super().__init__()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self._duration_s = 0.0
        self.play_button = self._button("play", play_tip, self.play_asked.emit)
        row.addWidget(self._button("to_start", texts.TO_START_TIP, lambda: self.end_asked.emit(False)))
        row.addWidget(self._button("step_back", texts.BACK_TIP, lambda: self.step_asked.emit(-1)))
        row.addWidget(self.play_button)
        row.addWidget(self._button("step_forward", texts.FORWARD_TIP, lambda: self.step_asked.emit(1)))
        row.addWidget(self._button("to_end", texts.TO_END_TIP, lambda: self.end_asked.emit(True)))
        row.addSpacing(STEP)
        self.slider = TimeSlider()
        self.slider.setMinimumWidth(40)
        self.slider.valueChanged.connect(self._on_slider_moved)
        row.addWidget(self.slider, 1)
        row.addSpacing(STEP)
        self.time = label("")
        self.time.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(self.time)

    def set_duration(self, duration_s: float) -> None:
        """Set the length of what plays."""
        self._duration_s = duration_s
        self.slider.blockSignals(True)
        self.slider.setRange(0, round(_PER_SECOND * duration_s))
        self.slider.blockSignals(False)
        self.setEnabled(duration_s > 0)

    def show_time(self, time_s: float, fps: float, fps_name: str) -> None:
        """Show where it stands."""
        if not self.slider.isSliderDown():
            self.slider.blockSignals(True)
            self.slider.setValue(round(_PER_SECOND * time_s))
            self.slider.blockSignals(False)
        minutes, seconds = divmod(max(time_s, 0.0), 60.0)
        frame, frames = int(time_s * fps + 1e-6), max(int(self._duration_s * fps + 1e-6), 0)
        text = f"{int(minutes):02d}:{seconds:06.3f}   f {frame}/{frames}"
        if text != self.time.text():
            self.time.setText(text)
            self.time.setToolTip(texts.TIME_TIP.format(fps=fps_name))

    def show_playing(self, playing: bool) -> None:
        """Show whether it plays."""
        put_icon(self.play_button, "pause" if playing else "play")

    def _button(self, name: str, tip: str, asked) -> QToolButton:
        button = QToolButton(toolTip=tip)
        put_icon(button, name)
        button.setIconSize(QSize(16, 16))
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.clicked.connect(lambda: asked())
        return button

    def _on_slider_moved(self, value: int) -> None:
        self.seek_asked.emit(value / _PER_SECOND)
