"""A still picture of a face from the front, painted without a graphics context, to put dots on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPolygonF

from app.theme import theme
from core.face.face import Face

_LIGHT = np.array([0.25, 0.35, 0.9])
_SHADES = 32
_SHARPER = 2


@dataclass(frozen=True)
class FrontView:
    """Where millimetres are on screen, seen from the front: the actor's left is at the right.

    middle_mm : x and y of the point in the middle of ``area``
    """

    area: QRectF
    middle_mm: tuple[float, float]
    px_per_mm: float

    @classmethod
    def fitting(cls, points: np.ndarray, area: QRectF, margin_px: float = 20.0) -> FrontView:
        """Show all of ``points``, shape (n, 3), mm; NaN are left out."""
        flat = points[np.isfinite(points).all(axis=1), :2]
        if not len(flat):
            return cls(area, (0.0, 0.0), 1.0)
        low, high = flat.min(axis=0), flat.max(axis=0)
        size = np.maximum(high - low, 1e-3)
        room = max(area.width() - 2 * margin_px, 1.0), max(area.height() - 2 * margin_px, 1.0)
        return cls(area, tuple((low + high) / 2), float(min(room[0] / size[0], room[1] / size[1])))

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return x and y on screen, shape (n, 2)."""
        middle = self.area.center()
        away = (np.asarray(points, float)[:, :2] - self.middle_mm) * self.px_per_mm
        return np.column_stack([middle.x() + away[:, 0], middle.y() - away[:, 1]])


def face_picture(face: Face, view: FrontView) -> QImage:
    """Paint a face in quiet greys as large as ``view.area``; what is farther is painted first."""
    width, height = max(int(view.area.width()), 1), max(int(view.area.height()), 1)
    picture = QImage(_SHARPER * width, _SHARPER * height, QImage.Format.Format_ARGB32_Premultiplied)
    picture.fill(Qt.GlobalColor.transparent)
    places = (view.places(face.positions) - [view.area.left(), view.area.top()]) * _SHARPER
    corners = face.positions[face.triangles].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    shade = np.clip(normals @ _LIGHT / np.linalg.norm(_LIGHT), 0.0, 1.0)
    colours = _shades()
    painter = QPainter(picture)
    painter.setPen(Qt.PenStyle.NoPen)
    for t in np.argsort(corners[:, :, 2].mean(axis=1)):
        if normals[t, 2] <= 0.0:
            continue
        painter.setBrush(colours[int(shade[t] * (_SHADES - 1))])
        painter.drawPolygon(QPolygonF([QPointF(*places[v]) for v in face.triangles[t]]))
    painter.end()
    smooth = picture.scaled(width, height, Qt.AspectRatioMode.IgnoreAspectRatio,
                            Qt.TransformationMode.SmoothTransformation)  # fmt: skip
    return smooth


def _shades() -> list[QColor]:
    """From the canvas towards the text colour, quiet enough to put dots on; what is lit is the lighter one."""
    canvas, ink = (QColor(css) for css in (theme().canvas, theme().text))
    lit = np.linspace(0.0, 1.0, _SHADES) ** 1.4
    shares = 0.08 + 0.42 * (lit if canvas.lightness() < ink.lightness() else 1.0 - lit)
    ground, far = (np.array(css.getRgb()[:3], float) for css in (canvas, ink))
    return [QColor(*(int(c) for c in ground + share * (far - ground))) for share in shares]
