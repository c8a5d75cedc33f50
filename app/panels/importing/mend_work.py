"""What mending will do to each sentence, without building anything."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.importing.mending import GAP, LONG_GAP, SPIKE, SWAP, Mended, MendRow, mend
from core.importing.plan import ImportPlan, SentencePlan
from core.importing.sentence_work import model_of, picked
from core.importing.takes import read_take
from core.progress import Progress


@dataclass(frozen=True)
class MendRequest:
    """A plan, and those of its sentences that are to be looked at."""

    plan: ImportPlan
    sentences: tuple[SentencePlan, ...]


@dataclass(frozen=True)
class MendFacts:
    """What is done to one sentence; rows as in `core.importing.mending.Mended`."""

    rate_hz: float
    rows: tuple[MendRow, ...]

    def count(self, kind: str) -> int:
        """Return how often ``kind`` is done."""
        return sum(row.kind == kind for row in self.rows)

    @property
    def samples(self) -> int:
        """Marker samples concerned."""
        return sum(row.stop - row.start for row in self.rows)

    @property
    def badness(self) -> tuple[int, int]:
        """Worse is larger: open gaps first, then samples changed."""
        return sum(r.stop - r.start for r in self.rows if r.kind == LONG_GAP), self.samples

    @property
    def counts(self) -> tuple[int, int, int, int, int]:
        """Swaps, spikes, gaps filled, gaps too long, samples."""
        return (*(self.count(kind) for kind in (SWAP, SPIKE, GAP, LONG_GAP)), self.samples)


def look(request: MendRequest, progress: Progress) -> Mapping[str, MendFacts]:
    """Mend each sentence and keep what was done; a job. What cannot be read has no entry."""
    found = {}
    for i, sentence in enumerate(request.sentences):
        progress.step(i / len(request.sentences), sentence.name)
        try:
            rate_hz, _, _, mended = _mended(request.plan, sentence)
        except UserFacingError:
            continue
        found[sentence.name] = MendFacts(rate_hz, mended.rows)
    return found


@dataclass(frozen=True)
class MendPicture:
    """One sentence before and after.

    names : of the markers in the database; before, after : shape (n_frames, n_markers, 3), mm, NaN where missing
    """

    sentence: str
    names: tuple[str, ...]
    rate_hz: float
    before: np.ndarray
    after: np.ndarray

    def most_changed(self, event: MendRow) -> int:
        """Return the axis along which an event was mended most; y where nothing was there before."""
        span, k = slice(event.start, event.stop), self.names.index(event.marker)
        moved = np.abs(self.after[span, k] - self.before[span, k])
        return int(np.nanmax(moved, axis=0).argmax()) if np.isfinite(moved).all() else 1


def picture(request: tuple[ImportPlan, SentencePlan], progress: Progress) -> MendPicture:
    """Mend one sentence and keep all of it; a job."""
    plan, sentence = request
    progress.step(0.1, sentence.name)
    rate_hz, names, before, mended = _mended(plan, sentence)
    return MendPicture(sentence.name, names, rate_hz, before, mended.positions)


def _mended(plan: ImportPlan, sentence: SentencePlan) -> tuple[float, tuple[str, ...], np.ndarray, Mended]:
    """As `core.importing.sentence_work.work_on` mends, without placing the speech."""
    track = read_take(sentence, plan.reading)
    names, positions = picked(track, plan.markers, sentence)
    rigid = [names.index(name) for name in plan.rigid if name in names]
    model = model_of(plan.like, names, track)
    return track.rate_hz, names, positions, mend(positions, names, track.rate_hz, plan.mending, rigid, model)
