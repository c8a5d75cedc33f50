"""A recording brought into the head space of a marker set, at the rate it was captured at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.motion.marker_set import MarkerSet
from core.motion.normalise import HeadMotion, normalise
from core.motion.recording import Recording
from core.motion.resample import fill_gaps

LONGEST_GAP_S = 0.1


@dataclass(frozen=True)
class HeadSpaceMotion:
    """What the face did in one recording, and what was done to see it.

    face : float64, shape (n_frames, n_markers, 3), mm, head space
    head : the head motion that was taken out
    masked : bool, shape (n_frames,), frames inside gaps that are too long to fill
    n_filled : marker samples filled in short gaps
    """

    face: np.ndarray
    head: HeadMotion
    masked: np.ndarray
    n_filled: int


def in_head_space(
    recording: Recording, markers: MarkerSet, with_scale: bool, longest_gap_s: float = LONGEST_GAP_S
) -> HeadSpaceMotion:
    """Fill short gaps and take head motion out, as every database is built.

    The rotation is estimated on the group ``rigid`` (all markers when it has fewer than three), and the group
    ``origin`` is put at 0. Raises `UserFacingError` when the recording lacks a marker of the set.
    """
    column = {name: k for k, name in enumerate(recording.marker_names)}
    missing = [name for name in markers.names if name not in column]
    if missing:
        raise UserFacingError(f"Sentence '{recording.sentence}' has no marker '{missing[0]}', which the database has.")
    positions = np.asarray(recording.positions, float)[:, [column[name] for name in markers.names]]
    whole, n_filled, masked = fill_gaps(positions, round(longest_gap_s * recording.rate_hz))
    rigid, origin = markers.group("rigid"), markers.group("origin")
    face, head = normalise(
        whole, markers.rest, rigid if len(rigid) >= 3 else None, int(origin[0]) if len(origin) else None, with_scale
    )
    return HeadSpaceMotion(face, head, masked, n_filled)
