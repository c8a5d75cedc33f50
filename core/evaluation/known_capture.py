"""How the actor herself said a sentence, as a synthesis of it is measured against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.evaluation.comparison import CapturedTruth
from core.motion.capture import find_captured, own_motion
from core.motion.database import MotionDatabase
from core.motion.recording import Recording


@dataclass(frozen=True, eq=False)
class KnownCapture:
    """The capture of a sentence.

    is_held_out : the database did not learn from it; an engine that knows a sentence can repeat its capture
    """

    truth: CapturedTruth
    is_held_out: bool


def known_capture(database: MotionDatabase, text: str, duration_s: float) -> KnownCapture | None:
    """Return the capture of the sentence that `core.motion.capture.find_captured` finds, or None.

    One that was held out is as `efase evaluate` takes it; one of the database's own is as the database holds it.
    """
    found = find_captured(database, text, duration_s)
    if found is None:
        return None
    if isinstance(found, Recording):
        return KnownCapture(CapturedTruth.of(found, database), True)
    motion = own_motion(database, found)
    recording = Recording(found.name, found.emotion, motion.positions, motion.markers.names, motion.rate_hz,
                          found.transcript, found.text)  # fmt: skip
    every = np.ones(len(motion.positions), bool)
    return KnownCapture(CapturedTruth(recording, database.markers, motion.positions.astype(float), every, None), False)
