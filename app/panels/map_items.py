"""What can be seen on a phoneme map: one class for each thing that has a name."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt, Signal

from app.theme import EMOTION_SYMBOLS, colour, theme
from core.speech.emotion import EMOTIONS

Z_SPLATS, Z_DOTS, Z_TRAJECTORY, Z_MARKS = -10, 0, 5, 10

# crowded maps take smaller, paler dots, so that their density still shows
DOT_PX, CROWDED_DOT_PX = 5, 3
DOT_COVER, CROWDED_DOT_COVER = 0.85, 0.5
CROWD = 3000
MARK_PX = 15
_NO_POINTS = np.zeros((0, 2))


class MapBox(pg.ViewBox):
    """The plane of the map: wheel zooms, drag moves, and it says where the pointer is.

    pointed(point), clicked(point) : map units; ``point`` is None when the pointer leaves
    """

    pointed = Signal(object)
    clicked = Signal(object)

    def __init__(self) -> None:
        super().__init__(lockAspect=True, enableMenu=False)

    def hoverEvent(self, event) -> None:
        """Say what is under the pointer."""
        self.pointed.emit(None if event.isExit() else _array(self.mapToView(event.pos())))

    def mouseClickEvent(self, event) -> None:
        """Say what was clicked."""
        if event.button() == Qt.MouseButton.LeftButton:
            event.accept()
            self.clicked.emit(_array(self.mapToView(event.pos())))


class MapCanvas(pg.GraphicsView):
    """The widget around the plane.

    double_clicked(point) : map units; taken here because the scene loses the second click when it follows the first
    """

    double_clicked = Signal(object)

    def __init__(self, box: MapBox) -> None:
        super().__init__(background=theme().canvas)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._box = box
        self.setCentralItem(box)

    def mouseDoubleClickEvent(self, event) -> None:
        """Say what was double-clicked."""
        if event.button() == Qt.MouseButton.LeftButton:
            event.accept()
            self.double_clicked.emit(_array(self._box.mapSceneToView(self.mapToScene(event.position().toPoint()))))


def _array(point: QPointF) -> np.ndarray:
    return np.array([point.x(), point.y()])


class SplatImage(pg.ImageItem):
    """Where the frames lie and how densely."""

    def __init__(self) -> None:
        super().__init__(axisOrder="row-major")
        self.setZValue(Z_SPLATS)

    def show_splats(self, image: np.ndarray, bounds: tuple[float, float, float, float]) -> None:
        """Show what `core.manifold.splat.splat_image` made for ``bounds``."""
        left, bottom, right, top = bounds
        # light on the canvas, whatever its colour: brightness becomes coverage
        cover = image.max(axis=2, keepdims=True)
        painted = np.concatenate([image / np.maximum(cover, 1e-6), cover], axis=2)
        self.setImage((painted[::-1] * 255).astype(np.uint8), autoLevels=False, levels=(0, 255))
        self.setRect(QRectF(left, bottom, right - left, top - bottom))


class MotionFrameDots(pg.ScatterPlotItem):
    """All frames of the cluster, each with its emotion's colour and symbol."""

    def __init__(self) -> None:
        super().__init__(size=DOT_PX, pxMode=True, pen=None)
        self.setZValue(Z_DOTS)

    def show_frames(self, points: np.ndarray, emotions: np.ndarray) -> None:
        """Show frames at ``points``, shape (n, 2), with emotions as indices into `EMOTIONS`."""
        crowded = len(points) > CROWD
        size, cover = (CROWDED_DOT_PX, CROWDED_DOT_COVER) if crowded else (DOT_PX, DOT_COVER)
        brushes = np.array([pg.mkBrush(colour(theme().emotion[e], cover)) for e in EMOTIONS], object)
        symbols = np.array([EMOTION_SYMBOLS[e] for e in EMOTIONS], object)
        self.setData(pos=points, brush=brushes[emotions], symbol=symbols[emotions].tolist(), size=size, pen=None)


class NodeTrajectory(pg.PlotCurveItem):
    """The way of one motion node over the map."""

    def __init__(self, css: str, width_px: float) -> None:
        super().__init__(pen=pg.mkPen(colour(css, 0.9), width=width_px), antialias=True)
        self.setZValue(Z_TRAJECTORY)

    def show_points(self, points: np.ndarray) -> None:
        """Show a way, shape (n, 2); an empty one hides it."""
        self.setData(points[:, 0], points[:, 1])


class MapMark(pg.ScatterPlotItem):
    """One sign on the map: the frame in use (a diamond) or the picked place (a ring)."""

    def __init__(self, symbol: str, css: str, size_px: int = MARK_PX) -> None:
        halo = pg.mkBrush(colour(theme().canvas, 0.55))
        super().__init__(symbol=symbol, size=size_px, pen=pg.mkPen(colour(css), width=2), brush=halo, pxMode=True)
        self.setZValue(Z_MARKS)

    def show_at(self, point: np.ndarray | None) -> None:
        """Move it, or hide it."""
        self.setData(pos=_NO_POINTS if point is None else np.asarray(point)[None])
