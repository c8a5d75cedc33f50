"""A view of a face or its markers in 3D that can be turned."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPointF, Qt, QTimer
from PySide6.QtOpenGLWidgets import QOpenGLWidget

from app import texts
from app.face_light import face_light
from app.panels.focus_ring import FocusRing
from app.panels.marker_links import marker_links
from app.pictures import FaceRig
from core.face.face import Face
from core.motion.marker_set import MarkerSet
from gpu.gl.camera import Camera, portrait_bounds
from gpu.gl.face import FaceRenderer, Style
from gpu.gl.libraries import library_names

log = logging.getLogger("gpu")

_DEGREES_PER_PX = 0.4
_ZOOM_PER_STEP = 1.15
_DEGREES_PER_KEY = 5.0
_TURNS = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, 1), Qt.Key.Key_Down: (0, -1)}
_LIP_COLOUR = (0.93, 0.66, 0.50)
_MARKER_COLOUR = (0.80, 0.82, 0.85)
_CAPTURED_COLOUR = (0.42, 0.66, 0.98)
_TRAIL_COLOUR = (0.89, 0.68, 0.33)
_STEP_ANGLE = 120.0  # eighths of a degree in one notch of a wheel


class FaceView(QOpenGLWidget):
    """Shows one pose of a marker set, on a face or bare. GL objects live in the widget's own context.

    bounds : the box of a face that is in view from the front, see `gpu.gl.camera.portrait_bounds`
    marker_colour, beside_colour : of all markers, and of those beside them, 0..1; None: as everywhere
    """

    def __init__(
        self, bounds: Callable[[Face], np.ndarray] = portrait_bounds,
        marker_colour: tuple[float, float, float] | None = None,
        beside_colour: tuple[float, float, float] | None = None,
    ) -> None:  # fmt: skip
        super().__init__()
        self._bounds = bounds
        self._marker_colour, self._beside_colour = marker_colour, beside_colour or _CAPTURED_COLOUR
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setStatusTip(texts.ORBIT_TIP)
        self.focus_ring = FocusRing(self)
        self._renderer: FaceRenderer | None = None
        self._ctx = None
        self._markers: MarkerSet | None = None
        self._rig: FaceRig | None = None
        self._displacements: np.ndarray | None = None
        self._besides: dict[str, object] = {}
        self._captured: np.ndarray | None = None
        self._trails: np.ndarray | None = None
        self._ghost_shape = (0, 0, 0)
        self._style = Style.TEXTURED
        self._drawn_style: Style | None = None
        self._front: dict[bool, Camera] = {}
        self._camera: dict[bool, Camera] = {}
        self._drag_from: QPointF | None = None
        self._stale = {"face": True, "markers": True, "pose": True, "ghosts": True}

    # What is shown

    def set_markers(self, markers: MarkerSet | None) -> None:
        """Show another marker set, at rest."""
        self._markers, self._displacements = markers, None
        if markers is not None:
            self._set_camera(False, np.stack([markers.rest.min(axis=0), markers.rest.max(axis=0)]))
        self._renew("markers")

    def set_rig(self, rig: FaceRig | None) -> None:
        """Show another face, or none."""
        self._rig = rig
        if rig is not None:
            self._set_camera(True, self._bounds(rig.face))
        self._renew("face")

    def set_style(self, style: Style) -> None:
        """Choose markers, wireframe or face; without a face there are markers."""
        self._style = style
        self._renew("pose")

    def show_pose(self, displacements: np.ndarray | None, besides: dict[str, object] | None = None) -> None:
        """Show markers displaced from rest, shape (n_markers, 3), mm; None is the rest pose.

        besides : what moves besides the markers, as `core.synthesis.pose_tracks.PoseTracks.at` gives it
        """
        self._displacements, self._besides = displacements, besides or {}
        self._renew("pose")

    def show_beside(self, captured: np.ndarray | None, trails: np.ndarray | None) -> None:
        """Show with the markers what was captured, and where some of them come from.

        captured : displacements, shape (n_markers, 3), mm, or None
        trails : displaced positions of some markers in the frames before, shape (n_trails, n_steps, 3), mm, or None
        """
        self._captured, self._trails = captured, trails
        self._renew("ghosts")

    @property
    def shows_mesh(self) -> bool:
        """Whether a face is drawn, not markers."""
        return self._rig is not None and self._style is not Style.MARKERS

    # Camera

    def frame_view(self) -> None:
        """Look from the front, all in view."""
        self._camera.update(self._front)
        self.update()

    def look_from_side(self) -> None:
        """Look from the character's left."""
        for key, front in self._front.items():
            self._camera[key] = front.orbited(90.0, 0.0)
        self.update()

    @property
    def camera(self) -> Camera | None:
        """The camera that draws."""
        return self._camera.get(self.shows_mesh)

    def _set_camera(self, mesh: bool, bounds_mm: np.ndarray) -> None:
        front = Camera.front(bounds_mm)
        now = next(iter(self._camera.values()), None)
        self._front[mesh] = front
        self._camera[mesh] = front if now is None else replace(
            front, azimuth_deg=now.azimuth_deg, elevation_deg=now.elevation_deg, zoom=now.zoom
        )  # fmt: skip

    def _move_camera(self, moved) -> None:
        self._camera = {key: moved(camera) for key, camera in self._camera.items()}
        self.update()

    # Drawing

    def _renew(self, what: str) -> None:
        self._stale[what] = self._stale["pose"] = True
        self.update()

    def _upload(self, renderer: FaceRenderer) -> None:
        if self._stale["face"] and self._rig is not None:
            light = face_light().of(self._rig.face)
            renderer.set_face(self._rig.face, light=light, arrays=self._rig.arrays)
            if light is None:
                face_light().keep(self._rig.face, renderer.light)
            self._stale["face"], self._drawn_style = False, None
        if self._stale["markers"] and self._markers is not None:
            colours = np.tile(self._marker_colour or _MARKER_COLOUR, (len(self._markers), 1))
            if self._marker_colour is None:
                colours[self._markers.group("lips")] = _LIP_COLOUR
            renderer.set_markers(self._markers.rest, colours, marker_links(self._markers))
            self._stale["markers"] = False
        if self._stale["ghosts"] and self._markers is not None:
            self._upload_ghosts(renderer)
            self._stale["ghosts"] = False
        # a rig is posed by its controls, without markers
        poseable = self._markers is not None or (self.shows_mesh and self._displacements is not None)
        if self._stale["pose"] and poseable:
            displacements = self._displacements
            if displacements is None:
                displacements = np.zeros((len(self._markers), 3), np.float32)
            if self.shows_mesh:
                renderer.set_positions(self._rig.pose(displacements, **self._besides))
            else:
                renderer.markers.set_positions(self._markers.rest + displacements)
            self._stale["pose"] = False

    def _upload_ghosts(self, renderer: FaceRenderer) -> None:
        trails = np.empty((0, 1, 3)) if self._trails is None else self._trails
        captured = np.empty((0, 3)) if self._captured is None else self._markers.rest + self._captured
        n_captured, (n_trails, n_steps, _) = len(captured), trails.shape
        points = np.concatenate([captured, trails.reshape(-1, 3)])
        colours = np.concatenate([np.tile(self._beside_colour, (n_captured, 1)),
                                  np.tile(_TRAIL_COLOUR, (n_trails * n_steps, 1))])  # fmt: skip
        ends = n_captured + np.arange(n_trails * n_steps).reshape(n_trails, n_steps)
        links = np.stack([ends[:, :-1], ends[:, 1:]], axis=-1).reshape(-1, 2)
        shape = n_captured, n_trails, n_steps
        if shape == self._ghost_shape:
            renderer.ghosts.set_positions(points)
        else:
            renderer.ghosts.set_markers(points, colours, links)
            self._ghost_shape = shape

    def release(self) -> None:
        """Free the GL objects, while the context is still there."""
        if self._renderer is not None:
            self.makeCurrent()
            self._renderer.release()
            self._renderer = None
            self.doneCurrent()

    # Qt

    def initializeGL(self) -> None:
        """Make the GL objects; a widget moved to another window comes here again, with a new context."""
        import moderngl

        self._ctx = moderngl.create_context(require=330, **library_names("libgl", "libx11"))
        self._renderer = FaceRenderer(self._ctx)
        self._stale = dict.fromkeys(self._stale, True)
        self._ghost_shape = (0, 0, 0)

    def resizeEvent(self, event) -> None:
        """Keep the ring around it."""
        super().resizeEvent(event)
        self.focus_ring.fit()

    def paintGL(self) -> None:
        """Draw the pose."""
        if self._renderer is None:
            return
        self._upload(self._renderer)
        framebuffer = self._ctx.detect_framebuffer(self.defaultFramebufferObject())
        camera, style = self.camera or Camera(), self._style if self.shows_mesh else Style.MARKERS
        if self._renderer.draw(framebuffer, camera, style, new_at_most=1):
            self._drawn_style = style
            return
        if self._drawn_style is not None:  # rather than none at all, until the new one is made
            self._renderer.draw(framebuffer, camera, self._drawn_style)
        QTimer.singleShot(0, self, self.update)

    def mousePressEvent(self, event) -> None:
        """Begin to turn or move."""
        self._drag_from = event.position()

    def mouseMoveEvent(self, event) -> None:
        """Turn; with the right button or Shift, move."""
        if self._drag_from is None:
            return
        moved = event.position() - self._drag_from
        self._drag_from = event.position()
        pans = event.buttons() & (Qt.MouseButton.RightButton | Qt.MouseButton.MiddleButton)
        if pans or event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
            half_px = max(self.height() / 2, 1)
            self._move_camera(lambda camera: camera.panned(-moved.x() / half_px, moved.y() / half_px))
        else:
            turn = -moved.x() * _DEGREES_PER_PX, moved.y() * _DEGREES_PER_PX
            self._move_camera(lambda camera: camera.orbited(*turn))

    def mouseReleaseEvent(self, _event) -> None:
        """End the turn."""
        self._drag_from = None

    def mouseDoubleClickEvent(self, _event) -> None:
        """Frame the view."""
        self.frame_view()

    def keyPressEvent(self, event) -> None:
        """Turn by Shift and an arrow."""
        turn = _TURNS.get(event.key())
        if turn is None or event.modifiers() != Qt.KeyboardModifier.ShiftModifier:
            super().keyPressEvent(event)
            return
        self._move_camera(lambda camera: camera.orbited(*(_DEGREES_PER_KEY * share for share in turn)))

    def wheelEvent(self, event) -> None:
        """Zoom."""
        factor = _ZOOM_PER_STEP ** (event.angleDelta().y() / _STEP_ANGLE)
        self._move_camera(lambda camera: camera.zoomed(factor))
