"""Motion as a file holds it, and what a file may leave for its user to say."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError


class RateUnknown(UserFacingError):
    """The file does not say how many frames a second it has; `ReadOptions.rate_hz` answers."""

    def __init__(self, path: object) -> None:
        super().__init__(f"'{path}' does not say how many frames a second it has.", "Give its rate in Hz.")


class UnitUnknown(UserFacingError):
    """The file does not say its unit of length, and its size tells none; `ReadOptions.unit` answers."""

    def __init__(self, path: object, span: float) -> None:
        super().__init__(
            f"'{path}' does not say its unit of length, and markers that span {span:.3g} are no face in mm, cm or m.",
            "Give the unit.",
        )


class PictureSizeUnknown(UserFacingError):
    """The file's points are fractions of a picture of unknown size; `ReadOptions.picture_px` answers."""

    def __init__(self, path: object) -> None:
        super().__init__(
            f"'{path}' holds points as fractions of a picture whose size it does not say.",
            "Give the picture's width and height in pixels.",
        )


@dataclass(frozen=True)
class ReadOptions:
    """What a user says of a file; what is said here wins over the file.

    rate_hz : frames a second; unit : a key of `core.motion.length_units.MM_PER_UNIT` ("mm", "cm", "m", "in");
    picture_px : width and height of the picture that landmarks were tracked in
    """

    rate_hz: float | None = None
    unit: str | None = None
    picture_px: tuple[int, int] | None = None


@dataclass(frozen=True)
class MotionTrack:
    """One take of markers or of points tracked in pictures.

    positions : float32, shape (F, K, 3), NaN where missing. Millimetres, axes as captured. Without ``true_scale``
        they are pixels, turned so that x is to the actor's left (right in the picture), y up, z towards the camera:
        such takes are built with one scale a frame (`core.motion.corpus.Corpus.with_scale`)
    names : K unique names
    rate_hz : frames a second; frame f stands at f / rate_hz
    true_scale : the file measures lengths, not pixels
    has_depth : false for points of a picture with x and y only; their z is 0
    take : its name within a file that holds several, else ""
    notes : one sentence for whatever the reader took for granted or left out
    """

    positions: np.ndarray
    names: tuple[str, ...]
    rate_hz: float
    true_scale: bool = True
    has_depth: bool = True
    take: str = ""
    notes: tuple[str, ...] = ()
