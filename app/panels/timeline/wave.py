"""The sound: its waveform, and its spectrogram behind it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QLineF, QRectF
from PySide6.QtGui import QImage, QPainter, QPen

from app.panels.timeline.lanes import TimeScale
from app.theme import colour, theme
from core.media.audio import Audio
from core.speech.spectrogram import Spectrogram


@dataclass(frozen=True)
class Peaks:
    """Lowest and highest sample of each block, at which a waveform is drawn whatever its length.

    low, high : float32, shape (n_blocks,); block_s : seconds a block
    """

    low: np.ndarray
    high: np.ndarray
    block_s: float

    @classmethod
    def of(cls, audio: Audio, block_s: float = 0.002) -> Peaks:
        """Measure a sound."""
        block = max(1, round(audio.rate_hz * block_s))
        edges = np.arange(0, len(audio.samples), block)
        return cls(np.minimum.reduceat(audio.samples, edges), np.maximum.reduceat(audio.samples, edges),
                   block / audio.rate_hz)  # fmt: skip

    def columns(self, times_s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return lowest and highest sample between neighbouring ``times_s`` (ascending), one fewer than times."""
        at = np.clip((times_s / self.block_s).astype(int), 0, len(self.low) - 1)
        # reduceat gives the single block where two columns share one
        low = np.minimum.reduceat(self.low[: at[-1] + 1], at)[:-1]
        return low, np.maximum.reduceat(self.high[: at[-1] + 1], at)[:-1]


def paint_wave(
    painter: QPainter, area: QRectF, scale: TimeScale, peaks: Peaks, end_s: float, faint: bool = False
) -> None:
    """Lowest and highest sample of each pixel column, on the scale of the loudest; faint over a spectrogram."""
    loudest = max(float(np.abs(peaks.low).max()), float(np.abs(peaks.high).max()), 1e-6)
    middle, half = area.center().y(), area.height() / 2 - 2
    left, right = int(max(area.left(), scale.x(0.0))), int(min(area.right(), scale.x(end_s)))
    if right <= left:
        return
    places = np.arange(left, right + 1)
    low, high = peaks.columns(scale.start_s + (places - scale.left_px) / scale.px_per_s)
    tops, bottoms = middle - half * high / loudest - 0.5, middle - half * low / loudest + 0.5
    lines = [QLineF(x + 0.5, top, x + 0.5, bottom) for x, top, bottom in zip(places, tops, bottoms)]
    painter.setPen(QPen(colour(theme().accent, 0.35) if faint else colour(theme().dim, 0.9), 1))
    painter.drawLines(lines)


def paint_spectrogram(
    painter: QPainter, area: QRectF, scale: TimeScale, spectrogram: Spectrogram, end_s: float
) -> None:
    """As dark as the canvas where it is quiet; low frequencies at the bottom."""
    left, right = max(area.left(), scale.x(0.0)), min(area.right(), scale.x(end_s))
    n_columns = spectrogram.levels.shape[1]
    # one picture column a pixel at most, whatever the length of the sound
    places = np.arange(int(left), int(np.ceil(right)))
    if len(places) == 0:
        return
    times_s = scale.start_s + (places + 0.5 - scale.left_px) / scale.px_per_s
    columns = np.clip((times_s / spectrogram.column_s).astype(int), 0, n_columns - 1)
    shades = np.ascontiguousarray(_ramp()[spectrogram.levels[::-1, columns]])
    height, width = shades.shape
    picture = QImage(shades.data, width, height, 4 * width, QImage.Format.Format_RGB32)
    painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
    painter.drawImage(QRectF(places[0], area.top() + 1, width, area.height() - 2), picture)


def _ramp() -> np.ndarray:
    """From the canvas to the text colour; uint32 RGB, shape (256,)."""
    ends = [np.array(colour(css).getRgb()[:3], float) for css in (theme().canvas, theme().text)]
    share = (np.arange(256) / 255.0)[:, None] ** 1.5
    red, green, blue = np.round(ends[0] + share * (ends[1] - ends[0])).astype(np.uint32).T
    return (0xFF << 24) | (red << 16) | (green << 8) | blue
