"""Points tracked in pictures, kept as arrays in an .npz archive, one take or many in a row."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.frame_rate import check_rate_hz
from core.motion.motion_track import MotionTrack, RateUnknown, ReadOptions
from core.motion.readers.landmarks import in_pixels, landmark_names
from core.motion.readers.npy import read_npz

# names that archives use, the first that is there counts; xyz64 holds pixels x 64, as the GRID set keeps them
_POINTS = ("xyz64", "points", "landmarks", "xyz", "xy", "positions")
_NAMES = ("landmark_index", "names", "marker_names", "point_names")
_RATES = ("fps", "rate_hz", "frame_rate")
_WANTED = (*_POINTS, *_NAMES, *_RATES, "start", "clips", "width", "height")
_PER_PIXEL = 64.0


def read_landmark_arrays(path: Path, options: ReadOptions) -> tuple[MotionTrack, ...]:
    """Read the takes of an archive: points (F, K, 2 or 3), x right, y down, z away from the camera.

    Beside the points (``xyz64``, ``points``, ``landmarks``, ``xyz``, ``xy`` or ``positions``) it may have
    ``landmark_index`` (numbers) or ``names``, ``fps``, ``width`` and ``height`` of the picture, and ``clips`` (names of
    takes) with ``start`` (first frame of each, and the end). Raises `UserFacingError` for what is damaged or does not
    fit together, `RateUnknown` and `PictureSizeUnknown`.
    """
    arrays = read_npz(path, _WANTED)
    key = next((key for key in _POINTS if key in arrays), None)
    if key is None:
        raise UserFacingError(f"'{path}' has no array of points.", f"Name it {', '.join(_POINTS[1:])}.")
    raw = arrays[key]
    if raw.ndim != 3 or raw.shape[2] not in (2, 3) or raw.dtype.kind not in "iuf" or 0 in raw.shape:
        raise UserFacingError(f"'{key}' in '{path}' is no array of frames, points and 2 or 3 axes.")
    points = raw.astype(float) / (_PER_PIXEL if key == "xyz64" else 1.0)
    if np.isinf(points).any():
        raise UserFacingError(f"'{key}' in '{path}' holds infinite coordinates.")
    names, notes = _names(path, arrays, points.shape[1])
    size = [_number(arrays.get(side)) for side in ("width", "height")]
    picture_px = options.picture_px or ((int(size[0]), int(size[1])) if all(size) else None)
    pixels, more = in_pixels(points, path, picture_px)
    stated_hz = next((_number(arrays[rate]) for rate in _RATES if rate in arrays), None)
    rate_hz = options.rate_hz or stated_hz
    if not rate_hz:
        raise RateUnknown(path)
    rate_hz = check_rate_hz(rate_hz, path)
    return tuple(
        MotionTrack(pixels[start:stop], names, rate_hz, False, points.shape[2] == 3, take, (*notes, *more))
        for take, start, stop in _takes(path, arrays, len(points))
    )


def _names(path: Path, arrays: dict[str, np.ndarray], n_points: int) -> tuple[tuple[str, ...], tuple[str, ...]]:
    given = next((arrays[key] for key in _NAMES if key in arrays), np.arange(n_points))
    if given.shape != (n_points,) or given.dtype.kind not in "iuU":
        raise UserFacingError(f"The names in '{path}' are not one for each of its {n_points} points.")
    texts = [str(name).strip() for name in given.tolist()]
    if len(set(texts)) != n_points or not all(texts):
        raise UserFacingError(f"The names in '{path}' repeat, or some are empty.")
    if given.dtype.kind != "U" and "landmark_index" in arrays:
        return tuple(f"MP{int(number):03d}" for number in texts), ()
    return landmark_names(texts)


def _takes(path: Path, arrays: dict[str, np.ndarray], n_frames: int) -> list[tuple[str, int, int]]:
    if "clips" not in arrays and "start" not in arrays:
        return [("", 0, n_frames)]
    clips, start = arrays.get("clips"), arrays.get("start")
    if clips is None or start is None or clips.dtype.kind != "U" or start.dtype.kind not in "iu":
        raise UserFacingError(f"'{path}' does not name its takes, or not where they start.")
    bounds = start.astype(np.int64).ravel()
    if clips.ndim != 1 or len(bounds) != len(clips) + 1 or not len(clips):
        raise UserFacingError(f"The names of takes in '{path}' do not fit their starts.")
    if bounds[0] != 0 or bounds[-1] != n_frames or (np.diff(bounds) <= 0).any():
        raise UserFacingError(f"The starts of takes in '{path}' do not fit its {n_frames} frames.")
    return [(str(clip), int(a), int(b)) for clip, a, b in zip(clips, bounds, bounds[1:])]


def _number(array: np.ndarray | None) -> float | None:
    """A single finite number above 0, or None."""
    if array is None or array.size != 1 or array.dtype.kind not in "iuf":
        return None
    value = float(array.reshape(()))
    return value if 0 < value < 1e6 else None
