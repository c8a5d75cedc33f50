"""Views on which points are set by a click: a mesh that can be turned, and a photo."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QWidget

from app.panels.face_view import FaceView
from app.panels.own_face.dots import Dot, DotLayer
from app.panels.own_face.work import StillFace
from app.theme import colour, theme
from gpu.gl.camera import Camera, portrait_bounds
from gpu.gl.face import Style

CLICK_PX = 4.0
_SEEN = 0.05
# A click that goes through the slit between lips or lids takes what is beside it: how far, and how deep a slit is.
_SLIT_PX, _SLIT = (2.0, 4.0), 0.012
_AROUND = np.array([(0, -1), (0, 1), (-1, 0), (1, 0)], float)
_ZOOM_PER_STEP, _STEP_ANGLE = 1.15, 120.0


class Place:
    """A point for a view: where it is, shown as `app.panels.own_face.dots.Dot` says."""

    def __init__(self, key: str, at: np.ndarray, **shown: object) -> None:
        self.key, self.at, self.shown = key, np.asarray(at, float), shown


class PointView(FaceView):
    """placed(place) : the surface was clicked there, shape (3,), mm in the view's own space."""

    placed = Signal(object)

    def __init__(self, bounds: Callable = portrait_bounds) -> None:
        super().__init__(bounds)
        self._places: tuple[Place, ...] = ()
        self._still: StillFace | None = None
        self._pressed: QPointF | None = None
        self.dots = DotLayer(self, self._dots)

    def show_still(self, still: StillFace) -> None:
        """Show another mesh that is clicked."""
        self._still = still
        self.set_rig(still)
        self.set_style(Style.TEXTURED if still.face.texture is not None or still.face.landmarks else Style.SHADED)
        self.show_pose(np.zeros((1, 3), np.float32))

    def show_shaped(self, shaped) -> None:
        """Show a face that is not clicked; see `FaceView.show_pose`."""
        self._still = None
        self.set_rig(shaped)
        self.set_style(Style.TEXTURED)

    def show_places(self, places: tuple[Place, ...]) -> None:
        """Show other points."""
        self._places = places
        self.dots.update()

    def on_screen(self, places: np.ndarray) -> np.ndarray:
        """Return where places, shape (n, 3), are in the widget: shape (n, 2)."""
        aspect = self.width() / max(self.height(), 1)
        camera = self.camera or Camera()
        matrix = camera.projection(aspect) @ camera.view(aspect)
        at = np.column_stack([places, np.ones(len(places))]) @ matrix.T
        flat = at[:, :2] / np.where(np.abs(at[:, 3:]) > 1e-9, at[:, 3:], 1e-9)
        return (flat * [0.5, -0.5] + 0.5) * [self.width(), self.height()]

    def place_at(self, at: QPointF) -> np.ndarray | None:
        """Return the place of the mesh under a point of the widget, shape (3,), mm; None beside it."""
        camera = self.camera
        if self._still is None or camera is None:
            return None
        aspect = self.width() / max(self.height(), 1)
        view = camera.view(aspect)
        half = np.tan(np.radians(camera.fov_deg) / 2)
        # the nearest of the others comes first among equals
        around = np.vstack([np.zeros((1, 2)), *(_AROUND * reach for reach in _SLIT_PX)])
        pixels = around + np.array([at.x(), at.y()])
        flat = (2 * pixels / [self.width(), self.height()] - 1) * [half * aspect, -half]
        turn = view[:3, :3]
        rays = np.column_stack([flat, np.full(len(flat), -1.0)]) @ turn
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        slit_mm = _SLIT * float(np.ptp(self._still.face.positions, axis=0).max())
        return self._still.clickable.hit(-turn.T @ view[:3, 3], rays, slit_mm)

    def _dots(self) -> list[Dot]:
        if not self._places or self._still is None:
            return []
        at = np.array([place.at for place in self._places])
        camera = self.camera or Camera()
        view = camera.view(self.width() / max(self.height(), 1))
        towards = -view[:3, :3].T @ view[:3, 3] - at
        towards /= np.maximum(np.linalg.norm(towards, axis=1, keepdims=True), 1e-9)
        seen = np.einsum("ij,ij->i", towards, self._still.normals_at(at)) > _SEEN
        screen = self.on_screen(at)
        return [
            Dot(QPointF(*xy), is_seen=bool(is_seen), **place.shown)
            for xy, is_seen, place in zip(screen, seen, self._places)
        ]

    # Qt

    def update(self) -> None:
        """Draw again, dots and all."""
        super().update()
        self.dots.update()

    def resizeEvent(self, event) -> None:
        """Keep the dots over it."""
        super().resizeEvent(event)
        self.dots.setGeometry(self.rect())

    def mousePressEvent(self, event) -> None:
        """Begin a click, or a turn."""
        super().mousePressEvent(event)
        plain = event.button() == Qt.MouseButton.LeftButton and not event.modifiers()
        self._pressed = event.position() if plain else None

    def mouseReleaseEvent(self, event) -> None:
        """Set a point where nothing was turned in between."""
        super().mouseReleaseEvent(event)
        pressed, self._pressed = self._pressed, None
        if pressed is None:
            return
        moved = event.position() - pressed
        if np.hypot(moved.x(), moved.y()) < CLICK_PX:
            place = self.place_at(event.position())
            if place is not None:
                self.placed.emit(place)

    def mouseDoubleClickEvent(self, event) -> None:
        """Be two clicks: framing the view would lose the place."""
        self.mousePressEvent(event)


