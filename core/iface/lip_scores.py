"""Lips of a speaking face beside raw captures, by the measures of every other engine."""

from __future__ import annotations

from collections.abc import Sequence

from core.evaluation.comparison import CapturedTruth, Comparison, Scores, scores
from core.iface.comparison import estimates
from core.iface.heard_takes import recorded_takes
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ
from core.motion.database import MotionDatabase
from core.motion.recording import Recording
from core.synthesis.marker_motion import MarkerMotion


def captured_scores(face: SpeakingFace, database: MotionDatabase, recordings: Sequence[Recording]) -> Scores:
    """Measure ``face`` on raw ``recordings`` that ``database`` does not hold, as `efase evaluate` measures engines."""
    pairs = []
    takes = recorded_takes(database, recordings)
    for recording, moved in zip(recordings, estimates(face, takes)):
        truth = CapturedTruth.of(recording, database)
        motion = MarkerMotion(database.markers.rest + moved, float(RATE_HZ), database.markers)
        pairs.append((truth, Comparison.of(truth, motion, 0.0).synthesised))
    return scores(pairs)
