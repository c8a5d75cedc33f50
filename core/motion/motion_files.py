"""Marker motion on disk, in whichever of the kinds we know."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.c3d import read_c3d, write_c3d
from core.motion.frame_rate import check_rate_hz
from core.motion.marker_csv import write_markers_csv
from core.motion.motion_track import MotionTrack, ReadOptions
from core.motion.readers.blendshape_files import is_blendshape_table
from core.motion.readers.delimited import read_delimited
from core.motion.readers.landmark_arrays import read_landmark_arrays
from core.motion.readers.marker_text import read_marker_text
from core.motion.trc import read_trc, write_trc

__all__ = ["SUFFIXES", "read_motion", "read_takes", "write_c3d", "write_markers_csv", "write_trc"]

SUFFIXES = (".c3d", ".trc", ".csv", ".tsv", ".npz")


def read_takes(path: str | Path, options: ReadOptions | None = None) -> tuple[MotionTrack, ...]:
    """Read all takes of a motion file; most kinds hold one.

    Raises `UserFacingError` for a file that is missing, empty, damaged or of another kind, and its kinds
    `RateUnknown`, `UnitUnknown` and `PictureSizeUnknown` where ``options`` can help.
    """
    path, options = Path(path), options or ReadOptions()
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise UserFacingError(
            f"'{path}' is no kind of motion file that can be read.", "Use .c3d, .trc, .csv, .tsv or .npz."
        )
    if not path.is_file():
        raise UserFacingError(f"There is no motion file '{path}'.")
    if suffix == ".c3d":
        positions, names, rate_hz = read_c3d(path, options.unit)
        rate_hz = rate_hz if options.rate_hz is None else check_rate_hz(options.rate_hz, path)
        return (MotionTrack(positions, names, rate_hz),)
    if suffix == ".trc":
        return (read_trc(path, options),)
    if suffix == ".npz":
        return read_landmark_arrays(path, options)
    text = read_delimited(path)
    if is_blendshape_table(text):
        raise UserFacingError(f"'{path}' holds weights of blendshapes, not markers.", "Import it as blendshapes.")
    return (read_marker_text(text, options),)


def read_motion(path: str | Path, options: ReadOptions | None = None) -> tuple[np.ndarray, tuple[str, ...], float]:
    """Read one take of marker motion.

    Returns positions (float32, shape (F, K, 3), mm, NaN where a marker is missing), the K marker names, and frames
    a second. Raises `UserFacingError` for a file that is missing, empty, damaged, of another kind, or that holds
    several takes or pixels (see `read_takes`).
    """
    tracks = read_takes(path, options)
    if len(tracks) > 1:
        raise UserFacingError(f"'{path}' holds {len(tracks)} takes, and one is wanted here.")
    track = tracks[0]
    if not track.true_scale:
        raise UserFacingError(f"'{path}' holds points of a picture, not millimetres.", "Import it into a database.")
    return track.positions, track.names, track.rate_hz
