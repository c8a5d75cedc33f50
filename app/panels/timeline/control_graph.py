"""The control curves as a graph that is edited by hand, on the time axis of the timeline above it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QPainter, QPen, QPixmap, QPolygonF
from PySide6.QtWidgets import QToolTip, QWidget

from app.editing import new_gesture
from app.panels.focus_ring import FocusRing
from app.panels.timeline.dominance import paint_asked, paint_dominances, ruler_at
from app.panels.timeline.gestures import Scrub
from app.panels.timeline.lanes import paint_playhead, paint_selection
from app.panels.timeline.shown_curves import FoundCurves, ShownCurves
from app.panels.timeline.timeline import Timeline
from app.texts import curves as texts
from app.theme import STEP, colour, small_font, theme
from core.speech.phoneme import PAU
from core.synthesis.control_edits import LONGEST_REACH_S, NO_CURVE_EDITS, SHORTEST_REACH_S, ControlKey

_HEIGHT_PX, _LEAST_PX, _RULES_PX, _GAP_PX = 212, 136, 64, 8
_KEY_PX, _GRAB_PX, _DRAG_PX, _STEP_PX = 4.5, 8.0, 3, 2
_NUDGE_SHARE, _NUDGE_S = 0.02, 1 / 60
_WIDEN = 1.15


class ControlGraph(QWidget):
    """Curves above, the phonemes that rule them below.

    control : the one that is edited; key : the chosen one of its keys, or None
    control_chosen(control) : a curve was clicked
    """

    control_chosen = Signal(str)

    def __init__(self, timeline: Timeline) -> None:
        super().__init__()
        self._timeline, self._authoring = timeline, timeline.authoring
        self.shown = ShownCurves(timeline.authoring, self)
        self.control, self.key = "", None
        self.reach_s = texts.WIDTHS["medium"][1]
        self._drag: _KeyDrag | None = None
        self._scrub: Scrub | None = None
        self._hovered: int | None = None
        self._picture: QPixmap | None = None
        self.focus_ring = FocusRing(self)
        self.setStatusTip(texts.HINT)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumHeight(_LEAST_PX)
        self.shown.changed.connect(self._on_curves_changed)
        timeline.renewed.connect(self.renew)
        timeline.authoring.view.playhead_moved.connect(lambda _: self.update())

    # What is where

    @property
    def curves(self) -> FoundCurves | None:
        """What is drawn."""
        return self.shown.curves

    def graph_area(self) -> QRectF:
        """Return where the curves are."""
        area = self._timeline.time_area()
        return QRectF(area.left(), _GAP_PX, area.width(), self.height() - _RULES_PX - 2 * _GAP_PX)

    def rules_area(self) -> QRectF:
        """Return where the dominance functions are."""
        area = self._timeline.time_area()
        return QRectF(area.left(), self.height() - _RULES_PX, area.width(), _RULES_PX)

    def y_of(self, value: float) -> float:
        """Return the height of a value of the chosen control."""
        low, high = self.curves.span(self.control)
        area = self.graph_area()
        return area.bottom() - (value - low) / (high - low) * area.height()

    def value_at(self, y: float) -> float:
        """Inverse of `y_of`, beyond the graph too."""
        low, high = self.curves.span(self.control)
        area = self.graph_area()
        return low + (area.bottom() - y) / area.height() * (high - low)

    def point(self, time_s: float, control: str | None = None) -> QPointF:
        """Return where a curve is on screen at a time."""
        edited = self.curves.edited
        values = edited.column(control or self.control)
        return QPointF(self._timeline.scale.x(time_s), self.y_of(float(np.interp(time_s, edited.times_s, values))))

    def _key_at(self, at: QPointF) -> ControlKey | None:
        near = [(_apart(self.point(key.time_s), at), key) for key in self._keys]
        apart, key = min(near, default=(np.inf, None))
        return key if apart <= _GRAB_PX else None

    def _curve_at(self, at: QPointF) -> str | None:
        """Return the curve under the pointer, the chosen one before others."""
        scale, edited = self._timeline.scale, self.curves.edited
        times_s = scale.time_s(at.x()) + np.linspace(-_GRAB_PX, _GRAB_PX, 9) / scale.px_per_s
        if not -_GRAB_PX / scale.px_per_s <= scale.time_s(at.x()) <= edited.duration_s:
            return None
        apart = {name: min(_apart(self.point(float(time_s), name), at) for time_s in times_s) for name in self.drawn()}
        if apart[self.control] <= _GRAB_PX:
            return self.control
        nearest = min(apart, key=apart.get)
        return nearest if apart[nearest] <= _GRAB_PX / 2 else None

    def drawn(self) -> tuple[str, ...]:
        """Return the controls that are drawn, the chosen one last."""
        return (*(name for name in self.curves.basis.shown if name != self.control), self.control)

    # Editing

    @property
    def _keys(self) -> tuple[ControlKey, ...]:
        return self._authoring.document.controls.of(self.control).keys

    def set_control(self, control: str) -> None:
        """Edit another control."""
        self.control, self.key = control, None
        self.renew()

    def set_keys(self, keys: tuple[ControlKey, ...], label: str, gesture: int | None = None) -> None:
        """Give the chosen control other keys."""
        edits = self._authoring.document.controls.with_keys(self.control, keys)
        self._authoring.set_controls(edits, label.format(control=self.control), gesture)

    def set_reach(self, reach_s: float) -> None:
        """Let new keys reach so far, and the chosen one too."""
        self.reach_s = min(max(reach_s, SHORTEST_REACH_S), LONGEST_REACH_S)
        if self.key is not None:
            self._replace_key(replace(self.key, reach_s=self.reach_s), texts.EDIT_WIDTH)

    def smooth(self) -> None:
        """Smooth the chosen control in the selected utterances, or everywhere."""
        if self.curves is None:
            return
        said, span = self.curves.transcript.phonemes, self._authoring.view.span
        first, last = span or (0, len(said) - 1)
        edits = self._authoring.document.controls.smoothing(self.control, said[first].start_s, said[last].end_s)
        self._authoring.set_controls(edits, texts.EDIT_SMOOTH.format(control=self.control))

    def mute(self, muted: bool) -> None:
        """Keep the chosen control at rest, or let it go."""
        label = texts.EDIT_MUTE if muted else texts.EDIT_UNMUTE
        edits = self._authoring.document.controls.muting(self.control, muted)
        self._authoring.set_controls(edits, label.format(control=self.control))

    def clear(self) -> None:
        """Take all edits of the chosen control away."""
        edits = self._authoring.document.controls.with_control(self.control, NO_CURVE_EDITS)
        self._authoring.set_controls(edits, texts.EDIT_CLEAR.format(control=self.control))

    def remove_key(self, key: ControlKey) -> None:
        """Take a key away."""
        self.set_keys(tuple(k for k in self._keys if k != key), texts.EDIT_REMOVE)

    def _replace_key(self, key: ControlKey, label: str) -> None:
        others = tuple(k for k in self._keys if k != self.key)
        self.key = key
        self.set_keys((*others, key), label)

    def _nudge(self, along: float, up: float) -> None:
        low, high = self.curves.span(self.control)
        amount = self.key.amount + up * _NUDGE_SHARE * (high - low)
        time_s = min(max(self.key.time_s + along * _NUDGE_S, 0.0), self._timeline.duration_s)
        self._replace_key(replace(self.key, amount=amount, time_s=time_s), texts.EDIT_KEY)

    # Reactions

    def _on_curves_changed(self) -> None:
        if self.curves is not None and self.control not in self.curves.found.names:
            self.control = self.curves.basis.shown[0]
        if self.key is not None and self.key not in self._keys:
            self.key = None
        self._hovered = None
        self.renew()

    def renew(self) -> None:
        """Paint anew."""
        self._picture = None
        self.update()

    # Painting

    def _paint_still(self, picture: QPixmap) -> None:
        picture.fill(colour(theme().canvas))
        painter = QPainter(picture)
        painter.setFont(small_font())
        scale, curves, view = self._timeline.scale, self.curves, self._authoring.view
        graph, rules = self.graph_area(), self.rules_area()
        self._paint_frame(painter, graph, rules)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setClipRect(QRectF(graph.left(), 0, graph.width(), self.height()))
        said = curves.transcript.phonemes
        if view.span is not None and view.span[1] < len(said):
            first, last = view.span
            whole = QRectF(graph.left(), 0, graph.width(), self.height())
            paint_selection(painter, whole, scale.x(said[first].start_s), scale.x(said[last].end_s))
        painter.setPen(QPen(colour(theme().line, 0.5), 1))
        for utterance in said:
            painter.drawLine(QLineF(scale.x(utterance.end_s), 0, scale.x(utterance.end_s), self.height()))
        if curves.ruling is not None:
            paint_dominances(painter, rules, scale, curves, self._hovered)
            paint_asked(painter, scale, curves, self.control, self.y_of)
        else:
            painter.setPen(colour(theme().dim))
            painter.drawText(rules.adjusted(STEP, 0, 0, 0), Qt.AlignmentFlag.AlignVCenter, texts.NO_RULES)
        self._paint_curves(painter)
        painter.end()

    def _paint_frame(self, painter: QPainter, graph: QRectF, rules: QRectF) -> None:
        low, high = self.curves.span(self.control)
        digits = 1 if self.curves.basis.has_units else 0
        for share in (0.0, 0.5, 1.0):
            y = graph.bottom() - share * graph.height()
            painter.setPen(QPen(colour(theme().line, 1.0 if share == 0 else 0.6), 1))
            painter.drawLine(QLineF(graph.left(), y, graph.right(), y))
            painter.setPen(colour(theme().dim))
            box = QRectF(0, y - STEP, graph.left() - STEP, 2 * STEP)
            right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
            painter.drawText(box, right, f"{low + share * (high - low):.{digits}f}")
        painter.setPen(QPen(colour(theme().line, 0.6), 1))
        painter.drawLine(QLineF(0, rules.top() - 2, self.width(), rules.top() - 2))
        painter.setPen(colour(theme().dim))
        box = QRectF(STEP + 4, rules.top(), rules.left(), rules.height())
        painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, texts.RULES)

    def _paint_curves(self, painter: QPainter) -> None:
        curves, document = self.curves, self._authoring.document
        for name in self.drawn()[:-1]:
            self._paint_curve(painter, curves.edited.column(name), QPen(colour(theme().dim, 0.55), 1))
        if document.controls.of(self.control) != NO_CURVE_EDITS:
            before = QPen(colour(theme().text, 0.6), 1, Qt.PenStyle.DashLine)
            self._paint_curve(painter, curves.found.column(self.control), before)
        self._paint_curve(painter, curves.edited.column(self.control), QPen(colour(theme().accent), 2.0))
        for key in self._keys:
            painter.setPen(QPen(colour(theme().accent), 1.5))
            painter.setBrush(colour(theme().accent if key == self.key else theme().canvas))
            painter.drawEllipse(self.point(key.time_s), _KEY_PX, _KEY_PX)
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _paint_curve(self, painter: QPainter, values: np.ndarray, pen: QPen) -> None:
        scale, area, rate_hz = self._timeline.scale, self.graph_area(), self.curves.found.rate_hz
        xs = np.arange(max(area.left(), scale.x(0.0)), min(area.right(), scale.x(len(values) / rate_hz)), _STEP_PX)
        frames = (scale.start_s + (xs - scale.left_px) / scale.px_per_s) * rate_hz
        heights = self.y_of(np.interp(frames, np.arange(len(values)), values))
        painter.setPen(pen)
        painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in zip(xs, heights)]))

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for room for curves and phonemes."""
        return QSize(800, _HEIGHT_PX)

    def resizeEvent(self, event) -> None:
        """Paint anew."""
        super().resizeEvent(event)
        self.renew()

    def paintEvent(self, _event) -> None:
        """Paint the kept picture, and the playhead over it."""
        with QPainter(self) as painter:
            if self.curves is None:
                painter.fillRect(self.rect(), colour(theme().canvas))
                painter.setPen(colour(theme().dim))
                words = self.shown.trouble or texts.EMPTY
                painter.drawText(self.rect(), Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, words)
                return
            if self._picture is None:
                ratio = self.devicePixelRatioF()
                self._picture = QPixmap(self.size() * ratio)
                self._picture.setDevicePixelRatio(ratio)
                self._paint_still(self._picture)
            painter.drawPixmap(0, 0, self._picture)
            area = self._timeline.time_area()
            x = self._timeline.scale.x(self._authoring.view.playhead_s)
            if area.left() - 1 <= x <= area.right() + 1:
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                paint_playhead(painter, QRectF(area.left(), 0, area.width(), self.height()), x)

    def mousePressEvent(self, event) -> None:
        """Take hold of a key or a curve; elsewhere, of the playhead."""
        if event.button() != Qt.MouseButton.LeftButton or self.curves is None:
            return
        at = event.position()
        key, curve = self._key_at(at), self._curve_at(at) if self.graph_area().contains(at) else None
        if curve not in (None, self.control) and key is None:
            self.control_chosen.emit(curve)
        elif key is not None or curve is not None:
            self.key = key
            self._drag = _KeyDrag(self, at, key)
        else:
            self.key = None
            self._scrub = Scrub(self._timeline, at, bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        self.renew()

    def mouseMoveEvent(self, event) -> None:
        """Go on with the drag, or show what could be dragged."""
        if self._drag is not None:
            self._drag.move(event.position())
        elif self._scrub is not None:
            self._scrub.move(event.position())
        elif self.curves is not None:
            self._hover(event.position())

    def _hover(self, at: QPointF) -> None:
        cursor = Qt.CursorShape.ArrowCursor
        if self.graph_area().contains(at):
            if self._key_at(at) is not None:
                cursor = Qt.CursorShape.SizeAllCursor
            elif (curve := self._curve_at(at)) is not None:
                cursor = Qt.CursorShape.SizeVerCursor if curve == self.control else Qt.CursorShape.PointingHandCursor
        if self.cursor().shape() != cursor:
            self.setCursor(cursor)
        over_rules = self.rules_area().contains(at)
        hovered = ruler_at(self.curves, self._timeline.scale.time_s(at.x())) if over_rules else None
        if hovered != self._hovered:
            self._hovered = hovered
            self.renew()

    def mouseReleaseEvent(self, event) -> None:
        """Let go."""
        if event.button() == Qt.MouseButton.LeftButton:
            if self._scrub is not None:
                self._scrub.release(event.position())
            self._drag = self._scrub = None

    def mouseDoubleClickEvent(self, event) -> None:
        """Take a key away."""
        self._drag = None
        key = None if self.curves is None else self._key_at(event.position())
        if key is not None:
            self.remove_key(key)

    def wheelEvent(self, event) -> None:
        """Zoom and move as the timeline does; with Ctrl, widen the chosen key."""
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier and self.key is not None:
            self.set_reach(self.key.reach_s * _WIDEN ** (event.angleDelta().y() / 120.0))
            event.accept()
        else:
            self._timeline.wheelEvent(event)

    def keyPressEvent(self, event) -> None:
        """Work on the chosen key; Escape gives a drag up."""
        key = event.key()
        nudges = {Qt.Key.Key_Up: (0, 1), Qt.Key.Key_Down: (0, -1), Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0)}
        acts: dict[Qt.Key, Callable[[], None]] = {Qt.Key.Key_S: self.smooth, Qt.Key.Key_M: self._toggle_mute}
        if key == Qt.Key.Key_Escape and self._drag is not None:
            self._drag.cancel()
            self._drag = None
        elif self.curves is not None and key in acts and not event.modifiers():
            acts[key]()
        elif self.key is not None and key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.remove_key(self.key)
        elif self.key is not None and key in nudges:
            self._nudge(*nudges[key])
        else:
            super().keyPressEvent(event)

    def _toggle_mute(self) -> None:
        self.mute(not self._authoring.document.controls.of(self.control).is_muted)

    def event(self, event) -> bool:
        """Keep keys that the menus use too while a key is chosen; say in the tooltip what is under the pointer."""
        if event.type() == event.Type.ShortcutOverride and self.curves is not None and not event.modifiers():
            mine = {Qt.Key.Key_S, Qt.Key.Key_M}
            if self.key is not None:
                mine |= {Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_Left, Qt.Key.Key_Right, Qt.Key.Key_Delete}
            if event.key() in mine:
                event.accept()
                return True
        if event.type() == event.Type.ToolTip:
            QToolTip.showText(event.globalPos(), self.description(QPointF(event.pos())), self)
            return True
        return super().event(event)

    def description(self, at: QPointF) -> str:
        """Return what there is to know of a place."""
        curves = self.curves
        time_s = self._timeline.scale.time_s(at.x())
        if curves is None or not 0 <= time_s < curves.found.duration_s:
            return ""
        frame = min(round(time_s * curves.found.rate_hz), len(curves.found) - 1)
        if self.rules_area().contains(at):
            j = ruler_at(curves, time_s)
            if j is None:
                return ""
            phone = curves.transcript.phonemes[j].phone
            return texts.RULER.format(
                phone=texts.SILENCE if phone == PAU else f"/{phone}/", share=curves.ruling.shares[j, frame],
                control=self.control, value=curves.ruling.asked[j, curves.found.names.index(self.control)],
            )  # fmt: skip
        control = self._curve_at(at) or self.control
        value, found = (float(track.column(control)[frame]) for track in (curves.edited, curves.found))
        words = texts.AT if abs(value - found) < 5e-3 else texts.AT_EDITED
        return words.format(control=control, value=value, found=found, time_s=time_s)


