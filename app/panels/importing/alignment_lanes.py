"""Where words and phones are in a sound, over its spectrogram; boundaries can be dragged."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app.panels.timeline.lanes import TimeScale, paint_boxes, paint_playhead
from app.panels.timeline.ruler import Ruler, paint_ruler
from app.panels.timeline.wave import Peaks, paint_spectrogram, paint_wave
from app.texts import importing as texts
from app.theme import STEP, colour, small_font, theme
from core.errors import UserFacingError
from core.speech.boundaries import with_boundary
from core.speech.phoneme import PAU
from core.speech.second_listening import AlignmentConfidence
from core.speech.spectrogram import Spectrogram
from core.speech.transcript import Transcript

_NAMES_PX = 8 * STEP
_RIGHT_PX = 2 * STEP
_RULER_PX, _WAVE_PX, _WORDS_PX, _PHONES_PX, _DOUBT_PX = 22, 48, 26, 30, 40
_EDGE_PX = 6
_ZOOM_PER_STEP = 1.25
_STEP_ANGLE = 120.0
_NARROWEST_S = 0.1
_NUDGE_S = 0.01


class AlignmentLanes(QWidget):
    """changed(transcript) : a boundary was moved; time_asked(seconds) : a click elsewhere"""

    changed = Signal(object)
    time_asked = Signal(float)

    def __init__(self) -> None:
        super().__init__()
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumHeight(_RULER_PX + _WAVE_PX + _WORDS_PX + _PHONES_PX + _DOUBT_PX + 80)
        self._transcript: Transcript | None = None
        self._before: Transcript | None = None
        self._confidence: AlignmentConfidence | None = None
        self._spectrogram: Spectrogram | None = None
        self._peaks: Peaks | None = None
        self._start_s, self._shown_s = 0.0, 1.0
        self._playhead_s: float | None = None
        self._dragged: int | None = None
        self._chosen: int | None = None

    # What is shown

    def show_sound(self, spectrogram: Spectrogram | None, peaks: Peaks | None) -> None:
        """Show another sound."""
        self._spectrogram, self._peaks = spectrogram, peaks
        self.update()

    def show_transcript(self, transcript: Transcript | None, confidence: AlignmentConfidence | None) -> None:
        """Show another alignment; the view stays where it is for a sound of the same length."""
        known = self._transcript
        self._transcript, self._dragged = transcript, None
        self._confidence = confidence if confidence is not None and transcript is not None and len(
            confidence.shift_s) == len(transcript.phonemes) else None  # fmt: skip
        if transcript is not None and (known is None or known.duration_s != transcript.duration_s):
            self._start_s, self._shown_s, self._chosen = 0.0, max(transcript.duration_s, _NARROWEST_S), None
        self.update()

    @property
    def transcript(self) -> Transcript | None:
        """What is shown."""
        return self._transcript

    @property
    def chosen(self) -> int | None:
        """The boundary that the keys move: the end of this phoneme."""
        return self._chosen

    def show_time(self, time_s: float | None) -> None:
        """Move the playhead, or take it away."""
        self._playhead_s = time_s
        self.update()

    # Where things are

    @property
    def scale(self) -> TimeScale:
        """Where times are on screen."""
        width = max(self.width() - _NAMES_PX - _RIGHT_PX, 1)
        return TimeScale(self._start_s, width / self._shown_s, _NAMES_PX)

    def lanes(self) -> dict[str, QRectF]:
        """Return the area of each lane; the spectrogram takes what height is left."""
        left, width = _NAMES_PX, self.width() - _NAMES_PX - _RIGHT_PX
        heights = {"ruler": _RULER_PX, "wave": _WAVE_PX, "sound": 0, "words": _WORDS_PX, "phones": _PHONES_PX,
                   "doubt": _DOUBT_PX}  # fmt: skip
        heights["sound"] = max(self.height() - sum(heights.values()), 40)
        areas, top = {}, 0.0
        for name, height in heights.items():
            areas[name] = QRectF(left, top, width, height)
            top += height
        return areas

    def boundary_place(self, slot: int) -> QPointF:
        """Return where the end of a phoneme is on screen."""
        lane = self.lanes()["phones"]
        return QPointF(self.scale.x(self._transcript.phonemes[slot].end_s), lane.center().y())

    def _edge_at(self, at: QPointF) -> int | None:
        if self._transcript is None or at.y() < _RULER_PX:
            return None
        ends = np.array([self.scale.x(u.end_s) for u in self._transcript.phonemes[:-1]])
        if self.lanes()["words"].contains(at):  # only those of words
            edges = [e for w in self._transcript.words for e in (w.start_s, w.end_s)]
            near = [min((abs(u.end_s - e) for e in edges), default=1.0) < 2e-3 for u in self._transcript.phonemes[:-1]]
            ends = np.where(near, ends, np.inf)
        if not len(ends):
            return None
        slot = int(np.abs(ends - at.x()).argmin())
        return slot if abs(ends[slot] - at.x()) <= _EDGE_PX else None

    # Moving

    def _move(self, slot: int, time_s: float) -> None:
        try:
            self._transcript = with_boundary(self._before, slot, time_s)
        except UserFacingError:
            return
        self.update()

    def nudge(self, by_s: float) -> None:
        """Move the chosen boundary."""
        if self._chosen is None or self._transcript is None:
            return
        self._before = self._transcript
        self._move(self._chosen, self._transcript.phonemes[self._chosen].end_s + by_s)
        self.changed.emit(self._transcript)

    def choose_next(self, by: int) -> None:
        """Choose another boundary, and bring it into view."""
        if self._transcript is None or len(self._transcript.phonemes) < 2:
            return
        last = len(self._transcript.phonemes) - 2
        start = -1 if by > 0 else last + 1
        self._chosen = min(max((start if self._chosen is None else self._chosen) + by, 0), last)
        at_s = self._transcript.phonemes[self._chosen].end_s
        if not self._start_s <= at_s <= self._start_s + self._shown_s:
            self._look_at(at_s - self._shown_s / 2, self._shown_s)
        self.update()

    def _look_at(self, start_s: float, shown_s: float) -> None:
        duration_s = self._transcript.duration_s
        self._shown_s = min(max(shown_s, _NARROWEST_S), max(duration_s, _NARROWEST_S))
        self._start_s = min(max(start_s, 0.0), max(duration_s - self._shown_s, 0.0))
        self.update()

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for room for the spectrogram."""
        return QSize(800, 420)

    def paintEvent(self, _event) -> None:
        """Paint all lanes."""
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), colour(theme().canvas))
            if self._transcript is not None:
                self._paint(painter)
            if self.hasFocus():
                painter.setPen(colour(theme().dim))
                painter.drawRect(self.rect().adjusted(0, 0, -1, -1))

    def _paint(self, painter: QPainter) -> None:
        lanes, scale, said = self.lanes(), self.scale, self._transcript
        painter.setFont(small_font())
        for key, name in (("sound", texts.LANE_SOUND), ("words", texts.LANE_WORDS), ("phones", texts.LANE_PHONES),
                          ("doubt", texts.LANE_DOUBT)):  # fmt: skip
            painter.setPen(colour(theme().dim))
            painter.drawText(QRectF(STEP + 4, lanes[key].top(), _NAMES_PX, lanes[key].height()),
                             Qt.AlignmentFlag.AlignVCenter, name)  # fmt: skip
            painter.setPen(colour(theme().line, 0.6))
            painter.drawLine(QLineF(0, lanes[key].top(), self.width(), lanes[key].top()))
        painter.setClipRect(QRectF(_NAMES_PX, 0, self.width() - _NAMES_PX - _RIGHT_PX, self.height()))
        paint_ruler(painter, lanes["ruler"], scale, said.duration_s, Ruler())
        if self._peaks is not None:
            paint_wave(painter, lanes["wave"], scale, self._peaks, said.duration_s)
        if self._spectrogram is not None:
            paint_spectrogram(painter, lanes["sound"], scale, self._spectrogram, said.duration_s)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paint_boxes(painter, lanes["words"], scale, [(w.word, w.start_s, w.end_s) for w in said.words], None)
        paint_boxes(painter, lanes["phones"], scale, [(u.phone, u.start_s, u.end_s) for u in said.phonemes], None)
        self._paint_edges(painter, lanes, scale)
        self._paint_doubt(painter, lanes["doubt"], scale)
        if self._playhead_s is not None:
            paint_playhead(painter, QRectF(_NAMES_PX, 0, self.width(), self.height()), scale.x(self._playhead_s))

    def _paint_edges(self, painter: QPainter, lanes: dict[str, QRectF], scale: TimeScale) -> None:
        """Boundaries through the spectrogram: those of words stand out, the one in hand most."""
        words = np.array([edge for w in self._transcript.words for edge in (w.start_s, w.end_s)] or [-1.0])
        top = lanes["sound"].top()
        for slot, utterance in enumerate(self._transcript.phonemes[:-1]):
            x = scale.x(utterance.end_s)
            is_word = np.abs(words - utterance.end_s).min() < 2e-3
            pen = QPen(colour(theme().text, 0.7 if is_word else 0.28), 1.0)
            bottom = lanes["phones"].bottom()
            if slot in (self._dragged, self._chosen):
                pen, bottom = QPen(colour(theme().accent), 2.0), lanes["doubt"].bottom()
            painter.setPen(pen)
            painter.drawLine(QLineF(x, top, x, bottom))

    def _paint_doubt(self, painter: QPainter, area: QRectF, scale: TimeScale) -> None:
        """One bar a phoneme, as high as it is unsure."""
        if self._confidence is None:
            return
        for utterance, sure in zip(self._transcript.phonemes, self._confidence.confidence):
            if not np.isfinite(sure):
                continue
            left, right = scale.x(utterance.start_s) + 1, scale.x(utterance.end_s) - 1
            height = max((1.0 - sure) * (area.height() - 4), 1.0)
            css = theme().emotion["anger"] if sure < 0.5 else theme().accent if sure < 0.8 else theme().dim
            painter.fillRect(
                QRectF(left, area.bottom() - 1 - height, max(right - left, 1.0), height), colour(css, 0.85)
            )

    def mousePressEvent(self, event) -> None:
        """Take a boundary, or ask for a moment."""
        if event.button() != Qt.MouseButton.LeftButton or self._transcript is None:
            return
        slot = self._edge_at(event.position())
        if slot is None:
            self.time_asked.emit(min(max(self.scale.time_s(event.position().x()), 0.0), self._transcript.duration_s))
        else:
            self._dragged = self._chosen = slot
            self._before = self._transcript
        self.update()

    def mouseMoveEvent(self, event) -> None:
        """Move it, or show that it could be."""
        if self._dragged is not None:
            self._move(self._dragged, self.scale.time_s(event.position().x()))
            return
        on_edge = self._edge_at(event.position()) is not None
        self.setCursor(Qt.CursorShape.SplitHCursor if on_edge else Qt.CursorShape.ArrowCursor)

    def mouseReleaseEvent(self, event) -> None:
        """Let it go."""
        if self._dragged is not None and event.button() == Qt.MouseButton.LeftButton:
            self._dragged = None
            if self._transcript != self._before:
                self.changed.emit(self._transcript)
            self.update()

    def wheelEvent(self, event) -> None:
        """Zoom around the pointer; with Shift, move."""
        if self._transcript is None:
            return
        turn = (event.angleDelta().y() or event.angleDelta().x()) / _STEP_ANGLE
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            self._look_at(self._start_s - 0.12 * turn * self._shown_s, self._shown_s)
        else:
            around_s = self.scale.time_s(event.position().x())
            shown_s = self._shown_s / _ZOOM_PER_STEP**turn
            self._look_at(around_s - (around_s - self._start_s) * shown_s / self._shown_s, shown_s)
        event.accept()

    def keyPressEvent(self, event) -> None:
        """Arrows choose a boundary, with Ctrl they move it."""
        by = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}.get(event.key())
        if by is None:
            super().keyPressEvent(event)
        elif event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self.nudge(by * _NUDGE_S)
        else:
            self.choose_next(by)

    def event(self, event) -> bool:
        """Say what is under the pointer."""
        if event.type() == event.Type.ToolTip and self._transcript is not None:
            time_s = self.scale.time_s(event.pos().x())
            row = next((i for i, u in enumerate(self._transcript.phonemes) if u.start_s <= time_s < u.end_s), None)
            QToolTip.showText(event.globalPos(), "" if row is None else self.description(row), self)
            return True
        return super().event(event)

    def description(self, row: int) -> str:
        """Return what there is to know of a phoneme."""
        utterance = self._transcript.phonemes[row]
        phone = texts.SILENCE if utterance.phone == PAU else f"/{utterance.phone}/"
        length_ms = 1000 * (utterance.end_s - utterance.start_s)
        if self._confidence is None or not np.isfinite(self._confidence.shift_s[row]):
            return texts.PHONE_TIP_UNKNOWN.format(phone=phone, ms=length_ms)
        return texts.PHONE_TIP.format(phone=phone, ms=length_ms, shift=1000 * self._confidence.shift_s[row])
