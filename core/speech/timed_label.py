"""What a transcript file says: names over time, before they become our phones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from core.errors import UserFacingError

# Times rounded to milliseconds may touch wrongly by one.
ROUNDING_S = 1.5e-3


@dataclass(frozen=True)
class TimedLabel:
    """A name from ``start_s`` to ``end_s``; ``place`` says where it stands ("'a.lab', line 3")."""

    name: str
    start_s: float
    end_s: float
    place: str


def check_order(labels: Sequence[TimedLabel]) -> None:
    """Raise `UserFacingError` where a label ends before it starts, or starts before the one above it ends."""
    for label, above in zip(labels, [None, *labels]):
        if label.end_s < label.start_s:
            raise UserFacingError(f"{label.place} ends at {label.end_s:g} s, before it starts at {label.start_s:g} s.")
        if above is not None and label.start_s < above.end_s - ROUNDING_S:
            raise UserFacingError(
                f"{label.place} starts at {label.start_s:g} s, before the one above it ends at {above.end_s:g} s."
            )
