"""The few icons, from ``resources/icons``, in the theme's colours and sharp on any screen."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from PySide6.QtCore import QByteArray, Qt
from PySide6.QtGui import QIcon, QImage, QPainter, QPixmap
from PySide6.QtWidgets import QAbstractButton, QWidget

from app.theme import colour, theme

ICONS = Path(__file__).resolve().parents[1] / "resources" / "icons"
_NAME = "icon_name"
_SIZES_PX = (16, 24, 32, 48)


@cache
def _svg(name: str) -> str:
    return (ICONS / f"{name}.svg").read_text(encoding="utf-8")


def icon(name: str, css: str | None = None) -> QIcon:
    """Return the icon ``name``, drawn in ``css`` or the theme's text colour, paler where it is disabled."""
    made = QIcon()
    css = css or theme().text
    for mode, shown in ((QIcon.Mode.Normal, css), (QIcon.Mode.Disabled, theme().line)):
        for size in _SIZES_PX:
            made.addPixmap(_pixmap(name, shown, size), mode)
    return made


def put_icon(button: QAbstractButton, name: str) -> None:
    """Give a button the icon ``name``; `renew_icons` draws it anew in another theme."""
    button.setProperty(_NAME, name)
    button.setIcon(icon(name))


def renew_icons(window: QWidget) -> None:
    """Draw the icons of all buttons in ``window`` in the theme in use."""
    for button in window.findChildren(QAbstractButton):
        if button.property(_NAME):
            button.setIcon(icon(button.property(_NAME)))


def _pixmap(name: str, css: str, size_px: int) -> QPixmap:
    from PySide6.QtSvg import QSvgRenderer

    image = QImage(size_px, size_px, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    text = _svg(name).replace("currentColor", colour(css).name())
    painter = QPainter(image)
    QSvgRenderer(QByteArray(text.encode())).render(painter)
    painter.end()
    return QPixmap.fromImage(image)


def dot(css: str, size_px: int = 10) -> QIcon:
    """Return a filled disc, the sign of an emotion in a list."""
    image = QImage(2 * size_px, 2 * size_px, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour(css))
    painter.drawEllipse(2, 2, 2 * size_px - 4, 2 * size_px - 4)
    painter.end()
    return QIcon(QPixmap.fromImage(image))