class PhotoView(QWidget):
    """placed(place) : the photo was clicked there, shape (2,), its own pixels. The wheel zooms, a drag moves."""

    placed = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumSize(200, 160)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._image = QImage()
        self._places: tuple[Place, ...] = ()
        self._zoom, self._shift = 1.0, QPointF()
        self._pressed: QPointF | None = None
        self._last: QPointF | None = None
        self.dots = DotLayer(self, self._dots)

    def show_photo(self, photo: np.ndarray | None) -> None:
        """Show another photo, uint8, shape (h, w, 3)."""
        self._zoom, self._shift = 1.0, QPointF()
        if photo is None:
            self._image = QImage()
        else:
            height, width = photo.shape[:2]
            # the image shares the array's memory: a copy keeps it alive
            whole = np.ascontiguousarray(photo)
            self._image = QImage(whole.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()
        self.update()

    def show_places(self, places: tuple[Place, ...]) -> None:
        """Show other points."""
        self._places = places
        self.dots.update()

    def area(self) -> QRectF:
        """Return where the whole photo lies in the widget."""
        width, height = max(self._image.width(), 1), max(self._image.height(), 1)
        scale = self._zoom * min(self.width() / width, self.height() / height)
        middle = QRectF(self.rect()).center() + self._shift
        return QRectF(middle.x() - scale * width / 2, middle.y() - scale * height / 2, scale * width, scale * height)

    def on_screen(self, pixels: np.ndarray) -> np.ndarray:
        """Return where pixels of the photo (n, 2) are in the widget: shape (n, 2)."""
        area = self.area()
        size = np.array([max(self._image.width(), 1), max(self._image.height(), 1)])
        return np.asarray(pixels, float) / size * [area.width(), area.height()] + [area.left(), area.top()]

    def _dots(self) -> list[Dot]:
        if self._image.isNull() or not self._places:
            return []
        screen = self.on_screen(np.array([place.at for place in self._places]))
        return [Dot(QPointF(*xy), **place.shown) for xy, place in zip(screen, self._places)]

    # Qt

    def paintEvent(self, _event) -> None:
        """Paint the photo."""
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), colour(theme().canvas))
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
            if not self._image.isNull():
                painter.drawImage(self.area(), self._image)

    def resizeEvent(self, event) -> None:
        """Keep the dots over it."""
        super().resizeEvent(event)
        self.dots.setGeometry(self.rect())

    def mousePressEvent(self, event) -> None:
        """Begin a click, or a move."""
        self._last = event.position()
        self._pressed = event.position() if event.button() == Qt.MouseButton.LeftButton else None

    def mouseMoveEvent(self, event) -> None:
        """Move the photo."""
        if self._last is not None and event.buttons():
            self._shift += event.position() - self._last
            self._last = event.position()
            self.update()
            self.dots.update()

    def mouseReleaseEvent(self, event) -> None:
        """Set a point where nothing was moved in between."""
        pressed, self._pressed, self._last = self._pressed, None, None
        if pressed is None or self._image.isNull():
            return
        moved, area = event.position() - pressed, self.area()
        if np.hypot(moved.x(), moved.y()) < CLICK_PX and area.contains(event.position()):
            at = event.position() - area.topLeft()
            scale = self._image.width() / area.width()
            self.placed.emit(np.array([at.x() * scale, at.y() * scale]))

    def wheelEvent(self, event) -> None:
        """Zoom about the pointer."""
        factor = _ZOOM_PER_STEP ** (event.angleDelta().y() / _STEP_ANGLE)
        zoom = float(np.clip(self._zoom * factor, 0.5, 20.0))
        away = event.position() - QRectF(self.rect()).center() - self._shift
        self._shift -= away * (zoom / self._zoom - 1.0)
        self._zoom = zoom
        self.update()
        self.dots.update()
