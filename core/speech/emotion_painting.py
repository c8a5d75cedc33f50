"""Painting emotion modifiers over time, as with a brush."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from core.speech.emotion import EmotionModifier

# Boundaries this close are one.
_SAME_S = 1e-6


def painted(
    modifiers: Iterable[EmotionModifier], start_s: float, end_s: float, emotion: str, intensity: float
) -> tuple[EmotionModifier, ...]:
    """Return ``modifiers`` with ``emotion`` at ``intensity`` (0..1) from ``start_s`` to ``end_s``.

    Within the span it replaces what was painted of the same emotion; other emotions stay, and mix with it. Neutral,
    or an intensity of 0, is no paint: see `erased`. Spans of one emotion and intensity that touch become one.
    """
    modifiers = tuple(modifiers)
    if end_s - start_s <= _SAME_S:
        return modifiers
    if emotion == "neutral":
        return erased(modifiers, start_s, end_s)
    kept = [m for m in modifiers if m.emotion != emotion]
    same = _cut((m for m in modifiers if m.emotion == emotion), start_s, end_s)
    if intensity > 0.0:
        same.append(EmotionModifier(start_s, end_s, emotion, min(intensity, 1.0)))
    return _in_order([*kept, *_joined(same)])


def erased(modifiers: Iterable[EmotionModifier], start_s: float, end_s: float) -> tuple[EmotionModifier, ...]:
    """Return ``modifiers`` without any emotion from ``start_s`` to ``end_s``."""
    return _in_order(_cut(modifiers, start_s, end_s))


def _cut(modifiers: Iterable[EmotionModifier], start_s: float, end_s: float) -> list[EmotionModifier]:
    pieces = []
    for modifier in modifiers:
        if modifier.end_s <= start_s or modifier.start_s >= end_s:
            pieces.append(modifier)
            continue
        if start_s - modifier.start_s > _SAME_S:
            pieces.append(replace(modifier, end_s=start_s))
        if modifier.end_s - end_s > _SAME_S:
            pieces.append(replace(modifier, start_s=end_s))
    return pieces


def _joined(modifiers: Iterable[EmotionModifier]) -> list[EmotionModifier]:
    joined: list[EmotionModifier] = []
    for modifier in sorted(modifiers, key=lambda m: m.start_s):
        last = joined[-1] if joined else None
        touches = last is not None and modifier.start_s - last.end_s <= _SAME_S
        if touches and last.intensity == modifier.intensity:
            joined[-1] = replace(last, end_s=max(last.end_s, modifier.end_s))
        else:
            joined.append(modifier)
    return joined


def _in_order(modifiers: Iterable[EmotionModifier]) -> tuple[EmotionModifier, ...]:
    return tuple(sorted(modifiers, key=lambda m: (m.start_s, m.end_s, m.emotion)))
