"""The plane of the map under the animator's hand: wheel zooms, drag moves or encloses, keys act on what is picked."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QEvent, QPointF, Qt, Signal

from app.emotion_colours import emotion_colours
from app.panels.focus_ring import FocusRing
from app.theme import colour, theme

_KEYS = {
    Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_U, Qt.Key.Key_Space,
    Qt.Key.Key_Escape, Qt.Key.Key_N,
}  # fmt: skip
_WITH_SHIFT = {Qt.Key.Key_N, Qt.Key.Key_Space}
MOVE, BOX, LASSO = "move", "box", "lasso"
Z_OUTLINE = 30


class MapBox(pg.ViewBox):
    """The plane.

    pointed(point), clicked(point) : map units; ``point`` is None when the pointer leaves
    enclosed(outline, adds) : corners, shape (n, 2), map units, and whether they add to what is selected
    tool : what a plain drag does; with Shift it draws a box, with Ctrl a lasso
    """

    pointed = Signal(object)
    clicked = Signal(object, bool)
    enclosed = Signal(object, bool)

    def __init__(self) -> None:
        super().__init__(lockAspect=True, enableMenu=False)
        self.tool = self._drag_tool = MOVE
        self._way: list[QPointF] = []
        self._outline = pg.PlotCurveItem(fillLevel=None)
        self._outline.setZValue(Z_OUTLINE)
        self.addItem(self._outline, ignoreBounds=True)

    def hoverEvent(self, event) -> None:
        """Say what is under the pointer."""
        self.pointed.emit(None if event.isExit() else _array(self.mapToView(event.pos())))

    def mouseClickEvent(self, event) -> None:
        """Say what was clicked."""
        if event.button() == Qt.MouseButton.LeftButton:
            event.accept()
            adds = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
            self.clicked.emit(_array(self.mapToView(event.pos())), adds)

    def mouseDragEvent(self, event, axis=None) -> None:
        """Move the plane, or draw an outline around dots."""
        if event.isStart():
            self._drag_tool = self._tool_for(event)
            self._outline.setPen(pg.mkPen(colour(theme().accent), width=1))
            self._outline.setBrush(colour(theme().accent, 0.12))
        if self._drag_tool == MOVE:
            super().mouseDragEvent(event, axis)
            return
        event.accept()
        start, now = self.mapToView(event.buttonDownPos()), self.mapToView(event.pos())
        if event.isStart():
            self._way = [start]
        self._way.append(now)
        outline = _corners(start, now) if self._drag_tool == BOX else np.array([_array(p) for p in self._way])
        if event.isFinish():
            self._outline.setData([], [])
            self._way = []
            adds = self.tool != MOVE and bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            self.enclosed.emit(outline, adds)
        else:
            closed = np.vstack([outline, outline[:1]])
            self._outline.setData(closed[:, 0], closed[:, 1])

    def _tool_for(self, event) -> str:
        if event.button() != Qt.MouseButton.LeftButton:
            return MOVE
        if self.tool == MOVE and event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            return BOX
        if self.tool == MOVE and event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            return LASSO
        return self.tool


class MapCanvas(pg.GraphicsView):
    """The widget around the plane.

    double_clicked(point) : map units; taken here because the scene loses the second click when it follows the first
    keyed(key, shift) : a key that acts on what is picked
    """

    double_clicked = Signal(object)
    keyed = Signal(int, bool)

    def __init__(self, box: MapBox) -> None:
        super().__init__(background=theme().canvas)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.focus_ring = FocusRing(self)
        self._box = box
        self.setCentralItem(box)
        emotion_colours.changed.connect(self.dress)

    def dress(self) -> None:
        """Take the ground of the theme in use."""
        self.setBackground(theme().canvas)

    def mouseDoubleClickEvent(self, event) -> None:
        """Say what was double-clicked."""
        if event.button() == Qt.MouseButton.LeftButton:
            event.accept()
            self.double_clicked.emit(_array(self._box.mapSceneToView(self.mapToScene(event.position().toPoint()))))

    def leaveEvent(self, event) -> None:
        """Say that the pointer is gone; a fast one leaves without a last hover."""
        super().leaveEvent(event)
        self._box.pointed.emit(None)

    def resizeEvent(self, event) -> None:
        """Keep the ring around it."""
        super().resizeEvent(event)
        if hasattr(self, "focus_ring"):  # the view is laid out while it is being made
            self.focus_ring.fit()

    def event(self, event) -> bool:
        """Keep our keys from the menus while the map has the focus: here Space plays the picked node."""
        if event.type() == QEvent.Type.ShortcutOverride and _is_ours(event):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event) -> None:
        """Act on what is picked."""
        if _is_ours(event):
            event.accept()
            self.keyed.emit(int(event.key()), bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        else:
            super().keyPressEvent(event)


def _is_ours(event) -> bool:
    modifiers = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
    if modifiers == Qt.KeyboardModifier.ShiftModifier:
        return event.key() in _WITH_SHIFT
    return not modifiers and event.key() in _KEYS


def _array(point: QPointF) -> np.ndarray:
    return np.array([point.x(), point.y()])


def _corners(start: QPointF, end: QPointF) -> np.ndarray:
    return np.array([[start.x(), start.y()], [end.x(), start.y()], [end.x(), end.y()], [start.x(), end.y()]])
