"""The strip below the panes: what is said and when, and where the playhead is."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QPainter, QPixmap
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app import texts
from app.authoring import Authoring
from app.panels.timeline.lanes import TimeScale, paint_boxes, paint_emotions, paint_playhead, paint_selection
from app.panels.timeline.ruler import Ruler, paint_ruler
from app.panels.timeline.wave import Peaks, paint_wave
from app.theme import STEP, colour, small_font, theme
from core.document.change import Change
from core.media.audio import Audio
from core.progress import Progress
from core.speech.phoneme import PAU

_NAMES_PX = 9 * STEP
_RULER_PX, _WAVE_PX, _BOX_PX, _EMOTION_PX = 22, 56, 24, 24
_RIGHT_PX = 2 * STEP
_ZOOM_PER_STEP = 1.25
_STEP_ANGLE = 120.0
_DRAG_PX = 4
_NARROWEST_S = 0.05


class Timeline(QWidget):
    """Lanes over one time axis. Click selects an utterance and moves the playhead, drag scrubs, wheel zooms."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self._authoring = authoring
        self._peaks: Peaks | None = None
        self._start_s, self._shown_s = 0.0, 1.0
        self._pressed_at: float | None = None
        self._dragging = False
        self._lanes_picture: QPixmap | None = None  # painted once; only the playhead moves sixty times a second
        self.setStatusTip(texts.TIMELINE_TIP)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumHeight(_RULER_PX + 32 + 2 * _BOX_PX + _EMOTION_PX)
        authoring.document.changed.connect(self.on_document_changed)
        authoring.view.slot_selected.connect(self.renew)
        authoring.view.playhead_moved.connect(self.on_playhead_moved)

    @property
    def duration_s(self) -> float:
        """Length of the speech."""
        speech = self._authoring.document.speech
        return 0.0 if speech is None else speech.transcript.duration_s

    @property
    def scale(self) -> TimeScale:
        """Where times are on screen now."""
        width = max(self.width() - _NAMES_PX - _RIGHT_PX, 1)
        return TimeScale(self._start_s, width / self._shown_s, _NAMES_PX)

    def lanes(self) -> dict[str, QRectF]:
        """Return the area of each lane; the wave takes what height is left."""
        left, right = _NAMES_PX, self.width() - _RIGHT_PX
        heights = {"ruler": _RULER_PX, "wave": 0, "words": _BOX_PX, "phonemes": _BOX_PX, "emotion": _EMOTION_PX}
        heights["wave"] = max(self.height() - sum(heights.values()) - STEP // 2, 24)
        areas, top = {}, 0
        for name, height in heights.items():
            areas[name] = QRectF(left, top, right - left, height)
            top += height
        return areas

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other speech, emotions or pins."""
        if change & Change.ALIGNMENT:
            self._peaks = None
            self.zoom_all()
            speech = self._authoring.document.speech
            if speech is not None:
                self._authoring.jobs.start("peaks", "", speech.audio, _peaks, self._show_peaks)
        self.renew()

    def renew(self) -> None:
        """Paint the lanes anew."""
        self._lanes_picture = None
        self.update()

    def on_playhead_moved(self, time_s: float) -> None:
        """Move the playhead; while it plays beyond the edge, turn the page."""
        if self._authoring.player.is_playing and not self._start_s <= time_s <= self._start_s + self._shown_s:
            self._look_at(time_s, self._shown_s)
        self.update()

    def _show_peaks(self, peaks: Peaks) -> None:
        self._peaks = peaks
        self.renew()

    # Looking

    def zoom_all(self) -> None:
        """Show all of the speech."""
        self._look_at(0.0, max(self.duration_s, _NARROWEST_S))

    def zoom(self, factor: float, around_s: float | None = None) -> None:
        """Show everything ``factor`` times as wide; ``around_s`` (or the playhead) stays where it is."""
        around_s = self._authoring.view.playhead_s if around_s is None else around_s
        shown_s = min(max(self._shown_s / factor, _NARROWEST_S), max(self.duration_s, _NARROWEST_S))
        self._look_at(around_s - (around_s - self._start_s) * shown_s / self._shown_s, shown_s)

    def _look_at(self, start_s: float, shown_s: float) -> None:
        self._shown_s = shown_s
        self._start_s = min(max(start_s, 0.0), max(self.duration_s - shown_s, 0.0))
        self.renew()

    def _slot_at(self, x: float) -> int | None:
        return self._authoring.view.slot_at(min(max(self.scale.time_s(x), 0.0), self.duration_s))

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for room for all lanes."""
        return QSize(800, _RULER_PX + _WAVE_PX + 2 * _BOX_PX + _EMOTION_PX + STEP // 2)

    def resizeEvent(self, event) -> None:
        """Paint the lanes anew."""
        super().resizeEvent(event)
        self.renew()

    def paintEvent(self, _event) -> None:
        """Paint the kept picture of the lanes, and the playhead over it."""
        painter = QPainter(self)
        if self._authoring.document.speech is None:
            painter.fillRect(self.rect(), colour(theme().canvas))
            painter.setPen(colour(theme().dim))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, texts.TIMELINE_EMPTY)
            return
        if self._lanes_picture is None:
            ratio = self.devicePixelRatioF()
            self._lanes_picture = QPixmap(self.size() * ratio)
            self._lanes_picture.setDevicePixelRatio(ratio)
            self._paint_lanes(self._lanes_picture)
        painter.drawPixmap(0, 0, self._lanes_picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        area = self._time_area()
        x = self.scale.x(self._authoring.view.playhead_s)
        if area.left() - 1 <= x <= area.right() + 1:
            paint_playhead(painter, area, x)

    def _time_area(self) -> QRectF:
        return QRectF(_NAMES_PX, 0, self.width() - _NAMES_PX - _RIGHT_PX, self.height())

    def _paint_lanes(self, picture: QPixmap) -> None:
        picture.fill(colour(theme().canvas))
        painter = QPainter(picture)
        document, view = self._authoring.document, self._authoring.view
        lanes, scale, transcript = self.lanes(), self.scale, document.speech.transcript
        self._paint_names(painter, lanes)
        area = self._time_area()
        painter.setClipRect(area)
        if view.slot is not None:
            chosen = transcript.phonemes[view.slot]
            paint_selection(painter, area, scale.x(chosen.start_s), scale.x(chosen.end_s))
        paint_ruler(painter, lanes["ruler"], scale, self.duration_s, Ruler())
        if self._peaks is not None:
            paint_wave(painter, lanes["wave"], scale, self._peaks, self.duration_s)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        words = [(w.word, w.start_s, w.end_s) for w in transcript.words]
        paint_boxes(painter, lanes["words"], scale, words, None)
        phones = [(u.phone, u.start_s, u.end_s) for u in transcript.phonemes]
        paint_boxes(painter, lanes["phonemes"], scale, phones, view.slot, frozenset(document.pins))
        paint_emotions(painter, lanes["emotion"], scale, document.modifiers, self.duration_s)
        painter.end()

    def _paint_names(self, painter: QPainter, lanes: dict[str, QRectF]) -> None:
        painter.setFont(small_font())
        names = {"wave": texts.LANE_WAVE, "words": texts.LANE_WORDS, "phonemes": texts.LANE_PHONEMES,
                 "emotion": texts.LANE_EMOTION}  # fmt: skip
        for key, name in names.items():
            area = lanes[key]
            painter.setPen(colour(theme().dim))
            painter.drawText(
                QRectF(STEP + 4, area.top(), _NAMES_PX, area.height()), Qt.AlignmentFlag.AlignVCenter, name
            )
            painter.setPen(colour(theme().line, 0.6))
            painter.drawLine(0, round(area.top()), self.width(), round(area.top()))

    def mousePressEvent(self, event) -> None:
        """Wait whether this is a click or a drag."""
        if event.button() == Qt.MouseButton.LeftButton and self._authoring.document.speech is not None:
            self._pressed_at, self._dragging = event.position().x(), False

    def mouseMoveEvent(self, event) -> None:
        """Scrub."""
        if self._pressed_at is None:
            return
        x = event.position().x()
        if abs(x - self._pressed_at) >= _DRAG_PX:
            self._dragging = True
        if self._dragging:
            self._authoring.seek(self.scale.time_s(x))

    def mouseReleaseEvent(self, event) -> None:
        """Select what was clicked."""
        if self._pressed_at is not None and not self._dragging:
            x = event.position().x()
            slot = self._slot_at(x)
            if slot is not None and x >= _NAMES_PX - _DRAG_PX:
                self._authoring.select_slot(slot, self.scale.time_s(x))
        self._pressed_at, self._dragging = None, False

    def wheelEvent(self, event) -> None:
        """Zoom around the pointer; with Shift, or sideways, move."""
        across, along = event.angleDelta().x() / _STEP_ANGLE, event.angleDelta().y() / _STEP_ANGLE
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            across, along = across + along, 0.0
        if across:
            self._look_at(self._start_s - 0.12 * across * self._shown_s, self._shown_s)
        if along:
            self.zoom(_ZOOM_PER_STEP**along, self.scale.time_s(event.position().x()))
        event.accept()

    def event(self, event) -> bool:
        """Say in the tooltip what is under the pointer."""
        if event.type() == event.Type.ToolTip:
            self._describe(event)
            return True
        return super().event(event)

    def _describe(self, event) -> None:
        speech = self._authoring.document.speech
        slot = None if speech is None else self._slot_at(event.pos().x())
        if slot is None or event.pos().x() < _NAMES_PX:
            QToolTip.hideText()
            return
        utterance = speech.transcript.phonemes[slot]
        phone = texts.SILENCE if utterance.phone == PAU else f"/{utterance.phone}/"
        text = texts.UTTERANCE.format(phone=phone, milliseconds=1000 * (utterance.end_s - utterance.start_s))
        if slot in self._authoring.document.pins:
            text += "\n" + texts.PINNED.format(node=self._authoring.document.pins[slot])
        QToolTip.showText(event.globalPos(), text, self)


def _peaks(audio: Audio, _progress: Progress) -> Peaks:
    return Peaks.of(audio)
