"""The ruler: seconds, frames or timecode."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from PySide6.QtCore import QLineF, QRectF, Qt
from PySide6.QtGui import QPainter

from app.panels.timeline.lanes import TimeScale
from app.theme import colour, small_font, theme
from core.media.video import timecode

SECONDS, FRAMES, TIMECODE = "seconds", "frames", "timecode"
UNITS = (SECONDS, FRAMES, TIMECODE)
_STEPS_S = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 60.0, 300.0, 600.0)
_STEPS_FRAMES = (1, 2, 5, 10)
_TICK_PX = 72


@dataclass(frozen=True)
class Ruler:
    """How times are written.

    unit : seconds, frames or timecode
    fps : frames a second of the project
    first_frame : number of the frame at the start of the speech, for frames and timecode
    """

    unit: str = SECONDS
    fps: Fraction = Fraction(30)
    first_frame: int = 0

    def step_s(self, px_per_s: float) -> float:
        """Return the seconds between two labelled ticks, as few as have room."""
        wanted = _TICK_PX / px_per_s
        if self.unit == SECONDS:
            steps = _STEPS_S
        else:
            whole = round(self.fps)
            steps = [n / float(self.fps) for n in (*_STEPS_FRAMES, *(whole * s for s in (1, 2, 5, 10, 30, 60, 300)))]
        return next((step for step in steps if step >= wanted), steps[-1])

    def text(self, time_s: float, step_s: float = 0.001) -> str:
        """Write a time; ``step_s`` is how far apart the times lie that must not look the same."""
        if self.unit == SECONDS:
            digits = 0 if step_s >= 1 else 1 if step_s >= 0.1 else 2 if step_s >= 0.01 else 3
            return f"{time_s:.{digits}f} s"
        frame = self.first_frame + int(time_s * self.fps + Fraction(1, 1000))
        return str(frame) if self.unit == FRAMES else timecode(frame, self.fps)


def paint_ruler(painter: QPainter, area: QRectF, scale: TimeScale, end_s: float, ruler: Ruler) -> None:
    """Ticks, as many as have room, each with its time."""
    step_s = ruler.step_s(scale.px_per_s)
    painter.setFont(small_font())
    first = int(max(scale.start_s, 0.0) / step_s)
    last = int(min(end_s, scale.time_s(area.right())) / step_s + 1e-9)
    for i in range(first, last + 1):
        x = scale.x(i * step_s)
        painter.setPen(colour(theme().line))
        painter.drawLine(QLineF(x, area.top() + 4, x, area.bottom()))
        text = ruler.text(i * step_s, step_s)
        if x + 4 + painter.fontMetrics().horizontalAdvance(text) <= area.right():
            painter.setPen(colour(theme().dim))
            painter.drawText(
                QRectF(x + 4, area.top(), 2 * _TICK_PX, area.height()), Qt.AlignmentFlag.AlignVCenter, text
            )
