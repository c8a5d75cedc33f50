"""The two faces: beside each other and turned together, or one over the other."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QSplitter, QStackedWidget, QWidget

from app.panels.compare.pens import PAINT, side_colour
from app.panels.face_view import FaceView
from app.panels.pane import Pane
from app.pictures import FaceRig
from app.texts import compare as texts
from app.theme import STEP
from core.motion.marker_set import MarkerSet
from gpu.gl.face import FaceRenderer, Style


class PairedView(FaceView):
    """A face whose camera takes another along."""

    def __init__(self, key: str) -> None:
        super().__init__(marker_colour=PAINT[key])
        self.partner: PairedView | None = None

    def frame_view(self) -> None:
        """Look from the front, both."""
        for view in (self, self.partner):
            FaceView.frame_view(view)

    def look_from_side(self) -> None:
        """Look from the side, both."""
        for view in (self, self.partner):
            FaceView.look_from_side(view)

    def _move_camera(self, moved) -> None:
        for view in (self, self.partner):
            FaceView._move_camera(view, moved)


class OverlaidView(FaceView):
    """A face and the lines of the same face in another pose over it; or markers in two colours."""

    def __init__(self) -> None:
        super().__init__(marker_colour=PAINT["one"], beside_colour=PAINT["other"])
        self._lines: FaceRenderer | None = None
        self._lines_rig: FaceRig | None = None
        self._other: np.ndarray | None = None

    def show_both(self, one: np.ndarray, other: np.ndarray, besides: dict[str, object]) -> None:
        """Show two poses, both displacements from rest, shape (n_markers, 3), mm."""
        self._other = other
        self.show_pose(one, besides)
        self.show_beside(other, None)

    def release(self) -> None:
        """Free the GL objects, while the context is still there."""
        if self._lines is not None:
            self.makeCurrent()
            self._lines.release()
            self._lines = None
        super().release()

    def initializeGL(self) -> None:
        """Make the GL objects."""
        super().initializeGL()
        self._lines, self._lines_rig = FaceRenderer(self._ctx), None

    def paintGL(self) -> None:
        """Draw one pose, and the other over it."""
        super().paintGL()
        if self._lines is None or not self.shows_mesh or self._other is None or self._drawn_style is None:
            return
        if self._lines_rig is not self._rig:
            self._lines_rig = self._rig
            self._lines.set_face(self._rig.face, light=self._renderer.light, arrays=self._rig.arrays)
        self._lines.set_positions(self._rig.pose(self._other, **self._besides))
        framebuffer = self._ctx.detect_framebuffer(self.defaultFramebufferObject())
        self._lines.draw_lines_over(framebuffer, self.camera, PAINT["other"])


class Swatch(QWidget):
    """A small square in the colour that one of the two has in the curves."""

    def __init__(self, key: str) -> None:
        super().__init__()
        self.setFixedSize(STEP, STEP)
        self._key = key

    def paintEvent(self, _event) -> None:
        """Fill it."""
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), side_colour(self._key))


class ComparedFaces(QStackedWidget):
    """Panes for A, for B, and for A with B over it."""

    def __init__(self) -> None:
        super().__init__()
        one, other = PairedView("one"), PairedView("other")
        one.partner, other.partner = other, one
        self.one, self.other = (
            Pane(title, view, texts.WAITING) for title, view in ((texts.ONE, one), (texts.OTHER, other))
        )
        self.overlaid = OverlaidView()
        self.both = Pane(texts.BOTH, self.overlaid, texts.WAITING)
        self.views = (one, other, self.overlaid)
        for pane, keys in ((self.one, ("one",)), (self.other, ("other",)), (self.both, ("one", "other"))):
            for place, key in enumerate(keys):
                pane.header.insertWidget(place, Swatch(key), 0, Qt.AlignmentFlag.AlignVCenter)
            pane.setMinimumHeight(140)
            pane.hide_footer()
        beside = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        beside.addWidget(self.one)
        beside.addWidget(self.other)
        self.addWidget(beside)
        self.addWidget(self.both)

    @property
    def is_overlaid(self) -> bool:
        """Whether one is shown over the other."""
        return self.currentWidget() is self.both

    def overlay(self, overlaid: bool) -> None:
        """Show one over the other, or both beside each other."""
        self.setCurrentIndex(int(overlaid))

    def show_on(self, markers: MarkerSet | None, rig: FaceRig | None) -> None:
        """Show other markers, on another face or none."""
        for view in self.views:
            view.set_markers(markers)
            view.set_rig(rig)

    def set_style(self, style: Style) -> None:
        """Choose markers, wireframe or face for all."""
        for view in self.views:
            view.set_style(style)

    def say(self, one: str, other: str) -> None:
        """Say whose faces they are."""
        self.one.info.setText(one)
        self.other.info.setText(other)
        self.both.info.setText(f"{one} · {other}")

    def show_empty(self, text: str) -> None:
        """Say what to do next instead."""
        for pane in (self.one, self.other, self.both):
            pane.show_empty(text)

    def show_poses(self, one: np.ndarray, other: np.ndarray, besides: dict[str, object]) -> None:
        """Show one pose of each, displacements from rest, shape (n_markers, 3), mm."""
        for pane in (self.one, self.other, self.both):
            pane.show_content()
        if self.is_overlaid:
            self.overlaid.show_both(one, other, besides)
        else:
            self.views[0].show_pose(one, besides)
            self.views[1].show_pose(other, besides)
