"""What the page of the head has worked out: which markers are steady, and how steady they are in one sentence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app.panels.importing.captures import CaptureFacts
from core.importing.plan import ImportPlan, SentencePlan
from core.importing.steady_markers import propose_steady, rigid_away_mm
from core.importing.takes import read_take
from core.progress import Progress


def kept_markers(plan: ImportPlan, names: tuple[str, ...]) -> dict[str, str]:
    """Return captured name to database name of the markers of a capture that are kept."""
    return {name: plan.markers.get(name, "") if plan.markers else name for name in names
            if not plan.markers or name in plan.markers}  # fmt: skip


@dataclass(frozen=True)
class SteadyRequest:
    """Sentences in which steady markers are looked for; names are the database's, and so are those of ``midline``."""

    plan: ImportPlan
    facts: tuple[CaptureFacts, ...]


def propose(request: SteadyRequest, progress: Progress) -> tuple[tuple[str, ...], str]:
    """Return (rigid, origin), names in the database; a job."""
    progress.step(0.1, "looking for steady markers")
    first = request.facts[0]
    kept = kept_markers(request.plan, first.names)
    columns = [first.names.index(name) for name in kept]
    takes = [f.sample[:, columns] for f in request.facts if f.names == first.names]
    landmarks = request.plan.landmarks
    midline = [landmarks[a] for a in ("nose_bridge", "nose_tip") if a in landmarks]
    found = propose_steady(list(kept.values()), takes, midline)
    return found.rigid, found.origin


@dataclass(frozen=True)
class ResidualRequest:
    """A sentence, and the near-rigid markers by their names in the database."""

    sentence: SentencePlan
    plan: ImportPlan


@dataclass(frozen=True)
class Residual:
    """How far near-rigid markers are off in one sentence.

    names : of the markers; away_mm : shape (n_frames, n_markers), NaN where missing
    """

    sentence: str
    names: tuple[str, ...]
    away_mm: np.ndarray
    rate_hz: float

    @property
    def rms_mm(self) -> np.ndarray:
        """Root mean square of each marker."""
        return np.sqrt(np.nanmean(self.away_mm**2, axis=0))

    @property
    def whole_mm(self) -> float:
        """Root mean square of all."""
        return float(np.sqrt(np.nanmean(self.away_mm**2)))


def measure(request: ResidualRequest, progress: Progress) -> Residual:
    """Take the head's motion out of one sentence and see what is left; a job."""
    progress.step(0.1, request.sentence.name)
    track = read_take(request.sentence, request.plan.reading)
    kept = kept_markers(request.plan, track.names)
    rows = {ours: track.names.index(name) for name, ours in kept.items()}
    names = tuple(name for name in request.plan.rigid if name in rows)
    if len(names) < 3:
        names = tuple(rows)
    away = rigid_away_mm(track.positions, [rows[name] for name in names])
    return Residual(request.sentence.name, names, away * _mm_per_unit(request.plan, track, rows), track.rate_hz)


def _mm_per_unit(plan: ImportPlan, track, rows: dict[str, int]) -> float:
    """Pixels become millimetres by the distance of the outer eye corners."""
    corners = [rows.get(plan.landmarks.get(name, "")) for name in ("outer_eye_left", "outer_eye_right")]
    if not plan.with_scale or plan.outer_eye_mm is None or None in corners:
        return 1.0
    apart = np.linalg.norm(track.positions[:, corners[0]] - track.positions[:, corners[1]], axis=1)
    return plan.outer_eye_mm / float(np.nanmean(apart))
