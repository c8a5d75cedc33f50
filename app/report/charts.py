"""Plots as SVG text: lines over time, points on a plane, bars. Enough for a report, and nothing to install."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np

ACCENT, INK, PALE, GRID = "#0f6c7a", "#3b4450", "#8a94a1", "#e6e9ed"
_DASHES = {"solid": "", "dashed": ' stroke-dasharray="6 4"', "dotted": ' stroke-dasharray="2 4"'}
_MARGIN = (58, 14, 42, 44)  # left, right, top, bottom
# Where the name of a spot may stand, best first: offset in pixels, and which end of the name is there.
_LABEL_PLACES = [(9, -4 + 14 * n, "start") for n in (0, -1, 1)] + [(-9, -4 + 14 * n, "end") for n in (0, -1, 1, 2, -2)]
_FONT = 'font-family="system-ui, sans-serif" font-size="12"'


@dataclass(frozen=True, eq=False)
class Line:
    """One line of a plot; ``x`` and ``y`` have the same length. style : solid, dashed or dotted."""

    name: str
    x: np.ndarray
    y: np.ndarray
    colour: str = ACCENT
    style: str = "solid"


@dataclass(frozen=True)
class Spot:
    """One named point of a plot; a hollow one is a standard rather than a result."""

    name: str
    x: float
    y: float
    colour: str = ACCENT
    hollow: bool = False


class _Plane:
    """A rectangle with axes; collects the SVG of what is drawn on it."""

    def __init__(self, size: tuple[int, int], x_span: tuple[float, float], y_span: tuple[float, float],
                 labels: tuple[str, str]) -> None:  # fmt: skip
        self.size = size
        left, right, top, bottom = _MARGIN
        self.x_px, self.y_px = (left, size[0] - right), (size[1] - bottom, top)
        self.x_span, self.y_span = x_span, y_span
        self.parts: list[str] = []
        for value in ticks(*y_span):
            y = self.y(value)
            self.parts.append(f'<path d="M{left} {y:.1f}H{self.x_px[1]}" stroke="{GRID}"/>')
            self.text(left - 8, y + 4, _number(value), "end")
        for value in ticks(*x_span):
            self.text(self.x(value), self.y_px[0] + 18, _number(value), "middle")
        self.parts.append(f'<path d="M{left} {self.y_px[0]}H{self.x_px[1]}" stroke="{PALE}"/>')
        self.text(sum(self.x_px) / 2, size[1] - 8, labels[0], "middle", INK)
        middle = sum(self.y_px) / 2
        self.parts.append(
            f'<text x="14" y="{middle:.1f}" text-anchor="middle" fill="{INK}" '
            f'transform="rotate(-90 14 {middle:.1f})">{escape(labels[1])}</text>'
        )

    def x(self, value: float) -> float:
        return float(np.interp(value, self.x_span, self.x_px))

    def y(self, value: float) -> float:
        low, high = self.y_span
        return self.y_px[0] + (value - low) / (high - low) * (self.y_px[1] - self.y_px[0])

    def text(self, x: float, y: float, words: str, anchor: str = "start", colour: str = PALE, extra: str = "") -> None:
        self.parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}"{extra}>{escape(words)}</text>'
        )

    def svg(self, title: str) -> str:
        width, height = self.size
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'role="img" aria-label="{escape(title)}" {_FONT}><title>{escape(title)}</title>'
            f'<rect width="{width}" height="{height}" fill="#ffffff"/>{"".join(self.parts)}</svg>'
        )


def line_chart(
    title: str,
    lines: Sequence[Line],
    labels: tuple[str, str],
    marks: Sequence[tuple[float, float, str]] = (),
    size: tuple[int, int] = (860, 280),
) -> str:
    """Draw lines with a legend; a line without a name is left out of that.

    labels : of the x and the y axis, with their units
    marks : spans of x with a name each, written above where there is room (phones)
    """
    xs, ys = (np.concatenate([getattr(line, axis) for line in lines]) for axis in "xy")
    plane = _Plane(size, (float(xs.min()), float(xs.max())), rounded_span(ys.min(), ys.max()), labels)
    bottom, top = plane.y_px
    for start, stop, name in marks:
        left, right = plane.x(start), plane.x(stop)
        plane.parts.append(f'<path d="M{left:.1f} {bottom}V{top}" stroke="{GRID}"/>')
        if right - left >= 7 * len(name):
            plane.text((left + right) / 2, top - 5, name, "middle", PALE, ' font-size="10"')
    for line in lines:
        points = " ".join(f"{plane.x(x):.1f},{plane.y(y):.1f}" for x, y in zip(line.x, line.y))
        plane.parts.append(
            f'<polyline points="{points}" fill="none" stroke="{line.colour}" stroke-width="1.8" '
            f'stroke-linejoin="round"{_DASHES[line.style]}/>'
        )
    at = plane.x_px[0]
    for line in (line for line in lines if line.name):
        plane.parts.append(f'<path d="M{at} 14h26" stroke="{line.colour}" stroke-width="1.8"{_DASHES[line.style]}/>')
        plane.text(at + 32, 18, line.name, "start", INK)
        at += 56 + 7 * len(line.name)
    return plane.svg(title)


def spot_chart(
    title: str,
    spots: Sequence[Spot],
    labels: tuple[str, str],
    band: tuple[float, float, str],
    size: tuple[int, int] = (860, 380),
) -> str:
    """Draw named points; ``band`` is a span of y to aim for, with its name."""
    right = max(s.x for s in spots) * 1.15 + 1e-9
    high = max(band[1] * 1.1, max(s.y for s in spots) * 1.08)
    plane = _Plane(size, (0.0, right), rounded_span(0.0, high), labels)
    upper, lower = plane.y(band[1]), plane.y(band[0])
    left, width = plane.x_px[0], plane.x_px[1] - plane.x_px[0]
    plane.parts.append(
        f'<rect x="{left}" y="{upper:.1f}" width="{width}" height="{lower - upper:.1f}" fill="{ACCENT}" '
        f'fill-opacity="0.09"/>'
    )
    plane.text(plane.x_px[0] + 8, upper + 14, band[2], "start", ACCENT)
    taken = [(plane.x(s.x) - 6, plane.x(s.x) + 6, plane.y(s.y) - 6, plane.y(s.y) + 6) for s in spots]
    for spot in sorted(spots, key=lambda s: s.x):
        x, y = plane.x(spot.x), plane.y(spot.y)
        fill = "#ffffff" if spot.hollow else spot.colour
        plane.parts.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5.5" fill="{fill}" stroke="{spot.colour}" stroke-width="2"/>'
        )
        width = 6.6 * len(spot.name)
        for dx, dy, anchor in _LABEL_PLACES:
            left = x + dx if anchor == "start" else x + dx - width
            box = (left, left + width, y + dy - 10, y + dy + 3)
            if not any(box[0] < b[1] and b[0] < box[1] and box[2] < b[3] and b[2] < box[3] for b in taken):
                break
        taken.append(box)
        plane.text(x + dx, y + dy, spot.name, anchor, INK)
    return plane.svg(title)


def ticks(low: float, high: float, most: int = 7) -> list[float]:
    """Round numbers from ``low`` to ``high``, about ``most`` at most: steps of 1, 2 or 5 times a power of ten."""
    if not high > low:
        return [low]
    rough = (high - low) / most
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(size * power for size in (1, 2, 5, 10) if size * power >= rough * (1 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [round(step * i, 12) for i in range(first, math.floor(high / step + 1e-9) + 1)]


def rounded_span(low: float, high: float) -> tuple[float, float]:
    """Widen ``low``..``high`` to ticks, and to something at all when it is a point."""
    low, high = float(low), float(high)
    if not high > low:
        low, high = low - 1.0, high + 1.0
    inner = ticks(low, high)
    step = inner[1] - inner[0] if len(inner) > 1 else high - low
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step


def _number(value: float) -> str:
    return f"{value:g}".replace("-", "\N{MINUS SIGN}")
