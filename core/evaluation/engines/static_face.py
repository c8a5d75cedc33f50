"""A face that does not move: the least that motion has to be better than."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion


@dataclass(frozen=True)
class PlainAnswer:
    """Motion, and nothing to say about it."""

    motion: MarkerMotion
    warnings: tuple[str, ...] = ()


class StaticFace:
    """The mean face of the database, held still."""

    name = "static"

    def __init__(self, database: MotionDatabase) -> None:
        self._database = database

    def prepare(self, progress: Progress = SILENT) -> None:
        """Nothing is to be done before the first sentence."""

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> PlainAnswer:
        """Hold the mean face for as long as ``speech`` lasts."""
        database = self._database
        n_frames = max(1, round(speech.transcript.duration_s * database.rate_hz))
        face = database.pca.mean.reshape(1, -1, 3).astype(np.float32)
        return PlainAnswer(MarkerMotion(np.repeat(face, n_frames, axis=0), database.rate_hz, database.markers))
