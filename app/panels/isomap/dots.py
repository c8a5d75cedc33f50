"""All captured frames of a map as dots, fast enough to move twenty thousand of them smoothly."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from pyqtgraph.graphicsItems.ScatterPlotItem import drawSymbol

# pyqtgraph's way to hand Qt an array of stamps without a Python object for each; its scatter plot draws by it too,
# but takes a tenth of a second to take new colours for 20,000 points
from pyqtgraph.Qt.internals import PrimitiveArray
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPixmap

from app.panels.isomap.items import Z_DOTS
from app.theme import EMOTION_SYMBOLS
from core.speech.emotion import EMOTIONS

# crowded maps take smaller, paler dots, so that their density still shows
DOT_PX, CROWDED_DOT_PX = 5, 4
DOT_COVER, CROWDED_DOT_COVER = 0.85, 0.6
CROWD = 3000
FADED_COVER = 0.13
_CELL_PX = 12


class MotionFrameDots(pg.GraphicsObject):
    """Every frame of the cluster: its colour as `app.panels.isomap.colouring` says, its symbol by emotion."""

    def __init__(self) -> None:
        super().__init__()
        self.setZValue(Z_DOTS)
        self._points = np.zeros((0, 2))
        self._cell = np.zeros(0, int)
        self._colours = np.zeros((0, 3))
        self._crowded = False
        self._stamps: QPixmap | None = None
        self._scale = 1.0
        self._fragments = PrimitiveArray(QPainter.PixmapFragment, 10)

    def show_frames(
        self, points: np.ndarray, emotion: np.ndarray, colours: np.ndarray, index: np.ndarray, faded: np.ndarray,
        hidden: np.ndarray,
    ) -> None:  # fmt: skip
        """Show frames at ``points``, shape (n, 2), map units.

        emotion : int, shape (n,), index into `EMOTIONS`, which chooses the symbol
        colours, index : colours, shape (n_colours, 3), 0..1, and which of them each frame has
        faded, hidden : bool, shape (n,); removed frames fade, filtered ones are not drawn
        """
        self.prepareGeometryChange()
        seen = ~hidden
        # faded ones first, so that they lie underneath
        order = np.flatnonzero(seen)[np.argsort(~faded[seen], kind="stable")]
        self._points = points[order]
        self._cell = (emotion[order] * 2 + faded[order]) * len(colours) + index[order]
        self._colours, self._crowded = colours, len(points) > CROWD
        self._stamps = None
        self.update()

    @property
    def n_shown(self) -> int:
        """Number of dots that are drawn."""
        return len(self._points)

    def boundingRect(self) -> QRectF:
        """See `pyqtgraph.GraphicsObject`."""
        if not len(self._points):
            return QRectF()
        (left, bottom), (right, top) = self._points.min(axis=0), self._points.max(axis=0)
        return QRectF(left, bottom, right - left, top - bottom)

    def paint(self, painter: QPainter, _option: object, widget=None) -> None:
        """Stamp the dots that are in view."""
        if not len(self._points):
            return
        scale = 1.0 if widget is None else widget.devicePixelRatioF()
        if self._stamps is None or self._scale != scale:
            self._stamps, self._scale = self._make_stamps(scale), scale
        at_px = np.vstack(pg.functions.transformCoordinates(painter.transform(), self._points.T)).T
        width, height = painter.device().width(), painter.device().height()
        inside = ((at_px > -_CELL_PX) & (at_px < [width + _CELL_PX, height + _CELL_PX])).all(axis=1)
        painter.resetTransform()
        cell, cell_px = self._cell[inside], _CELL_PX * scale
        self._fragments.resize(len(cell))
        fragments = self._fragments.ndarray()
        fragments[:, 0:2] = at_px[inside]
        fragments[:, 2] = (cell % len(self._colours)) * cell_px
        fragments[:, 3] = (cell // len(self._colours)) * cell_px
        fragments[:, 4:6] = cell_px
        fragments[:, 6:10] = [1 / scale, 1 / scale, 0.0, 1.0]
        if len(cell):
            painter.drawPixmapFragments(*self._fragments.drawargs(), self._stamps)

    def _make_stamps(self, scale: float) -> QPixmap:
        """Draw each dot that occurs once: a column a colour, a row an emotion, faded or not."""
        n_colours = len(self._colours)
        cell_px = round(_CELL_PX * scale)
        stamps = QPixmap(max(n_colours, 1) * cell_px, 2 * len(EMOTIONS) * cell_px)
        stamps.fill(Qt.GlobalColor.transparent)
        size, cover = (CROWDED_DOT_PX, CROWDED_DOT_COVER) if self._crowded else (DOT_PX, DOT_COVER)
        painter = QPainter(stamps)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for cell in np.unique(self._cell):
            row, column = divmod(int(cell), n_colours)
            shade = QColor.fromRgbF(*map(float, self._colours[column]))
            shade.setAlphaF(FADED_COVER if row % 2 else cover)
            painter.resetTransform()
            painter.translate((column + 0.5) * cell_px, (row + 0.5) * cell_px)
            symbol = EMOTION_SYMBOLS[EMOTIONS[row // 2]]
            drawSymbol(painter, symbol, size * scale, pg.mkPen(None), pg.mkBrush(shade))
        painter.end()
        return stamps
