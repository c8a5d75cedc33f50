"""How an expression comes and goes: strengths follow what is asked for smoothly, the same live and in a project."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from core.iface.speech_features import RATE_HZ
from core.speech.emotion import EmotionModifier

# Nine tenths of a change are done after 0.35 s, about the onset of a posed smile.
_TIME_CONSTANT_S = 0.09
_STEP = 1.0 - math.exp(-1.0 / (RATE_HZ * _TIME_CONSTANT_S))


class ExpressionEase:
    """Follows the strengths that are asked for, frame by frame at 30 Hz.

    Two equal first-order lags, one behind the other: a change sets out without a jump in speed, never overshoots, and
    strengths that are asked for within 0..1, of a sum of at most 1, stay so on the way.
    """

    def __init__(self, expressions: Sequence[str], asked: Mapping[str, float] | None = None) -> None:
        """Begin at rest where ``asked`` is: expression to strength, 0 for one that is left out."""
        self.expressions = tuple(expressions)
        self._goal = self._row(asked or {})
        self._first, self._second = self._goal.copy(), self._goal.copy()

    def ask(self, strengths: Mapping[str, float]) -> None:
        """Go to other strengths from the next frame on; an expression that the face does not have is left out."""
        self._goal = self._row(strengths)

    def step(self) -> dict[str, float]:
        """Return the strengths of the next frame."""
        self._first += _STEP * (self._goal - self._first)
        self._second += _STEP * (self._first - self._second)
        return dict(zip(self.expressions, self._second.tolist()))

    def _row(self, strengths: Mapping[str, float]) -> np.ndarray:
        row = np.clip([float(strengths.get(name, 0.0)) for name in self.expressions], 0.0, 1.0)
        return row / max(1.0, row.sum())


def eased_strengths(
    expressions: Sequence[str], modifiers: Iterable[EmotionModifier], n_frames: int
) -> dict[str, np.ndarray]:
    """Return the strengths that emotion spans ask for at 30 Hz, eased; float64, shape (n_frames,), an expression.

    A span holds from the frame at or after its start to the last one before its end; where spans overlap beyond 1 they
    are scaled to sum to 1. What was asked for by keys, live, and kept as spans gives the strengths that were shown.
    """
    spans, times_s = tuple(modifiers), np.arange(n_frames) / RATE_HZ + 1e-6
    asked = np.zeros((n_frames, len(expressions)))
    for span in spans:
        if span.emotion in expressions:
            held = (times_s >= span.start_s) & (times_s < span.end_s)
            asked[held, list(expressions).index(span.emotion)] += span.intensity
    rows = [dict(zip(expressions, row)) for row in asked.tolist()]
    ease = ExpressionEase(expressions, rows[0] if rows else None)
    strengths = np.zeros((n_frames, len(expressions)))
    for f, row in enumerate(rows):
        ease.ask(row)
        strengths[f] = list(ease.step().values())
    return dict(zip(expressions, strengths.T))


def spans_of(asked: Sequence[tuple[str, float]]) -> tuple[EmotionModifier, ...]:
    """Return the emotion spans that ask, frame by frame at 30 Hz, for one emotion at an intensity; none for neutral.

    asked : (emotion, intensity) of each frame
    """
    spans: list[EmotionModifier] = []
    first = 0
    for f in range(1, len(asked) + 1):
        if f == len(asked) or asked[f] != asked[first]:
            emotion, intensity = asked[first]
            if emotion != "neutral" and intensity > 0.0:
                spans.append(EmotionModifier(first / RATE_HZ, f / RATE_HZ, emotion, intensity))
            first = f
    return tuple(spans)
