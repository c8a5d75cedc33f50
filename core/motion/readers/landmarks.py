"""Points tracked in pictures: their names, their axes, their pixels."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.motion_track import PictureSizeUnknown

# iBUG's 68 points, as OpenFace and dlib number them; a higher number is MediaPipe's
_IBUG = 68
_MEDIAPIPE = (468, 478)
_LEAST_NUMBERED = 20
_NUMBERED = re.compile(
    r"(?:(?:face|facial|mp|mediapipe)[ _]?)?(?:landmark|lm|point|kp|keypoint)?[ _]?(\d{1,4})", re.IGNORECASE
)
# fractions of a picture stay within it, but for a face that leaves it
_FRACTION = 2.0
_LARGEST_PX = 1e6


def are_landmarks(names: Sequence[str], has_depth: bool, capital: bool, unit: str | None) -> bool:
    """Tell points of a picture from markers: they lack depth, or are many, numbered, and have no unit.

    capital : heads were ``X_0``, which is OpenFace's way to say millimetres
    """
    if not has_depth:
        return True
    numbered = len(names) >= _LEAST_NUMBERED and all(map(_NUMBERED.fullmatch, names))
    return numbered and not capital and unit is None


def landmark_names(names: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return ``MP033`` for MediaPipe's numbers, ``P33`` for iBUG's 68, other names as they are; and what is to be said.

    468 or 478 points that are counted from 1 are counted from 0, as MediaPipe does.
    """
    matches = [_NUMBERED.fullmatch(name) for name in names]
    if not all(matches):
        return tuple(names), ()
    numbers = [int(match[1]) for match in matches]
    if len(set(numbers)) != len(numbers):
        return tuple(names), ()
    if max(numbers) < _IBUG:
        return tuple(f"P{number:02d}" for number in numbers), ()
    if min(numbers) == 1 and max(numbers) == len(numbers) and len(numbers) in _MEDIAPIPE:
        return tuple(f"MP{n - 1:03d}" for n in numbers), ("Points are counted from 1; MediaPipe's names count from 0.",)
    return tuple(f"MP{number:03d}" for number in numbers), ()


def in_pixels(points: np.ndarray, path: Path, picture_px: tuple[int, int] | None) -> tuple[np.ndarray, tuple[str, ...]]:
    """Return points as pixels with x right in the picture, y up, z towards the camera, and what is to be said.

    points : shape (F, K, 2 or 3); x right, y down, z away from the camera; pixels, or fractions of width (x and z) and
        height (y). They are fractions when no coordinate of a frame is beyond 2.
    returns : float32, shape (F, K, 3). Raises `PictureSizeUnknown` for fractions of a picture of unknown size.
    """
    seen = np.abs(points[..., :2][np.isfinite(points[..., :2])])
    if not len(seen):
        raise UserFacingError(f"'{path}' shows no point in any frame.")
    if seen.max() > _LARGEST_PX:
        raise UserFacingError(f"'{path}' holds points that lie outside of any picture.")
    notes: tuple[str, ...] = ()
    if np.quantile(seen, 0.99) <= _FRACTION:
        if picture_px is None:
            raise PictureSizeUnknown(path)
        width, height = picture_px
        if not (1 <= width <= _LARGEST_PX and 1 <= height <= _LARGEST_PX):
            raise UserFacingError(f"A picture of {width} by {height} pixels has no points in it.")
        points = points * np.array([width, height, width], float)[: points.shape[2]]
        notes = (f"Points are taken as fractions of a picture of {width} by {height} pixels.",)
    turned = np.zeros((*points.shape[:2], 3), np.float32)
    turned[..., : points.shape[2]] = points
    turned[..., 1:] *= -1.0
    turned[np.isnan(turned).any(axis=2)] = np.nan
    return turned, notes
