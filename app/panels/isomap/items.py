"""What can be seen on a phoneme map: one class for each thing that has a name."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPainterPath, QPolygonF

from app.theme import colour, small_font, theme

Z_SPLATS, Z_DOTS, Z_CONTEXT, Z_TIME, Z_TRAJECTORY, Z_SELECTED, Z_MARKS = -10, 0, 4, 5, 8, 10, 20

MARK_PX = 15
_NO_POINTS = np.zeros((0, 2))
_ARROW_EVERY_PX = 34.0
_ARROW_PX = 5.0


def _ring_in_ring() -> QPainterPath:
    path = QPainterPath()
    path.addEllipse(QRectF(-0.5, -0.5, 1.0, 1.0))
    path.addEllipse(QRectF(-0.16, -0.16, 0.32, 0.32))
    return path


class SplatImage(pg.ImageItem):
    """Where the frames lie and how densely."""

    def __init__(self) -> None:
        super().__init__(axisOrder="row-major")
        self.setZValue(Z_SPLATS)

    def show_splats(self, image: np.ndarray, bounds: tuple[float, float, float, float]) -> None:
        """Show what `core.manifold.splat.splat_image` makes for ``bounds``."""
        left, bottom, right, top = bounds
        # light on the canvas, whatever its colour: brightness becomes coverage
        cover = image.max(axis=2, keepdims=True)
        painted = np.concatenate([image / np.maximum(cover, 1e-6), cover], axis=2)
        self.setImage((painted[::-1] * 255).astype(np.uint8), autoLevels=False, levels=(0, 255))
        self.setRect(QRectF(left, bottom, right - left, top - bottom))


class MapMarks(pg.ScatterPlotItem):
    """Signs of one kind on the map, in the colour of the theme that ``role`` names; hollow, or on a halo."""

    def __init__(
        self, symbol: str | QPainterPath, role: str, size_px: float, z: float, width_px: float = 2.0,
        hollow: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(symbol=symbol, size=size_px, pxMode=True)
        self._role, self._width_px, self._hollow = role, width_px, hollow
        self.setZValue(z)
        self.dress()

    def dress(self) -> None:
        """Take the colours of the theme in use."""
        self.setPen(pg.mkPen(colour(getattr(theme(), self._role)), width=self._width_px))
        self.setBrush(None if self._hollow else pg.mkBrush(colour(theme().canvas, 0.55)))

    def show_points(self, points: np.ndarray) -> None:
        """Show signs at ``points``, shape (n, 2)."""
        self.setData(pos=points)

    def show_at(self, point: np.ndarray | None) -> None:
        """Show one sign, or none."""
        self.show_points(_NO_POINTS if point is None else np.asarray(point)[None])

    def mouseClickEvent(self, event) -> None:
        """Leave clicks to the plane; a sign has nothing to do with them."""
        event.ignore()


class NodeInUse(MapMarks):
    """The frame that the path uses now: a diamond."""

    def __init__(self) -> None:
        super().__init__("d", "accent", MARK_PX, Z_MARKS)


class PickingPoint(MapMarks):
    """The place that was picked: a cross hair."""

    def __init__(self) -> None:
        super().__init__("crosshair", "text", MARK_PX, Z_MARKS, 1.5, hollow=True)


class TimeCorrectFrames(MapMarks):
    """Where each node of the map is at the relative time of the playhead: small rings."""

    def __init__(self) -> None:
        super().__init__("o", "text", 5, Z_TIME, 1.0, hollow=True)
        self.setOpacity(0.6)


class ContextCorrectNodes(MapMarks):
    """Nodes captured between the same two phones: a ring in a ring, at the relative time of the playhead."""

    def __init__(self) -> None:
        super().__init__(_ring_in_ring(), "accent", 13, Z_CONTEXT + 3, 1.5)


class WaysInContext(pg.PlotCurveItem):
    """The ways of nodes captured between the same two phones, faintly."""

    def __init__(self) -> None:
        super().__init__(antialias=True)
        self.setZValue(Z_CONTEXT)
        self.dress()

    def dress(self) -> None:
        """Take the colours of the theme in use."""
        self.setPen(pg.mkPen(colour(theme().accent, 0.4), width=1))

    def show_ways(self, ways: list[np.ndarray]) -> None:
        """Show ways, each of shape (n_frames, 2)."""
        whole = np.vstack(ways) if ways else _NO_POINTS
        joined = np.ones(len(whole), bool)
        if ways:
            joined[np.cumsum([len(way) for way in ways]) - 1] = False
        self.setData(whole[:, 0], whole[:, 1], connect=joined)


class SelectedFrames(MapMarks):
    """All frames of the selected nodes: a bright rim around each dot."""

    def __init__(self) -> None:
        super().__init__("o", "accent", 8, Z_SELECTED, 1.5)


class NodeTrajectory(pg.GraphicsObject):
    """The way of one motion node: brighter as time goes by, with arrow heads, and its length in time at the end."""

    def __init__(self, role: str, width_px: float, says_time: bool = True) -> None:
        super().__init__()
        self._role, self._width_px, self._says_time = role, width_px, says_time
        self._points, self._duration_s = _NO_POINTS, 0.0
        self.setZValue(Z_TRAJECTORY)

    @property
    def points(self) -> np.ndarray:
        """The way on show, shape (n_frames, 2)."""
        return self._points

    def show_points(self, points: np.ndarray, duration_s: float = 0.0) -> None:
        """Show a way, shape (n_frames, 2), map units; an empty one hides it."""
        self.prepareGeometryChange()
        self._points, self._duration_s = points, duration_s
        self.update()

    def boundingRect(self) -> QRectF:
        """See `pyqtgraph.GraphicsObject`; room for arrow heads and the label is left on all sides."""
        if not len(self._points):
            return QRectF()
        (left, bottom), (right, top) = self._points.min(axis=0), self._points.max(axis=0)
        across, down = self.pixelVectors()
        room_x = 60 * (across.x() if across is not None else 0.0)
        room_y = 60 * abs(down.y() if down is not None else 0.0)
        return QRectF(left - room_x, bottom - room_y, right - left + 2 * room_x, top - bottom + 2 * room_y)

    def viewTransformChanged(self) -> None:
        """The label keeps its size in pixels, so the rectangle changes with the zoom."""
        self.prepareGeometryChange()

    def paint(self, painter: QPainter, *_: object) -> None:
        """Draw the way in pixels."""
        n = len(self._points)
        if n == 0:
            return
        css = getattr(theme(), self._role)
        transform = painter.transform()
        at_px = [transform.map(QPointF(x, y)) for x, y in self._points]
        painter.resetTransform()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for i in range(n - 1):
            painter.setPen(pg.mkPen(colour(css, 0.35 + 0.65 * (i + 1) / n), width=self._width_px))
            painter.drawLine(at_px[i], at_px[i + 1])
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour(css))
        painter.drawEllipse(at_px[0], 2.5, 2.5)
        self._paint_arrows(painter, np.array([[p.x(), p.y()] for p in at_px]))
        if self._says_time and self._duration_s > 0 and n > 1:
            self._paint_length(painter, at_px[-1] + QPointF(8, -6))

    def _paint_length(self, painter: QPainter, at_px: QPointF) -> None:
        text = f"{1000 * self._duration_s:.0f} ms"
        painter.setFont(small_font())
        box = QRectF(painter.fontMetrics().boundingRect(text)).translated(at_px).adjusted(-3, -1, 3, 1)
        painter.fillRect(box, colour(theme().canvas, 0.7))  # dots lie beneath
        painter.setPen(colour(theme().text))
        painter.drawText(at_px, text)

    def _paint_arrows(self, painter: QPainter, at_px: np.ndarray) -> None:
        steps = np.diff(at_px, axis=0)
        walked = np.concatenate([[0.0], np.cumsum(np.linalg.norm(steps, axis=1))])
        if walked[-1] < 2 * _ARROW_PX:
            return
        for distance in [*np.arange(_ARROW_EVERY_PX, walked[-1] - _ARROW_EVERY_PX / 2, _ARROW_EVERY_PX), walked[-1]]:
            i = min(max(int(np.searchsorted(walked, distance)) - 1, 0), len(steps) - 1)
            length = max(walked[i + 1] - walked[i], 1e-9)
            ahead = steps[i] / length
            tip = at_px[i] + ahead * (distance - walked[i])
            aside = np.array([-ahead[1], ahead[0]])
            corners = [tip, tip - _ARROW_PX * (1.6 * ahead - aside), tip - _ARROW_PX * (1.6 * ahead + aside)]
            painter.drawPolygon(QPolygonF([QPointF(*corner) for corner in corners]))
