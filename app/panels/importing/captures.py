"""What the assistant knows of each capture without keeping it in memory: its facts, and a few frames for pictures."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.importing.plan import SentencePlan
from core.media.audio import Audio, load_audio
from core.motion.motion_files import read_takes
from core.motion.motion_track import MotionTrack
from core.motion.readers.tracked_points import is_tracked_points_folder, read_tracked_points
from core.progress import Progress

_MOST_SAMPLES = 48
_KEPT_FILES = 3


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


class CaptureReader:
    """Reads takes, and keeps the last few files, as sentences of one file come one after the other."""

    def __init__(self) -> None:
        self._kept: OrderedDict[str, dict[str, MotionTrack]] = OrderedDict()

    def track(self, sentence: SentencePlan) -> MotionTrack:
        """Return the take of a sentence; raises `UserFacingError`."""
        takes = self._takes(sentence.motion)
        if sentence.take in takes:
            return takes[sentence.take]
        if not sentence.take and len(takes) == 1:
            return next(iter(takes.values()))
        raise UserFacingError(f"'{sentence.motion}' has no take '{sentence.take}'.")

    def _takes(self, path: str) -> dict[str, MotionTrack]:
        if path in self._kept:
            self._kept.move_to_end(path)
            return self._kept[path]
        folder = Path(path).parent
        if Path(path).name == "tracks.npz" and is_tracked_points_folder(folder):
            takes = {r.sentence: MotionTrack(r.positions, r.marker_names, r.rate_hz, true_scale=False)
                     for r in read_tracked_points(folder).recordings}  # fmt: skip
        else:
            takes = {track.take: track for track in read_takes(path)}
        self._kept[path] = takes
        while len(self._kept) > _KEPT_FILES:
            self._kept.popitem(last=False)
        return takes

    @staticmethod
    def facts_of(sentences: Iterable[SentencePlan], progress: Progress) -> dict[str, CaptureFacts]:
        """Read all captures once; a job. One that cannot be read has its problem among its facts."""
        sentences, reader, facts = tuple(sentences), CaptureReader(), {}
        for i, sentence in enumerate(sentences):
            progress.step(i / len(sentences), sentence.name)
            try:
                facts[sentence.name] = CaptureFacts.of(reader.track(sentence))
            except UserFacingError as error:
                facts[sentence.name] = CaptureFacts(problem=str(error))
        return facts


@dataclass(frozen=True)
class Capture:
    """One sentence, read whole: its motion and its sound, if it has any."""

    sentence: SentencePlan
    track: MotionTrack
    audio: Audio | None

    @classmethod
    def read(cls, sentence: SentencePlan, progress: Progress) -> Capture:
        """Read it; a job."""
        track = CaptureReader().track(sentence)
        progress.step(0.5, sentence.name)
        return cls(sentence, track, load_audio(Path(sentence.audio)) if sentence.audio else None)
