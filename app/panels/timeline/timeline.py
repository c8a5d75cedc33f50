"""The lanes: what is said and when, what it costs, what it feels like, and where the playhead is."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPixmap
from PySide6.QtWidgets import QSizePolicy, QToolTip, QWidget

from app import texts
from app.authoring import Authoring
from app.panels.focus_ring import FocusRing
from app.panels.timeline.curve_lane import LANE, DragKey, remove_key
from app.panels.timeline.description import description
from app.panels.timeline.gestures import DragBoundary, Gesture, PaintEmotion, Scrub
from app.panels.timeline.heard import HeardSound
from app.panels.timeline.lanes import TimeScale, paint_playhead
from app.panels.timeline.phoneme_menu import PhonemeEditor, phoneme_menu
from app.panels.timeline.picture import paint_lanes
from app.panels.timeline.ruler import Ruler
from app.panels.timeline.snapping import FREE, PHONEMES, WORDS
from app.theme import STEP, colour, theme
from core.document.change import Change
from core.media.video import FRAME_RATES
from core.synthesis.polish import REGIONS

_NAMES_PX = 9 * STEP
_HEIGHTS_PX = {"ruler": 22, "wave": 0, "words": 22, "phonemes": 24, "emotion": 32, "curve": 28, "cost": 26, "price": 18}
_WAVE_PX, _LEAST_WAVE_PX = 56, 24
_RIGHT_PX = 2 * STEP
_ZOOM_PER_STEP = 1.25
_STEP_ANGLE = 120.0
_EDGE_PX = 5
_NARROWEST_S = 0.05
_PAN_SHARE = 0.12


class Timeline(QWidget):
    """Lanes over one time axis.

    Click selects an utterance and moves the playhead, drag scrubs, wheel zooms. Edges of phonemes can be dragged, the
    emotion lane is painted with the brush.

    brush_changed(emotion) : for whoever shows the brush
    renewed : for whoever paints on the same time axis
    """

    brush_changed = Signal(str)
    renewed = Signal()

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self.authoring = authoring
        self.heard = HeardSound(authoring, self)
        self.brush, self.snap, self.ruler = "happiness", PHONEMES, Ruler()
        self.region = REGIONS[0]
        self._start_s, self._shown_s = 0.0, 1.0
        self._gesture: Gesture | None = None
        self._lanes_picture: QPixmap | None = None  # painted once; only the playhead moves sixty times a second
        self._editor = PhonemeEditor(self)
        self.focus_ring = FocusRing(self)
        self.setStatusTip(texts.TIMELINE_TIP)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumHeight(sum(_HEIGHTS_PX.values()) + _LEAST_WAVE_PX)
        authoring.document.changed.connect(self.on_document_changed)
        self.heard.changed.connect(self.renew)
        authoring.view.slot_selected.connect(self.renew)
        authoring.view.playhead_moved.connect(self.on_playhead_moved)

    @property
    def duration_s(self) -> float:
        """Length of the speech."""
        speech = self.authoring.document.speech
        return 0.0 if speech is None else speech.transcript.duration_s

    @property
    def scale(self) -> TimeScale:
        """Where times are on screen now."""
        return TimeScale(self._start_s, max(self.time_area().width(), 1.0) / self._shown_s, _NAMES_PX)

    def time_area(self) -> QRectF:
        """Return the part of the widget that time runs through."""
        return QRectF(_NAMES_PX, 0, self.width() - _NAMES_PX - _RIGHT_PX, self.height())

    def lanes(self) -> dict[str, QRectF]:
        """Return the area of each lane; the wave takes what height is left."""
        area = self.time_area()
        heights = dict(_HEIGHTS_PX)
        heights["wave"] = max(self.height() - sum(heights.values()) - STEP // 2, _LEAST_WAVE_PX)
        areas, top = {}, 0
        for name, height in heights.items():
            areas[name] = QRectF(area.left(), top, area.width(), height)
            top += height
        return areas

    def snap_units(self) -> list[tuple[float, float]]:
        """Return the spans that a stroke covers whole; none when it is free."""
        transcript = self.authoring.document.speech.transcript
        units = {FREE: (), PHONEMES: transcript.phonemes, WORDS: transcript.words}[self.snap]
        return [(unit.start_s, unit.end_s) for unit in units]

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other speech, boundaries, emotions, pins or costs."""
        if change & Change.SPEECH:
            self.zoom_all()
        if change & Change.OUTPUT:
            output = self.authoring.document.output
            self.ruler = replace(self.ruler, fps=FRAME_RATES[output.frame_rate], first_frame=output.start_frame)
        if change & Change.ALIGNMENT:
            self._give_up()
        self.renew()

    def renew(self) -> None:
        """Paint the lanes anew."""
        self._lanes_picture = None
        self.update()
        self.renewed.emit()

    def on_playhead_moved(self, time_s: float) -> None:
        """Move the playhead; while it plays beyond the edge, turn the page."""
        if self.authoring.player.is_playing and not self._start_s <= time_s <= self._start_s + self._shown_s:
            self._look_at(time_s, self._shown_s)
        self.update()

    # Ways of working

    def set_brush(self, emotion: str) -> None:
        """Paint with another emotion; neutral erases."""
        self.brush = emotion
        self.brush_changed.emit(emotion)

    def set_region(self, region: str) -> None:
        """Show the polish curve of another region of the face."""
        self.region = region
        self.renew()

    def set_snap(self, snap: str) -> None:
        """Let strokes cover whole phonemes, whole words, or just what they touch."""
        self.snap = snap

    def set_unit(self, unit: str) -> None:
        """Write times in seconds, frames or timecode."""
        self.ruler = replace(self.ruler, unit=unit)
        self.renew()

    # Looking

    def zoom_all(self) -> None:
        """Show all of the speech."""
        self._look_at(0.0, max(self.duration_s, _NARROWEST_S))

    def zoom(self, factor: float, around_s: float | None = None) -> None:
        """Show everything ``factor`` times as wide; ``around_s`` (or the playhead) stays where it is."""
        around_s = self.authoring.view.playhead_s if around_s is None else around_s
        shown_s = min(max(self._shown_s / factor, _NARROWEST_S), max(self.duration_s, _NARROWEST_S))
        self._look_at(around_s - (around_s - self._start_s) * shown_s / self._shown_s, shown_s)

    def pan(self, pages: float) -> None:
        """Look earlier or later, in widths of what is shown."""
        self._look_at(self._start_s + pages * self._shown_s, self._shown_s)

    def _look_at(self, start_s: float, shown_s: float) -> None:
        self._shown_s = shown_s
        self._start_s = min(max(start_s, 0.0), max(self.duration_s - shown_s, 0.0))
        self._editor.hide()
        self.renew()

    def slot_at(self, x: float) -> int | None:
        """Return the slot at a place, or None left of the lanes or without speech."""
        if x < _NAMES_PX - _EDGE_PX:
            return None
        return self.authoring.view.slot_at(min(max(self.scale.time_s(x), 0.0), self.duration_s))

    def _lane_at(self, y: float) -> str:
        return next((name for name, area in self.lanes().items() if y < area.bottom()), "price")

    def _edge_at(self, at: QPointF) -> int | None:
        """Return the slot whose end is under the pointer in the phoneme lane."""
        if self.authoring.document.speech is None or self._lane_at(at.y()) != "phonemes":
            return None
        ends = [self.scale.x(u.end_s) for u in self.authoring.document.speech.transcript.phonemes[:-1]]
        near = min(range(len(ends)), key=lambda p: abs(ends[p] - at.x()), default=None)
        return near if near is not None and abs(ends[near] - at.x()) <= _EDGE_PX else None

    def slot_box(self, slot: int) -> QRectF:
        """Return where a phoneme is on screen."""
        utterance, lane = self.authoring.document.speech.transcript.phonemes[slot], self.lanes()["phonemes"]
        left = self.scale.x(utterance.start_s)
        return QRectF(left, lane.top(), self.scale.x(utterance.end_s) - left, lane.height())

    def rename(self, slot: int) -> None:
        """Let the phone of a slot be typed."""
        self._editor.open(slot)

    def rename_selected(self) -> None:
        """Let the phone of the selected slot be typed."""
        if self.authoring.view.slot is not None:
            self.rename(self.authoring.view.slot)

    def split_at_playhead(self) -> None:
        """Make two utterances of the one at the playhead."""
        slot = self.authoring.view.slot_at(self.authoring.view.playhead_s)
        if slot is not None:
            self.authoring.split_phoneme(slot, self.authoring.view.playhead_s)

    def merge_selected(self) -> None:
        """Let the selected utterance take over the next one."""
        if self.authoring.view.slot is not None:
            self.authoring.merge_phoneme(self.authoring.view.slot)

    def _give_up(self) -> None:
        if self._gesture is not None:
            self._gesture.cancel()
            self._gesture = None
        self._editor.hide()

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for room for all lanes."""
        return QSize(800, sum(_HEIGHTS_PX.values()) + _WAVE_PX + STEP // 2)

    def resizeEvent(self, event) -> None:
        """Paint the lanes anew."""
        super().resizeEvent(event)
        self.focus_ring.fit()
        self._editor.hide()
        self.renew()

    def paintEvent(self, _event) -> None:
        """Paint the kept picture of the lanes, and what moves over it."""
        with QPainter(self) as painter:
            self._paint(painter)

    def _paint(self, painter: QPainter) -> None:
        if self.authoring.document.speech is None:
            painter.fillRect(self.rect(), colour(theme().canvas))
            painter.setPen(colour(theme().dim))
            painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter, texts.TIMELINE_EMPTY)
            return
        if self._lanes_picture is None:
            ratio = self.devicePixelRatioF()
            self._lanes_picture = QPixmap(self.size() * ratio)
            self._lanes_picture.setDevicePixelRatio(ratio)
            paint_lanes(self, self._lanes_picture)
        painter.drawPixmap(0, 0, self._lanes_picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        area = self.time_area()
        x = self.scale.x(self.authoring.view.playhead_s)
        if area.left() - 1 <= x <= area.right() + 1:
            paint_playhead(painter, area, x)
        if self._gesture is not None:
            self._gesture.paint(painter)

    def mousePressEvent(self, event) -> None:
        """Begin what a drag does here."""
        if event.button() != Qt.MouseButton.LeftButton or self.authoring.document.speech is None:
            return
        self._editor.hide()
        at = event.position()
        edge = self._edge_at(at)
        if edge is not None:
            self._gesture = DragBoundary(self, edge)
        elif self._lane_at(at.y()) == "emotion" and at.x() >= _NAMES_PX:
            self._gesture = PaintEmotion(self, at)
        elif self._lane_at(at.y()) == LANE and at.x() >= _NAMES_PX:
            self._gesture = DragKey(self, at)
        else:
            extends = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            self._gesture = Scrub(self, at, extends)
        self.update()

    def mouseMoveEvent(self, event) -> None:
        """Go on with the drag, or show what could be dragged."""
        if self._gesture is not None:
            self._gesture.move(event.position())
            return
        on_edge = self._edge_at(event.position()) is not None
        paints = self._lane_at(event.position().y()) in ("emotion", LANE) and self.authoring.document.speech is not None
        cursor = Qt.CursorShape.ArrowCursor
        if on_edge:
            cursor = Qt.CursorShape.SplitHCursor
        elif paints:
            cursor = Qt.CursorShape.CrossCursor
        if self.cursor().shape() != cursor:
            self.setCursor(cursor)

    def mouseReleaseEvent(self, event) -> None:
        """Do what the drag showed."""
        if event.button() == Qt.MouseButton.LeftButton and self._gesture is not None:
            gesture, self._gesture = self._gesture, None
            gesture.release(event.position())
            self.update()

    def mouseDoubleClickEvent(self, event) -> None:
        """Rename a phoneme, or take a key of the curve away."""
        slot = self.slot_at(event.position().x())
        lane = self._lane_at(event.position().y())
        self._gesture = None
        if lane == LANE:
            remove_key(self, event.position())
        elif slot is not None and lane == "phonemes":
            self.rename(slot)

    def contextMenuEvent(self, event) -> None:
        """Offer what can be done with the utterance under the pointer."""
        slot = self.slot_at(event.pos().x())
        if slot is not None:
            time_s = self.scale.time_s(event.pos().x())
            phoneme_menu(self, slot, time_s).popup(event.globalPos())

    def wheelEvent(self, event) -> None:
        """Zoom around the pointer; with Shift, or sideways, move."""
        across, along = event.angleDelta().x() / _STEP_ANGLE, event.angleDelta().y() / _STEP_ANGLE
        if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            across, along = across + along, 0.0
        if across:
            self.pan(-_PAN_SHARE * across)
        if along:
            self.zoom(_ZOOM_PER_STEP**along, self.scale.time_s(event.position().x()))
        event.accept()

    def keyPressEvent(self, event) -> None:
        """Escape gives up a drag."""
        if event.key() == Qt.Key.Key_Escape and self._gesture is not None:
            self._give_up()
            self.update()
        else:
            super().keyPressEvent(event)

    def event(self, event) -> bool:
        """Say in the tooltip what is under the pointer."""
        if event.type() == event.Type.ToolTip:
            self._describe(event)
            return True
        return super().event(event)

    def _describe(self, event) -> None:
        slot = self.slot_at(event.pos().x())
        if slot is None:
            QToolTip.hideText()
            return
        QToolTip.showText(
            event.globalPos(), description(self.authoring.document, slot, self._lane_at(event.pos().y())), self
        )
