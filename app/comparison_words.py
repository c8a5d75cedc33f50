"""How a comparison is told, in the window and on the command line."""

from __future__ import annotations

from app.texts import compare as texts
from core.evaluation.known_capture import KnownCapture
from core.evaluation.side_by_side import CAPTURED
from core.synthesis.registry import engine_kind

_DIGITS = 2


def title_of(name: str) -> str:
    """Return what an engine, or the capture, is called."""
    return texts.CAPTURED if name == CAPTURED else engine_kind(name).title


def in_figures(value: float | None, unit: str) -> str:
    """Write a figure with its unit; one that is not known is a dash."""
    if value is None:
        return texts.UNKNOWN
    return f"{unit}{value:.{_DIGITS}f}" if unit == "×" else f"{value:.{_DIGITS}f} {unit}".strip()


def how_fair(capture: KnownCapture | None) -> str:
    """Say whether errors are measured on a sentence that the engines have learnt from."""
    if capture is None:
        return texts.NOT_CAPTURED
    return texts.HELD_OUT if capture.is_held_out else texts.LEARNT
