"""How far a face would come that hears every sound right: animemes, which are told the phones and their times."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.animeme.engine import AnimemeEngine
from core.iface.heard_takes import HeardTake
from core.iface.speech_features import RATE_HZ
from core.motion.database import MotionDatabase
from core.motion.resample import resample
from core.progress import SILENT, Progress
from core.speech.emotion import EmotionModifier
from core.synthesis.engine import SpeechInput


def told_estimates(
    database: MotionDatabase, takes: Sequence[HeardTake], progress: Progress = SILENT
) -> list[np.ndarray]:
    """Let animemes of ``database`` say the transcripts of ``takes``; displacements from its rest pose, mm, 30 Hz."""
    engine = AnimemeEngine(database)
    engine.prepare(progress)
    said = []
    for take in takes:
        spoken = SpeechInput(take.transcript, [EmotionModifier(0.0, take.transcript.duration_s, take.emotion)])
        motion = engine.synthesise(spoken).motion
        said.append(resample(motion.positions, motion.rate_hz, RATE_HZ, len(take)) - database.markers.rest)
    return said
