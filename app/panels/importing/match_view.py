"""Captured markers at the left, the wanted ones on a face at the right, and lines between those that are the same."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QLineF, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QImage, QPainter, QPen
from PySide6.QtWidgets import QToolTip, QWidget

from app.panels.importing.face_picture import FrontView, face_picture
from app.texts import importing as texts
from app.theme import STEP, colour, small_font, theme
from core.face.face import Face

REACH_PX = 12.0
_DOT_PX = 3.2
_CHOSEN_PX = 5.5
_TITLE_PX = 24
_MARGIN_PX = 56


@dataclass(frozen=True)
class Cloud:
    """Named dots. points : shape (n, 3), mm, NaN for a marker whose place is unknown."""

    names: tuple[str, ...]
    points: np.ndarray


class MatchView(QWidget):
    """Click a dot at one side, then its place at the other; Escape forgets the first click.

    paired(found, wanted) : two dots were joined; chosen(found) : a captured dot was clicked
    """

    paired = Signal(str, str)
    chosen = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setMinimumSize(420, 280)
        self._found = self._wanted = Cloud((), np.empty((0, 3)))
        self._titles = ("", "")
        self._pairs: Mapping[str, str] = {}
        self._doubtful: frozenset[str] = frozenset()
        self._own = False
        self._face: Face | None = None
        self._picture: tuple[object, QImage] | None = None
        self._picked: tuple[int, str] | None = None
        self._hovered: tuple[int, str] | None = None

    def show_clouds(self, found: Cloud, wanted: Cloud, face: Face | None, titles: tuple[str, str]) -> None:
        """Show other markers."""
        self._found, self._wanted, self._titles = found, wanted, titles
        self._picked = self._hovered = None
        if face is not self._face:
            self._face, self._picture = face, None
        self.update()

    def show_pairs(self, pairs: Mapping[str, str], doubtful: frozenset[str] = frozenset(), own: bool = False) -> None:
        """Draw lines for ``pairs`` (found to wanted), dashed for the ``doubtful`` found ones.

        own : captured markers without a pair are kept too, and nothing to worry about
        """
        self._pairs, self._doubtful, self._own = dict(pairs), doubtful, own
        self.update()

    def choose(self, found: str | None) -> None:
        """Mark a captured marker, as a click on it would, without saying so."""
        self._picked = None if found is None else (0, found)
        self.update()

    # Where things are

    def areas(self) -> tuple[QRectF, QRectF]:
        """Left and right half, below their titles."""
        half = self.width() / 2
        return (QRectF(0, _TITLE_PX, half, self.height() - _TITLE_PX),
                QRectF(half, _TITLE_PX, self.width() - half, self.height() - _TITLE_PX))  # fmt: skip

    def views(self) -> tuple[FrontView, FrontView]:
        """Both halves have one scale, so that lines of a good matching are level."""
        left, right = self.areas()
        theirs = FrontView.fitting(self._wanted.points, right, _MARGIN_PX)
        ours = FrontView.fitting(self._found.points, left, _MARGIN_PX)
        scale = min(theirs.px_per_mm, ours.px_per_mm)
        seen = self._paired_rows()
        if not len(seen):
            return FrontView(left, ours.middle_mm, scale), FrontView(right, theirs.middle_mm, scale)
        # the matched dots decide what is level
        shift = np.nanmean(self._found.points[seen[:, 0], :2] - self._wanted.points[seen[:, 1], :2], axis=0)
        middle = np.nan_to_num(shift) + theirs.middle_mm
        away = np.abs(self._found.points[:, :2] - middle)
        farthest = np.nanmax(away, axis=0) if np.isfinite(away).any() else np.ones(2)
        room = np.array([left.width() / 2 - _MARGIN_PX, left.height() / 2 - _MARGIN_PX])
        scale = float(min(scale, *(room / np.maximum(farthest, 1e-3))))
        return FrontView(left, tuple(middle), scale), FrontView(right, theirs.middle_mm, scale)

    def dots(self) -> tuple[np.ndarray, np.ndarray]:
        """Places on screen of the captured and the wanted markers, each of shape (n, 2)."""
        ours, theirs = self.views()
        return ours.places(self._found.points), theirs.places(self._wanted.points)

    def place_of(self, side: int, name: str) -> QPointF:
        """Return where a marker is on screen; side 0 is the capture."""
        cloud = (self._found, self._wanted)[side]
        return QPointF(*self.dots()[side][cloud.names.index(name)])

    def _paired_rows(self) -> np.ndarray:
        row = {name: i for i, name in enumerate(self._wanted.names)}
        pairs = [(i, row[self._pairs[name]]) for i, name in enumerate(self._found.names)
                 if self._pairs.get(name) in row and np.isfinite(self._found.points[i]).all()]  # fmt: skip
        return np.array(pairs, int).reshape(-1, 2)

    def _at(self, at: QPointF) -> tuple[int, str] | None:
        best, least = None, REACH_PX
        for side, (cloud, places) in enumerate(zip((self._found, self._wanted), self.dots())):
            if not len(places):
                continue
            away = np.hypot(places[:, 0] - at.x(), places[:, 1] - at.y())
            away = np.where(np.isfinite(away), away, np.inf)
            near = int(away.argmin())
            if away[near] < least:
                best, least = (side, cloud.names[near]), float(away[near])
        return best

    # Qt

    def paintEvent(self, _event) -> None:
        """Paint face, lines and dots."""
        with QPainter(self) as painter:
            painter.fillRect(self.rect(), colour(theme().canvas))
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            left, right = self.areas()
            painter.drawImage(right.topLeft(), self._face_image())
            painter.setFont(small_font())
            painter.setPen(colour(theme().dim))
            for area, title in zip((left, right), self._titles):
                box = QRectF(area.left() + STEP + 4, 0, area.width(), _TITLE_PX)
                painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, title)
            found, wanted = self.dots()
            self._paint_lines(painter, found, wanted)
            taken = set(self._pairs.values())
            for side, (cloud, places) in enumerate(((self._found, found), (self._wanted, wanted))):
                for name, (x, y) in zip(cloud.names, places):
                    if np.isfinite(x):
                        joined = name in self._pairs if side == 0 else name in taken
                        self._paint_dot(painter, QPointF(x, y), joined, (side, name))

    def _face_image(self) -> QImage:
        if self._face is None:
            return QImage()
        view = self.views()[1]
        key = (theme().canvas, view.area.width(), view.area.height(), view.middle_mm, view.px_per_mm)
        if self._picture is None or self._picture[0] != key:
            self._picture = key, face_picture(self._face, view)
        return self._picture[1]

    def _paint_lines(self, painter: QPainter, found: np.ndarray, wanted: np.ndarray) -> None:
        lit = self._lit()
        for i, j in self._paired_rows():
            name = self._found.names[i]
            style = Qt.PenStyle.DashLine if name in self._doubtful else Qt.PenStyle.SolidLine
            css, alpha = (theme().accent, 1.0) if name in lit else (theme().text, 0.16)
            if name in self._doubtful and name not in lit:
                css, alpha = theme().accent, 0.55
            painter.setPen(QPen(colour(css, alpha), 1.0, style))
            painter.drawLine(QLineF(*found[i], *wanted[j]))

    def _lit(self) -> set[str]:
        """Captured markers whose line stands out."""
        lit = {name for side, name in filter(None, (self._picked, self._hovered)) if side == 0}
        theirs = {name for side, name in filter(None, (self._picked, self._hovered)) if side == 1}
        return lit | {found for found, wanted in self._pairs.items() if wanted in theirs}

    def _paint_dot(self, painter: QPainter, at: QPointF, joined: bool, which: tuple[int, str]) -> None:
        t = theme()
        if joined:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(colour(t.text))
            painter.drawEllipse(at, _DOT_PX, _DOT_PX)
        elif self._own and which[0] == 0:
            painter.setPen(QPen(colour(t.dim), 1.2))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawEllipse(at, _DOT_PX - 0.6, _DOT_PX - 0.6)
        else:  # another form too, not only another colour
            painter.setPen(QPen(colour(t.emotion["anger"]), 1.4))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(QRectF(at.x() - _DOT_PX, at.y() - _DOT_PX, 2 * _DOT_PX, 2 * _DOT_PX))
        if which in (self._picked, self._hovered):
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(colour(t.accent), 1.6))
            painter.drawEllipse(at, _CHOSEN_PX, _CHOSEN_PX)
            paint_name(painter, at, which[1], self.width())

    def mousePressEvent(self, event) -> None:
        """Choose a dot, or join it to the one chosen at the other side."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        at = self._at(event.position())
        if at is not None and self._picked is not None and at[0] != self._picked[0]:
            found, wanted = (self._picked[1], at[1]) if at[0] == 1 else (at[1], self._picked[1])
            self._picked = None
            self.paired.emit(found, wanted)
        else:
            self._picked = at
            if at is not None and at[0] == 0:
                self.chosen.emit(at[1])
        self.update()

    def mouseMoveEvent(self, event) -> None:
        """Let the line under the pointer stand out."""
        hovered = self._at(event.position())
        if hovered != self._hovered:
            self._hovered = hovered
            self.setCursor(Qt.CursorShape.PointingHandCursor if hovered else Qt.CursorShape.ArrowCursor)
            self.update()

    def keyPressEvent(self, event) -> None:
        """Escape forgets the first click."""
        if event.key() == Qt.Key.Key_Escape and self._picked is not None:
            self._picked = None
            self.update()
        else:
            super().keyPressEvent(event)

    def event(self, event) -> bool:
        """Say what is under the pointer."""
        if event.type() == event.Type.ToolTip:
            at = self._at(QPointF(event.pos()))
            QToolTip.showText(event.globalPos(), "" if at is None else self._told(*at), self)
            return True
        return super().event(event)

    def _told(self, side: int, name: str) -> str:
        if side == 0:
            wanted = self._pairs.get(name)
            tip = texts.UNMATCHED_TIP if wanted is None else texts.MATCHED_TIP
            return tip.format(found=name, wanted=wanted)
        found = next((f for f, w in self._pairs.items() if w == name), None)
        return texts.WANTED_ALONE_TIP.format(wanted=name) if found is None else texts.MATCHED_TIP.format(
            found=found, wanted=name
        )  # fmt: skip


def paint_name(painter: QPainter, at: QPointF, name: str, width_px: int) -> None:
    """Write the name of a dot above it, within a widget of ``width_px``."""
    painter.setFont(small_font())
    width = painter.fontMetrics().horizontalAdvance(name)
    left = min(max(at.x() - width / 2, 4.0), width_px - width - 4.0)
    box = QRectF(left - 4, at.y() - 26, width + 8, 17)
    painter.fillRect(box, colour(theme().raised, 0.92))
    painter.setPen(colour(theme().text))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, name)
