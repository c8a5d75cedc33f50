"""Emotion specifications as text: ``start end emotion [intensity]``, one span a line."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.speech.emotion import EmotionModifier, emotion_named
from core.speech.text_file import read_text, seconds


def read_emotions(path: str | Path) -> list[EmotionModifier]:
    """Read spans in seconds, intensity 0..1 (1 when left out); ``#`` begins a comment.

    Raises `UserFacingError` naming the line that is wrong, or when no line holds a span.
    """
    modifiers = []
    for number, line in enumerate(read_text(path, "emotion specification").split("\n"), start=1):
        columns = line.partition("#")[0].split()
        if columns:
            modifiers.append(_modifier(columns, f"'{path}', line {number}"))
    if not modifiers:
        raise UserFacingError(f"The emotion specification '{path}' holds no emotion.", _SHAPE)
    return modifiers


_SHAPE = "Each line is 'start end emotion [intensity]'."


def _modifier(columns: list[str], place: str) -> EmotionModifier:
    if len(columns) not in (3, 4):
        raise UserFacingError(f"{place}: {len(columns)} columns are found.", _SHAPE)
    start_s, end_s = seconds(columns[0], place), seconds(columns[1], place)
    if end_s <= start_s:
        raise UserFacingError(f"{place}: the span ends at {end_s:g} s, but starts at {start_s:g} s.")
    try:
        emotion = emotion_named(columns[2])
    except UserFacingError as error:
        raise UserFacingError(f"{place}: {error.message}", error.remedy) from error
    intensity = _intensity(columns[3], place) if len(columns) == 4 else 1.0
    return EmotionModifier(start_s, end_s, emotion, intensity)


def _intensity(text: str, place: str) -> float:
    try:
        intensity = float(text)
    except ValueError:
        intensity = math.nan
    if not 0.0 <= intensity <= 1.0:
        raise UserFacingError(f"{place}: the intensity '{text[:20]}' is not between 0 and 1.")
    return intensity


def write_emotions(modifiers: Iterable[EmotionModifier], path: str | Path) -> None:
    """Write what `read_emotions` reads; raises `UserFacingError` when it cannot be written."""
    lines = [f"{float(m.start_s)!r} {float(m.end_s)!r} {m.emotion} {float(m.intensity)!r}" for m in modifiers]
    with swapped_in(path) as beside:
        beside.write_text("\n".join(["# start end emotion intensity", *lines]) + "\n", encoding="utf-8")
