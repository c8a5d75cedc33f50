"""What the assistant knows of each capture without keeping it in memory: its facts, and a few frames for pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.importing.plan import Reading, SentencePlan
from core.importing.takes import read_take
from core.motion.motion_track import MotionTrack
from core.progress import Progress

_MOST_SAMPLES = 48


@dataclass(frozen=True)
class CaptureFacts:
    """One capture at a glance.

    n_frames, rate_hz, names : of the motion; n_missing : marker samples that are not there
    sample : float32, shape (at most 48, n_markers, 3), frames spread over the take
    problem : why it cannot be read, or ""
    notes : sentences of the reader
    """

    n_frames: int = 0
    rate_hz: float = 0.0
    names: tuple[str, ...] = ()
    n_missing: int = 0
    sample: np.ndarray | None = None
    problem: str = ""
    notes: tuple[str, ...] = ()

    @classmethod
    def of(cls, track: MotionTrack) -> CaptureFacts:
        """Look at a take."""
        n = len(track.positions)
        rows = np.unique(np.linspace(0, max(n - 1, 0), min(n, _MOST_SAMPLES)).astype(int)) if n else []
        missing = ~np.isfinite(track.positions).all(axis=2)
        return cls(n, track.rate_hz, track.names, int(missing.sum()), track.positions[rows], "", track.notes)


def read_facts(request: tuple[tuple[SentencePlan, ...], Reading], progress: Progress) -> dict[str, CaptureFacts]:
    """Read all captures once; a job. One that cannot be read has its problem among its facts."""
    sentences, reading = request
    facts = {}
    for i, sentence in enumerate(sentences):
        progress.step(i / len(sentences), sentence.name)
        try:
            facts[sentence.name] = CaptureFacts.of(read_take(sentence, reading))
        except UserFacingError as error:
            facts[sentence.name] = CaptureFacts(problem=str(error))
    return facts
