"""One map on its canvas: dots, splats, ways and signs. It shows what it is told and says what was pointed at."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QPolygonF
from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.emotion_colours import emotion_colours
from app.jobs import JobRunner
from app.panels.isomap.canvas import MapBox, MapCanvas
from app.panels.isomap.colouring import Colouring
from app.panels.isomap.dots import MotionFrameDots
from app.panels.isomap.items import (
    ContextCorrectNodes,
    NodeInUse,
    NodeTrajectory,
    PickingPoint,
    SelectedFrames,
    SplatImage,
    TimeCorrectFrames,
    WaysInContext,
)
from app.panels.isomap.shown_map import ShownMap
from app.panels.isomap.splat_job import SplatRequest, Splats, draw_splats
from app.panels.map_pick import MapPick
from app.panels.pane import label
from app.theme import STEP

_SETTLED_MS = 150
# the splats lie under the dots and must not outshine them
_SPLAT_OPACITY = 0.6
# a click within so many pixels of a dot is meant for it
_NEAR_PX = 9.0
_MARGIN = 0.06


class MapView(QWidget):
    """A map and its signs.

    pointed(MapPick or None), clicked(MapPick, adds), double_clicked(MapPick), enclosed(nodes, adds), keyed(key, shift)
    """

    pointed = Signal(object)
    clicked = Signal(object, bool)
    double_clicked = Signal(object)
    enclosed = Signal(object, bool)
    keyed = Signal(int, bool)

    def __init__(self, name: str, jobs: JobRunner) -> None:
        super().__init__()
        self._name, self._jobs = name, jobs
        self.shown: ShownMap | None = None
        self.sigma_px, self.rho_gain = 9.0, 1.0
        self._colouring: Colouring | None = None
        self._used: MapPick | None = None
        self._drawn = np.zeros(0, bool)
        self.box = MapBox()
        self.canvas = MapCanvas(self.box)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.canvas)
        self.caption = label("", "small")
        self.caption.setParent(self.canvas)
        self.caption.move(STEP, STEP // 2)
        self.caption.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.splats, self.dots = SplatImage(), MotionFrameDots()
        self.splats.setOpacity(_SPLAT_OPACITY)
        self.used_way, self.kept_way = NodeTrajectory("accent", 2.0), NodeTrajectory("text", 2.0)
        self.pointed_way = NodeTrajectory("text", 1.0, says_time=False)
        self.ways_in_context, self.context_correct = WaysInContext(), ContextCorrectNodes()
        self.time_correct, self.selected = TimeCorrectFrames(), SelectedFrames()
        self.in_use, self.picking_point = NodeInUse(), PickingPoint()
        for item in (
            self.splats, self.dots, self.ways_in_context, self.time_correct, self.context_correct, self.used_way,
            self.kept_way, self.pointed_way, self.selected, self.in_use, self.picking_point,
        ):  # fmt: skip
            self.box.addItem(item, ignoreBounds=True)
        marks = self.context_correct, self.time_correct, self.selected, self.in_use, self.picking_point
        for item in (self.ways_in_context, *marks):
            emotion_colours.changed.connect(item.dress)
        self.box.pointed.connect(lambda point: self.pointed.emit(None if point is None else self.pick(point)))
        self.box.clicked.connect(self._on_clicked)
        self.box.enclosed.connect(self._on_enclosed)
        self.canvas.double_clicked.connect(lambda point: self._say(self.double_clicked, point))
        self.canvas.keyed.connect(self.keyed)
        self._settle = QTimer(self, singleShot=True, interval=_SETTLED_MS)
        self._settle.timeout.connect(self._renew_splats)
        self.box.sigRangeChanged.connect(lambda *_: self._settle.start())

    # What is shown

    def show_map(self, shown: ShownMap | None) -> None:
        """Show another map, whole, without any sign."""
        self.shown = shown
        self.splats.clear()
        for way in (self.used_way, self.kept_way, self.pointed_way):
            way.show_points(np.zeros((0, 2)))
        self.ways_in_context.show_ways([])
        for marks in (self.context_correct, self.time_correct, self.selected, self.in_use, self.picking_point):
            marks.show_at(None)
        self.frame_view()

    def show_colours(self, colouring: Colouring, removed: np.ndarray, hidden: np.ndarray) -> None:
        """Colour the dots; those of removed nodes fade, hidden ones are left out: bool, shape (n_places,)."""
        if self.shown is None:
            return
        self._colouring, self._drawn = colouring, ~hidden & ~removed
        self.dots.show_frames(
            self.shown.points, self.shown.emotion, colouring.colours, colouring.index, removed, hidden
        )
        self.renew_splats()

    def show_splats(self, sigma_px: float, rho_gain: float) -> None:
        """Draw the splats with another σ, pixels, and another ρ, in times of what suits the map."""
        self.sigma_px, self.rho_gain = sigma_px, rho_gain
        self.renew_splats()

    def show_used(self, used: MapPick | None) -> None:
        """Show the node and the frame in use."""
        self._used = used
        self._show_way(self.used_way, None if used is None else used.node)
        self.in_use.show_at(None if used is None else self.place_of(used))

    def show_correct(self, share: float | None, context: tuple[str, str] | None) -> None:
        """Show time-correct frames at relative time ``share`` and context-correct nodes, or none of them."""
        shown = self.shown
        if shown is None or share is None:
            self.time_correct.show_at(None)
            self.context_correct.show_at(None)
            self.ways_in_context.show_ways([])
            return
        at = shown.at_share(share)
        alike = np.zeros(len(at), bool) if context is None else shown.in_context(*context)
        self.time_correct.show_points(at[~alike])
        self.context_correct.show_points(at[alike])
        self.ways_in_context.show_ways([shown.trajectory(int(row)) for row in shown.rows[alike]])

    def show_pointed(self, picked: MapPick | None) -> None:
        """Show the way of the node under the pointer."""
        self._show_way(self.pointed_way, None if picked is None else picked.node)

    def show_kept(self, kept: MapPick | None) -> None:
        """Show the picked place and the way of its node."""
        self._show_way(self.kept_way, None if kept is None else kept.node)
        self.picking_point.show_at(None if kept is None else self.place_of(kept))

    def show_selected(self, rows: frozenset[int]) -> None:
        """Show which nodes are selected, when they are several."""
        shown = self.shown
        if shown is None or len(rows) < 2:
            self.selected.show_at(None)
        else:
            self.selected.show_points(shown.points[np.isin(shown.node, list(rows))])

    def place_of(self, picked: MapPick) -> np.ndarray | None:
        """Return where a mix of frames lies on this map, map units; None when they are not all on it."""
        if self.shown is None:
            return None
        place = np.searchsorted(self.shown.map.frames, picked.frames)
        on_map = np.minimum(place, len(self.shown.map.frames) - 1)
        if not np.array_equal(self.shown.map.frames[on_map], picked.frames):
            return None
        return picked.weights @ self.shown.points[on_map]

    def show_caption(self, text: str) -> None:
        """Show a line in the corner, or none."""
        self.caption.setText(text)
        self.caption.adjustSize()

    def frame_view(self) -> None:
        """Show the whole map."""
        if self.shown is not None:
            left, bottom, right, top = self.shown.bounds
            self.box.setRange(QRectF(left, bottom, right - left, top - bottom), padding=_MARGIN)

    def zoom(self, factor: float) -> None:
        """Show everything ``factor`` times as large."""
        self.box.scaleBy((1 / factor, 1 / factor))

    def pick(self, point: np.ndarray) -> MapPick | None:
        """Return what lies at ``point``, map units: mixed from three captured frames inside the map."""
        return None if self.shown is None else MapPick.under(self.shown, point)

    def _show_way(self, way: NodeTrajectory, row: int | None) -> None:
        if self.shown is None or row is None:
            way.show_points(np.zeros((0, 2)))
            return
        points = self.shown.trajectory(row)
        way.show_points(points, len(points) / self.shown.database.rate_hz)

    # Splats

    def renew_splats(self) -> None:
        """Draw the splats anew once the view has settled."""
        self._settle.start()

    def _renew_splats(self) -> None:
        if self.shown is None or self._colouring is None or not self.isVisible():
            return
        (left, right), (bottom, top) = self.box.viewRange()
        points = self.shown.points
        # what lies beyond reach of the view adds nothing to it
        reach = 3 * self.sigma_px * (right - left) / max(self.canvas.width(), 1)
        near = ((points > [left - reach, bottom - reach]) & (points < [right + reach, top + reach])).all(axis=1)
        near &= self._drawn
        request = SplatRequest(
            points[near], self._colouring.colours[self._colouring.index[near]], self.sigma_px, self.rho_gain,
            (left, bottom, right, top), (max(self.canvas.width(), 1), max(self.canvas.height(), 1)),
        )  # fmt: skip
        self._jobs.start(f"splats {self._name}", "", request, draw_splats, self._show_splats)

    def _show_splats(self, drawn: Splats) -> None:
        self.splats.show_splats(drawn.image, drawn.bounds)

    # Reactions

    def _on_clicked(self, point: np.ndarray, adds: bool) -> None:
        self.canvas.setFocus()
        self._say(self.clicked, point, adds)

    def _say(self, signal, point: np.ndarray, *more: object) -> None:
        """Tell what was clicked: the frame in use, or the captured frame of a dot, if near; else the place itself."""
        if self.shown is None:
            return
        away_px = np.linalg.norm((self.shown.points - point) / self.box.viewPixelSize(), axis=1)
        nearest = int(away_px.argmin())
        in_use = None if self._used is None else self.place_of(self._used)
        use_px = np.inf if in_use is None else np.linalg.norm((in_use - point) / self.box.viewPixelSize())
        if use_px <= min(_NEAR_PX, away_px[nearest]):
            signal.emit(replace(self._used, in_use=False), *more)
        elif away_px[nearest] <= _NEAR_PX:
            signal.emit(MapPick.captured(self.shown, nearest), *more)
        else:
            signal.emit(self.pick(point), *more)

    def _on_enclosed(self, outline: np.ndarray, adds: bool) -> None:
        if self.shown is None:
            return
        polygon = QPolygonF([QPointF(*corner) for corner in outline])
        (left, bottom), (right, top) = outline.min(axis=0), outline.max(axis=0)
        points = self.shown.points
        inside = ((points >= [left, bottom]) & (points <= [right, top])).all(axis=1) & self._drawn
        for place in np.flatnonzero(inside):
            inside[place] = polygon.containsPoint(QPointF(*points[place]), Qt.FillRule.OddEvenFill)
        self.canvas.setFocus()
        self.enclosed.emit(self.shown.nodes_inside(inside), adds)
