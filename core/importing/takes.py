"""The motion of one planned sentence, whatever kind of file it lies in, turned to left, up, forward."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from core.errors import UserFacingError
from core.importing.plan import MendLimits, Reading, SentencePlan, axes_matrix
from core.motion.motion_files import read_takes
from core.motion.motion_track import MotionTrack, ReadOptions
from core.motion.readers.blendshape_files import is_blendshape_file


def read_take(sentence: SentencePlan, reading: Reading) -> MotionTrack:
    """Read the motion of ``sentence``; blendshape weights become the markers of the default face.

    Raises `UserFacingError` for a file or a take that is not there or cannot be used.
    """
    if is_blendshape_file(sentence.motion):
        track = _weights_as_markers(sentence.motion, reading)
    else:
        takes = _takes(sentence.motion, ReadOptions(reading.rate_hz, reading.unit, reading.picture_px))
        track = takes.get(sentence.take) or (next(iter(takes.values())) if len(takes) == 1 else None)
        if track is None:
            raise UserFacingError(f"'{sentence.motion}' has no take '{sentence.take}'.")
    turn = axes_matrix(reading.axes)
    if (turn != np.eye(3)).any():
        track = replace(track, positions=np.asarray(track.positions @ turn.T, np.float32))
    return track


def limits_for(sentence: SentencePlan, limits: MendLimits) -> MendLimits:
    """Return ``limits`` as they apply to a sentence: markers that weights made cannot have a capture's faults.

    Weights move all markers of a region at once, so what looks like a spike is the animator's own.
    """
    return replace(limits, faults=False) if is_blendshape_file(sentence.motion) else limits


@lru_cache(maxsize=2)
def _takes(path: str, options: ReadOptions) -> dict[str, MotionTrack]:
    return {track.take: track for track in read_takes(path, options)}


def _weights_as_markers(path: str, reading: Reading) -> MotionTrack:
    from core.face.blendshape_drive import markers_of_blendshapes
    from core.face.marker_units import load_marker_units
    from core.motion.shape_mapping import read_units

    track = read_units(path, reading.shape_names, reading.shape_sheet, reading.rate_hz)
    return markers_of_blendshapes(track, load_marker_units())
