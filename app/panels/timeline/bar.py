"""The row above the lanes: brush, snapping, spectrogram, units, zoom."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import QHBoxLayout, QSplitter, QToolButton, QVBoxLayout, QWidget

from app import texts
from app.emotion_colours import emotion_colours
from app.panels.pane import Choice, label
from app.panels.timeline.control_page import ControlPage
from app.panels.timeline.ruler import UNITS
from app.panels.timeline.snapping import FREE, PHONEMES, WORDS
from app.panels.timeline.timeline import Timeline
from app.texts import curves as curve_texts
from app.theme import STEP, theme
from core.speech.emotion import EMOTIONS

_ZOOM = 1.5
_DOT_PX = 10
_WAVE_KEPT_PX = 2 * STEP


class TimelinePane(QWidget):
    """The timeline with its bar."""

    def __init__(self, timeline: Timeline) -> None:
        super().__init__()
        self.timeline = timeline
        self._own_before_px = 0
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.bar = TimelineBar(timeline)
        column.addWidget(self.bar)
        column.addWidget(timeline, 1)
        self.curves = ControlPage(timeline)
        column.addWidget(self.curves)
        self.bar.curves.toggled.connect(self.open_curves)

    def open_curves(self, is_open: bool) -> None:
        """Show the control curves or put them away; the panes above and the wave give the room, and get it back."""
        splitter = self.parentWidget()
        before = splitter.sizes() if isinstance(splitter, QSplitter) else None
        self.curves.open(is_open)
        if before is None:
            return
        if is_open:
            self._own_before_px = before[1]
            own = self.minimumSizeHint().height() - self.curves.minimumSizeHint().height()
            own += self.curves.sizeHint().height() + _WAVE_KEPT_PX
        else:
            own = self._own_before_px
        own = min(own, sum(before) - splitter.widget(0).minimumSizeHint().height())
        splitter.setSizes([sum(before) - own, own])


class TimelineBar(QWidget):
    """Shows and sets how the timeline is worked on."""

    def __init__(self, timeline: Timeline) -> None:
        super().__init__()
        self._timeline = timeline
        self.setFixedHeight(4 * STEP)
        row = QHBoxLayout(self)
        row.setContentsMargins(STEP + 4, 0, STEP, 0)
        row.setSpacing(STEP)
        row.addWidget(label(texts.TIMELINE, "title"))
        row.addSpacing(STEP)
        row.addWidget(label(texts.BRUSH, tip=texts.BRUSH_TIP))
        brushes = [
            (emotion, texts.ERASE if emotion == "neutral" else emotion, texts.BRUSH_KEYS.format(key=e + 1))
            for e, emotion in enumerate(EMOTIONS)
        ]
        self.brush = Choice(brushes)
        for emotion in EMOTIONS:
            button = self.brush.button(emotion)
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.brush.choose(timeline.brush)
        self.brush.group.idClicked.connect(lambda e: timeline.set_brush(EMOTIONS[e]))
        row.addWidget(self.brush)
        row.addSpacing(STEP)
        row.addWidget(label(texts.SNAP, tip=texts.SNAP_TIP))
        self.snap = Choice([(FREE, texts.SNAP_FREE, texts.SNAP_TIP), (PHONEMES, texts.LANE_PHONEMES, texts.SNAP_TIP),
                            (WORDS, texts.LANE_WORDS, texts.SNAP_TIP)])  # fmt: skip
        self.snap.choose(timeline.snap)
        self.snap.group.idClicked.connect(lambda _: timeline.set_snap(self.snap.key))
        row.addWidget(self.snap)
        row.addStretch(1)
        self.spectrogram = self._button(texts.SPECTROGRAM, texts.SPECTROGRAM_TIP, timeline.heard.want_spectrogram)
        self.spectrogram.setCheckable(True)
        row.addWidget(self.spectrogram)
        self.curves = self._button(curve_texts.TOGGLE, curve_texts.TOGGLE_TIP, lambda _: None)
        self.curves.setCheckable(True)
        row.addWidget(self.curves)
        self.units = Choice([(unit, texts.UNITS[unit], texts.UNITS_TIP) for unit in UNITS])
        self.units.choose(timeline.ruler.unit)
        self.units.group.idClicked.connect(lambda _: timeline.set_unit(self.units.key))
        row.addWidget(self.units)
        row.addSpacing(STEP)
        row.addWidget(self._button("−", texts.ZOOM_OUT_TIP, lambda: timeline.zoom(1 / _ZOOM)))
        row.addWidget(self._button("+", texts.ZOOM_IN_TIP, lambda: timeline.zoom(_ZOOM)))
        row.addWidget(self._button(texts.ZOOM_ALL, texts.ZOOM_ALL_TIP, timeline.zoom_all))
        timeline.brush_changed.connect(self._show_brush)
        emotion_colours.changed.connect(self.show_colours)
        self.show_colours()

    def _button(self, text: str, tip: str, done) -> QToolButton:
        button = QToolButton(text=text, toolTip=tip)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.clicked.connect(lambda checked=False: done(checked) if button.isCheckable() else done())
        return button

    def show_colours(self) -> None:
        """Give each brush the colour of its emotion."""
        for emotion in EMOTIONS:
            self.brush.button(emotion).setIcon(_dot(theme().emotion[emotion], hollow=emotion == "neutral"))

    def _show_brush(self, emotion: str) -> None:
        self.brush.button(emotion).setChecked(True)


def _dot(css: str, hollow: bool) -> QIcon:
    picture = QPixmap(2 * _DOT_PX, 2 * _DOT_PX)
    picture.setDevicePixelRatio(2.0)
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QColor(css))
    if not hollow:
        painter.setBrush(QColor(css))
    painter.drawEllipse(1, 1, _DOT_PX - 2, _DOT_PX - 2)
    painter.end()
    return QIcon(picture)
