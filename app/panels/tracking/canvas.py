"""The picture of the film with its points over it: clicked, dragged, looked at closely."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.panels.video import FILM_GROUND
from app.texts import tracking as texts
from app.theme import colour, theme

_REACH_PX = 12.0
_DOT_PX, _RING_PX = 3.0, 9.0
_CLOSEST, _PER_STEP = 12.0, 1.25
_DOUBTED = 0.3


@dataclass(frozen=True)
class ShownPoints:
    """What lies over one picture.

    names : K; places : float64, shape (K, 2), pixels of the film; trust : shape (K,), 0..1; drift_px : shape (K,)
    corrected : names that a hand moved in this picture; clicks : landmark to place, drawn as rings
    """

    names: tuple[str, ...] = ()
    places: np.ndarray | None = None
    trust: np.ndarray | None = None
    drift_px: np.ndarray | None = None
    corrected: frozenset[str] = frozenset()
    clicks: tuple[tuple[str, tuple[float, float]], ...] = ()


class VideoCanvas(QWidget):
    """Shows a picture as large as it fits, or closer.

    clicked(x, y) : a place of the film was clicked while clicks are wanted
    point_moved(name, x, y), click_moved(name, x, y) : a point or a ring was dragged, or moved by keys
    pointed(name) : the pointer is over this point, or over none
    """

    clicked = Signal(float, float)
    point_moved = Signal(str, float, float)
    click_moved = Signal(str, float, float)
    pointed = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self._image: QImage | None = None
        self._size = (1, 1)
        self._shown = ShownPoints()
        self._wants_click = False
        self._zoom, self._middle = 1.0, QPointF(0.5, 0.5)
        self._held: tuple[str, str] | None = None
        self._hand: QPointF | None = None
        self._panned_from: QPointF | None = None
        self.chosen = ""
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAccessibleDescription(texts.CANVAS_TIP)

    # What is shown

    def show_film(self, size_px: tuple[int, int]) -> None:
        """Expect pictures of a film of this size, width and height."""
        self._image, self._size, self._zoom = None, size_px, 1.0
        self._middle, self.chosen = QPointF(0.5, 0.5), ""
        self.update()

    def show_picture(self, image: QImage) -> None:
        """Show a picture, which may have fewer pixels than the film."""
        self._image = image
        self.update()

    def show_points(self, shown: ShownPoints, wants_click: bool) -> None:
        """Lay points over the picture; with ``wants_click`` a click is a place, and not a hold."""
        self._shown, self._wants_click = shown, wants_click
        self.setCursor(Qt.CursorShape.CrossCursor if wants_click else Qt.CursorShape.ArrowCursor)
        self.update()

    @property
    def has_picture(self) -> bool:
        """Whether a picture came."""
        return self._image is not None

    def _frame(self) -> QRectF:
        """Where the whole picture lies on the widget."""
        width, height = self._size
        scale = self._zoom * min(self.width() / width, self.height() / height)
        middle = QPointF(self.width() / 2, self.height() / 2)
        wide, high = width * scale, height * scale
        return QRectF(middle.x() - self._middle.x() * wide, middle.y() - self._middle.y() * high, wide, high)

    def at(self, x: float, y: float) -> QPointF:
        """Where a place of the film is on the widget; the middle of the first pixel is 0, 0."""
        frame = self._frame()
        scale = frame.width() / self._size[0]
        return QPointF(frame.left() + (x + 0.5) * scale, frame.top() + (y + 0.5) * scale)

    def place(self, at: QPointF) -> tuple[float, float]:
        """The place of the film under a place of the widget, within the picture."""
        frame = self._frame()
        scale = frame.width() / self._size[0]
        x, y = (at.x() - frame.left()) / scale - 0.5, (at.y() - frame.top()) / scale - 0.5
        return min(max(x, 0.0), self._size[0] - 1.0), min(max(y, 0.0), self._size[1] - 1.0)

    # Choosing by keys

    def choose_next(self, by: int) -> None:
        """Choose the next point, or the one before."""
        names = self._shown.names
        if names and self._shown.places is not None:
            at = names.index(self.chosen) if self.chosen in names else -1 if by > 0 else 0
            self._choose(names[(at + by) % len(names)])

    def nudge(self, dx: float, dy: float) -> None:
        """Move the chosen point by pixels of the film."""
        if self.chosen in self._shown.names and self._shown.places is not None:
            x, y = self._shown.places[self._shown.names.index(self.chosen)]
            self.point_moved.emit(self.chosen, float(x + dx), float(y + dy))

    def _choose(self, name: str) -> None:
        if name != self.chosen:
            self.chosen = name
            self.pointed.emit(name)
            self.update()

    # Hands

    def _near(self, at: QPointF) -> tuple[str, str] | None:
        """What lies under the pointer: ("click" or "point", name)."""
        found: list[tuple[float, tuple[str, str]]] = []
        if self._shown.places is not None:
            found += [(_away(self.at(*p), at), ("point", n)) for n, p in zip(self._shown.names, self._shown.places)]
        # a point in the middle of a ring is held by the point; the ring by its rim
        found += [(abs(_away(self.at(*p), at) - _RING_PX) + 2.0, ("click", n)) for n, p in self._shown.clicks]
        nearest = min(found, default=None)
        return nearest[1] if nearest is not None and nearest[0] < _REACH_PX else None

    def mousePressEvent(self, event) -> None:
        """Click a place, or hold a point, or else the picture."""
        if self._image is None or event.button() not in (Qt.MouseButton.LeftButton, Qt.MouseButton.MiddleButton):
            return
        at = event.position()
        is_left = event.button() == Qt.MouseButton.LeftButton
        if is_left and self._wants_click and self._frame().contains(at):
            self.clicked.emit(*self.place(at))
            return
        self._held = self._near(at) if is_left else None
        if self._held is None:
            self._panned_from = at
            self.setCursor(Qt.CursorShape.ClosedHandCursor)
        else:
            self._hand = at
            self._choose(self._held[1] if self._held[0] == "point" else "")

    def mouseMoveEvent(self, event) -> None:
        """Drag, or tell what is under the pointer."""
        at = event.position()
        if self._held is not None:
            self._hand = at
            self.update()
        elif self._panned_from is not None:
            frame, by = self._frame(), at - self._panned_from
            self._middle -= QPointF(by.x() / frame.width(), by.y() / frame.height())
            self._panned_from = at
            self._keep_in_view()
        elif not self._wants_click:
            near = self._near(at)
            self._choose(near[1] if near is not None and near[0] == "point" else "")

    def mouseReleaseEvent(self, event) -> None:
        """Let a point go where it was dragged; a press without a drag leaves it."""
        held, hand, self._held, self._hand, self._panned_from = self._held, self._hand, None, None, None
        self.setCursor(Qt.CursorShape.CrossCursor if self._wants_click else Qt.CursorShape.ArrowCursor)
        if held is not None:
            kind, name = held
            before = dict(self._shown.clicks)[name] if kind == "click" else self._place_of(name)
            if hand is not None and _away(self.at(*before), event.position()) > 2.0:
                x, y = self.place(event.position())
                (self.click_moved if kind == "click" else self.point_moved).emit(name, x, y)
        self.update()

    def wheelEvent(self, event) -> None:
        """Go closer to what is under the pointer, or farther."""
        if self._image is None:
            return
        at, frame = event.position(), self._frame()
        share = QPointF((at.x() - frame.left()) / frame.width(), (at.y() - frame.top()) / frame.height())
        self._zoom = min(max(self._zoom * _PER_STEP ** (event.angleDelta().y() / 120), 1.0), _CLOSEST)
        frame = self._frame()
        self._middle = share - QPointF((at.x() - self.width() / 2) / frame.width(),
                                       (at.y() - self.height() / 2) / frame.height())  # fmt: skip
        self._keep_in_view()
        event.accept()

    def _keep_in_view(self) -> None:
        half = 0.5 / self._zoom
        self._middle = QPointF(min(max(self._middle.x(), half), 1 - half), min(max(self._middle.y(), half), 1 - half))
        self.update()

    def _place_of(self, name: str) -> tuple[float, float]:
        return tuple(self._shown.places[self._shown.names.index(name)])

    # Qt

    def sizeHint(self) -> QSize:
        """Ask for room for a film."""
        return QSize(800, 600)

    def leaveEvent(self, _event) -> None:
        """Nothing is pointed at."""
        self._choose("")

    def paintEvent(self, _event) -> None:
        """Paint the picture, then rings, then points."""
        with QPainter(self) as painter:
            self._paint(painter)

    def _paint(self, painter: QPainter) -> None:
        painter.fillRect(self.rect(), colour(FILM_GROUND))
        if self._image is None:
            return
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.drawImage(self._frame(), self._image)
        t = theme()
        for name, place in self._shown.clicks:
            at = self._hand if self._held == ("click", name) else self.at(*place)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            for pen in (QPen(colour("#000000", 0.6), 4.0), QPen(colour(t.accent), 2.0)):
                painter.setPen(pen)
                painter.drawEllipse(at, _RING_PX, _RING_PX)
        if self._shown.places is not None:
            for k, (name, place) in enumerate(zip(self._shown.names, self._shown.places)):
                at = self._hand if self._held == ("point", name) else self.at(*place)
                self._paint_point(painter, at, name, 1.0 if self._shown.trust is None else self._shown.trust[k])

    def _paint_point(self, painter: QPainter, at: QPointF, name: str, trust: float) -> None:
        t = theme()
        is_doubted, is_chosen = trust < _DOUBTED, name == self.chosen
        size = _DOT_PX + (2.0 if is_chosen else 0.0)
        painter.setPen(QPen(colour("#000000", 0.7), 1.2))
        if name in self._shown.corrected:
            painter.setBrush(colour(t.accent))
            painter.drawRect(QRectF(at.x() - size, at.y() - size, 2 * size, 2 * size))
        elif is_doubted:  # hollow, so that colour is not the only sign
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(at, size + 1.0, size + 1.0)
            painter.setPen(QPen(colour(t.emotion["anger"]), 1.8))
            painter.drawEllipse(at, size, size)
        else:
            painter.setBrush(colour("#7fd6c2"))
            painter.drawEllipse(at, size, size)


def _away(one: QPointF, other: QPointF) -> float:
    return float(np.hypot(one.x() - other.x(), one.y() - other.y()))