class _KeyDrag:
    """Moves a key with the pointer; begun on the bare curve, it makes one as soon as the pointer has moved."""

    def __init__(self, graph: ControlGraph, at: QPointF, key: ControlKey | None) -> None:
        self._graph, self._from, self._gesture = graph, at, new_gesture()
        self._time_s, self._amount, self._reach_s = (
            (graph._timeline.scale.time_s(at.x()), 0.0, graph.reach_s) if key is None
            else (key.time_s, key.amount, key.reach_s)
        )  # fmt: skip
        self._before = graph._keys
        self._others = tuple(k for k in self._before if k != key)
        self._moves = False

    def move(self, at: QPointF) -> None:
        """The pointer is at ``at``."""
        graph = self._graph
        self._moves = self._moves or _apart(at, self._from) >= _DRAG_PX
        if not self._moves:
            return
        area, scale = graph.graph_area(), graph._timeline.scale
        height = min(max(at.y(), area.top()), area.bottom())
        amount = self._amount + graph.value_at(height) - graph.value_at(self._from.y())
        time_s = self._time_s + (at.x() - self._from.x()) / scale.px_per_s
        time_s = round(min(max(time_s, 0.0), graph._timeline.duration_s), 3)
        graph.key = ControlKey(time_s, round(amount, 4), self._reach_s)
        graph.set_keys((*self._others, graph.key), texts.EDIT_KEY, self._gesture)

    def cancel(self) -> None:
        """Put the keys back as they were."""
        self._graph.key = None
        if self._moves:
            self._graph.set_keys(self._before, texts.EDIT_KEY, self._gesture)


def _apart(one: QPointF, other: QPointF) -> float:
    return float(np.hypot(one.x() - other.x(), one.y() - other.y()))
