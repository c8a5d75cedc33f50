"""Faces that a database keeps beside their coefficients: the whole capture, in head space, at the database's rate.

They lie in the groups ``captures`` (float32) and ``captures_masked`` (uint8) of the file, a dataset a sentence.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.motion.database_checks import Unsound, check_captured, stored

GROUP, MASKED = "captures", "captures_masked"


@dataclass(frozen=True)
class KeptCapture:
    """One sentence.

    face : float32, shape (n_frames, n_markers, 3), mm, head space
    masked : bool, shape (n_frames,), frames that must not be used
    """

    face: np.ndarray
    masked: np.ndarray


def write_capture(file, sentence: str, capture: KeptCapture) -> None:
    """Write the capture of ``sentence`` into an open HDF5 file."""
    file.create_dataset(f"{GROUP}/{sentence}", data=capture.face)
    file.create_dataset(f"{MASKED}/{sentence}", data=capture.masked.astype(np.uint8))


def read_capture(file, sentence: str, n_frames: int, n_markers: int) -> KeptCapture | None:
    """Read the capture of ``sentence``, or None when it was not kept; raises `Unsound` when it is no capture."""
    if f"{GROUP}/{sentence}" not in file:
        return None
    face, masked = stored(file, f"{GROUP}/{sentence}", np.float32), stored(file, f"{MASKED}/{sentence}", np.uint8)
    check_captured(face, n_markers)
    if len(face) != n_frames or masked.shape != (n_frames,) or not np.isfinite(face).all():
        raise Unsound("a kept capture does not fit its sentence")
    return KeptCapture(face, masked.astype(bool))
