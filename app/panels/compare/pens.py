"""Who has which colour and line in the compare window."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPen

from app.theme import DARK, colour, theme

# Faces stand in a dark studio in any theme.
PAINT = {
    "one": tuple(QColor(DARK.accent).getRgbF()[:3]),
    "other": tuple(QColor(DARK.other).getRgbF()[:3]),
}


def side_colour(key: str) -> QColor:
    """Return the colour of a line: A, B, the capture, or what lies between A and B (face, lips)."""
    t = theme()
    return colour({"one": t.accent, "other": t.other, "captured": t.text, "face": t.text, "lips": t.dim}[key])


def side_pen(key: str) -> QPen:
    """Return the pen of a line; the capture is dotted."""
    pen = QPen(side_colour(key), 1.2 if key in ("captured", "lips") else 1.6)
    if key == "captured":
        pen.setStyle(Qt.PenStyle.DotLine)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen
