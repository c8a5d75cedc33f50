"""Which whole phonemes or words a stroke covers."""

from __future__ import annotations

from collections.abc import Sequence

FREE, PHONEMES, WORDS = "free", "phonemes", "words"


def snapped(from_s: float, to_s: float, units: Sequence[tuple[float, float]], duration_s: float) -> tuple[float, float]:
    """Return (start_s, end_s) of a stroke, in order and within the speech, grown to whole ``units``.

    units : (start_s, end_s) of phonemes or words, in order, none to paint freely; where a stroke touches none of
        them, between words for instance, it stays as it is
    """
    start_s, end_s = max(min(from_s, to_s), 0.0), min(max(from_s, to_s), duration_s)
    touched = [unit for unit in units if (unit[0] < end_s and unit[1] > start_s) or unit[0] <= start_s < unit[1]]
    if touched:
        start_s, end_s = min(start_s, touched[0][0]), max(end_s, touched[-1][1])
    return start_s, end_s
