"""A captured sentence made ready for the database: head motion out, at the database's rate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from core.motion.head_space import in_head_space
from core.motion.marker_set import MarkerSet
from core.motion.recording import Recording
from core.motion.resample import resample


@dataclass(frozen=True)
class PreparedSentence:
    """A sentence in head space at the database's rate; n is its number of frames then.

    recording : as captured
    face : float32, shape (n, n_markers, 3), mm
    turn : float32, shape (n, 3), rotation vectors of the head, radians; move : the same, mm
    masked : bool, shape (n,), frames that must not be used
    n_filled : marker samples that were filled in short gaps
    """

    recording: Recording
    face: np.ndarray
    turn: np.ndarray
    move: np.ndarray
    masked: np.ndarray
    n_filled: int


def prepare(
    recording: Recording, markers: MarkerSet, with_scale: bool, rate_hz: float, longest_gap_s: float
) -> PreparedSentence:
    """Bring a recording into the head space of ``markers`` and to ``rate_hz``.

    The face is rounded to float32 here, before anything is computed from it, so that a database that keeps its
    captures can be fitted anew to the very numbers it was built from.
    """
    captured = in_head_space(recording, markers, with_scale, longest_gap_s)
    face, head, masked = captured.face, captured.head, captured.masked
    n_frames = max(1, round(recording.transcript.duration_s * rate_hz))
    turn = Rotation.from_matrix(head.rotation).as_rotvec()
    tracks = np.concatenate([face.reshape(len(face), -1), turn, head.translation], axis=1)
    raised = resample(tracks, recording.rate_hz, rate_hz, n_frames).astype(np.float32)
    nearest = np.minimum(np.arange(n_frames) * recording.rate_hz / rate_hz, len(masked) - 1)
    masked_now = masked[np.floor(nearest).astype(int)] | masked[np.ceil(nearest).astype(int)]
    # sound may run on after the capture has ended: those frames would be made up
    masked_now |= np.arange(n_frames) / rate_hz > (len(masked) + 1) / recording.rate_hz
    whole = np.ascontiguousarray(raised[:, :-6]).reshape(n_frames, len(markers), 3)
    return PreparedSentence(recording, whole, np.ascontiguousarray(raised[:, -6:-3]),
                            np.ascontiguousarray(raised[:, -3:]), masked_now, captured.n_filled)  # fmt: skip
