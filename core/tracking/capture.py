"""A track as a capture in millimetres, with depth where the units know it, beside the video's sound."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.audio import SHORTEST_S, write_wav
from core.media.swap_in import check_target
from core.motion.motion_files import write_c3d, write_markers_csv, write_trc
from core.tracking.track import Track
from core.tracking.video_pictures import sound_of

SUFFIXES = (".c3d", ".trc", ".csv")
# From picture to capture: y points up, and the axes are right-handed.
_UP = np.array([1.0, -1.0])


@dataclass(frozen=True)
class Capture:
    """Points in space.

    positions : float64, shape (F, K, 3), mm, x right in the picture (the actor's left), y up, z towards the camera; NaN
        in frames in which the face was lost
    rate_hz : frames a second, evenly spaced
    """

    positions: np.ndarray
    names: tuple[str, ...]
    rate_hz: float


def capture_of(track: Track) -> Capture:
    """Bring the points of a track to millimetres, at the size of the database's face.

    x and y are the points themselves over the scale of their frame. z is what the 3D units say of the face in each
    frame, turned as the head is: the affine and the two units of the turning head make an affine camera, whose nearest
    scaled rotation is taken. Frames of a video of uneven rate are interpolated to its mean rate.
    """
    positions = np.full((*track.points.shape[:2], 3), np.nan)
    model, seen = track.request.model, np.flatnonzero(~track.lost)
    middle = np.array([track.format.width, track.format.height]) / 2
    n_units = len(model.units)
    z_mean = model.rest[:, 2].mean()
    for f in seen:
        state = track.states[f]
        parameters, linear = state.fit.parameters, state.fit.affine[:, :2] / track.shrink
        parallax = parameters[n_units:] if model.has_depth else np.zeros(2)
        scale, turn = _scaled_turn(np.column_stack([linear, linear @ parallax]))
        shape = np.column_stack([state.base, model.rest[:, 2] - z_mean]) + np.tensordot(
            parameters[:n_units], model.units, axes=1
        )
        positions[f, :, :2] = (track.points[f] - middle) / scale * _UP
        positions[f, :, 2] = (shape * [1.0, -1.0, 1.0]) @ turn[2] if model.has_depth else 0.0
    times_s = track.times_s - track.times_s[0]
    return Capture(evenly_spaced(positions, times_s, track.format.rate_hz), model.names, track.format.rate_hz)


def _scaled_turn(camera: np.ndarray) -> tuple[float, np.ndarray]:
    """The scale and the rotation (3, 3), y up, nearest to an affine camera (2, 3) of picture axes."""
    upright = camera * _UP[:, None] * [1.0, -1.0, 1.0]
    u, sizes, vt = np.linalg.svd(upright, full_matrices=False)
    rows = u @ vt
    return float(sizes.mean()), np.vstack([rows, np.cross(rows[0], rows[1])])


def evenly_spaced(positions: np.ndarray, times_s: np.ndarray, rate_hz: float) -> np.ndarray:
    """Return frames at k / rate_hz, linearly between those at ``times_s``, shape (F,); as they are, if they are even.

    A gap in the times is interpolated over too; where a neighbour is NaN the frame is NaN.
    """
    even = np.arange(len(times_s)) / rate_hz
    if np.abs(times_s - even).max() <= 0.5 / rate_hz:
        return positions
    wanted = np.arange(int(times_s[-1] * rate_hz + 1e-6) + 1) / rate_hz
    after = np.clip(np.searchsorted(times_s, wanted), 1, len(times_s) - 1)
    span = np.maximum(times_s[after] - times_s[after - 1], 1e-9)
    share = np.clip((wanted - times_s[after - 1]) / span, 0.0, 1.0)[:, None, None]
    return (1.0 - share) * positions[after - 1] + share * positions[after]


def check_capture_path(path: Path) -> None:
    """Raise `UserFacingError`, before any work goes into it, for a capture that could not be written."""
    if path.suffix.lower() not in SUFFIXES:
        raise UserFacingError(f"'{path}' is no kind of capture that is written.", "End its name in .c3d, .trc or .csv.")
    check_target(path)


def write_capture(track: Track, path: Path) -> list[Path]:
    """Write a track where the importer takes it up, and the video's sound beside it; returns what was written.

    The sound gets the capture's name and ``.wav``, by which the importer finds it; a file of that name that is there
    already is left alone. Raises `UserFacingError` when nothing was seen, or the file cannot be written.
    """
    path = Path(path)
    check_capture_path(path)
    if track.lost[1:].all() and len(track.lost) > 1:
        raise UserFacingError(f"The face was seen in no picture of '{track.request.video}' but the first.")
    capture = capture_of(track)
    write = {".c3d": write_c3d, ".trc": write_trc, ".csv": write_markers_csv}[path.suffix.lower()]
    write(path, capture.positions.astype(np.float32), capture.names, capture.rate_hz)
    written, beside = [path], path.with_suffix(".wav")
    sound = None if beside.exists() else sound_of(track.request.video)
    if sound is not None and sound.duration_s >= SHORTEST_S:
        write_wav(sound, beside)
        written.append(beside)
    return written
