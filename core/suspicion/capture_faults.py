"""How optical capture fails, read from jumps: a spike, a swap, a drift, a freeze.

What leaves and comes back within a moment is a spike; what stands off for longer and comes back is a swap of two
markers (or a marker held elsewhere); what snaps back without having left suddenly had drifted away, or stood still
while the face moved on. So a jump that is undone accuses the frames between, and a jump alone those before it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from core.suspicion.jumps import Jumps

LONGEST_SPIKE_S = 0.034
LONGEST_SWAP_S = 0.3
# A jump and its undoing point in opposite directions at least this well (cosine).
_OPPOSED = 0.5
# Before a drift snaps back, the face has moved by this share of the snap the other way.
_DRIFTED = -0.4


class Fault(Enum):
    """What speaks against a motion node."""

    SPIKE = "spike"
    SWAP = "swap"
    DRIFT = "drift"
    FREEZE = "freeze"
    FAR = "far"
    NEVER_WINS = "never wins"


@dataclass(frozen=True)
class FaultScores:
    """Scores of one fault for all spans.

    score : float64, shape (n_spans,), robust standard deviations above the usual; -inf where nothing was found
    frame : int64, shape (n_spans,), where it shows; -1 where nothing was found
    step : float64, shape (n_spans, n_dims), the jump in the track's units; 0 where nothing was found
    """

    score: np.ndarray
    frame: np.ndarray
    step: np.ndarray

    @classmethod
    def none(cls, n_spans: int, n_dims: int) -> FaultScores:
        """Return scores that accuse nobody."""
        return cls(np.full(n_spans, -np.inf), np.full(n_spans, -1), np.zeros((n_spans, n_dims)))

    def raise_to(self, span: int, score: float, frame: int, step: np.ndarray) -> None:
        """Take a score if it is the span's highest so far."""
        if score > self.score[span]:
            self.score[span], self.frame[span], self.step[span] = score, frame, step


@dataclass(frozen=True)
class Excursion:
    """What left and came back.

    start, stop : the frames that stand off; fault : spike or swap, by their number
    strength : whitened size of the jump and its undoing; step : the jump in the track's units, shape (n_dims,)
    """

    start: int
    stop: int
    fault: Fault
    strength: float
    step: np.ndarray


def capture_faults(
    track: np.ndarray,
    rate_hz: float,
    bounds: Sequence[tuple[int, int]],
    starts: np.ndarray,
    stops: np.ndarray,
    jumps: Jumps | None = None,
) -> dict[Fault, FaultScores]:
    """Return the scores of the four faults of a capture for spans of a track.

    track : shape (n_frames, n_dims), one marker's positions or the face's coefficients
    bounds : pieces captured without a break, as in `core.suspicion.jumps.Jumps.find`
    starts, stops : int, shape (n_spans,), frames of the spans, which do not overlap
    """
    jumps = Jumps.find(track, bounds) if jumps is None else jumps
    n_dims = track.shape[1]
    scores = {f: FaultScores.none(len(starts), n_dims) for f in (Fault.SPIKE, Fault.SWAP, Fault.DRIFT, Fault.FREEZE)}
    span_of = np.full(len(track) + 1, -1)
    for i, (start, stop) in enumerate(zip(starts, stops, strict=True)):
        span_of[start:stop] = i
    found, alone = excursions(jumps, rate_hz)
    for excursion in found:
        left, back = excursion.start, excursion.stop
        for span in np.unique(span_of[left:back]):
            if span >= 0:
                inside = min(back, int(stops[span])) - max(left, int(starts[span]))
                score = float(jumps.deviations(excursion.strength * inside / (back - left)))
                scores[excursion.fault].raise_to(span, score, max(left, int(starts[span])), excursion.step)
    for i in alone:
        at = int(jumps.at[i])
        span = span_of[at - 1]
        if span >= 0:
            gone = np.asarray(track[at - 1], float) - track[starts[span]]
            drifted = gone @ jumps.step[i] < _DRIFTED * (jumps.step[i] @ jumps.step[i])
            fault = Fault.DRIFT if drifted else Fault.FREEZE
            scores[fault].raise_to(span, float(jumps.deviations(jumps.size[i])), at, jumps.step[i])
    return scores


def excursions(jumps: Jumps, rate_hz: float) -> tuple[list[Excursion], np.ndarray]:
    """Pair each jump with the one that undoes it, the strongest pair first.

    returns : the excursions, and the rows of the jumps that none undoes
    """
    found: list[Excursion] = []
    paired = np.zeros(len(jumps.at), bool)
    for strength, i, j in undone_pairs(jumps, round(LONGEST_SWAP_S * rate_hz)):
        if paired[i] or paired[j]:
            continue
        paired[[i, j]] = True
        left, back = int(jumps.at[i]), int(jumps.at[j])
        fault = Fault.SPIKE if back - left <= round(LONGEST_SPIKE_S * rate_hz) else Fault.SWAP
        found.append(Excursion(left, back, fault, strength, jumps.step[i]))
    return found, np.flatnonzero(~paired)


def undone_pairs(jumps: Jumps, longest_frames: int) -> list[tuple[float, int, int]]:
    """Return jumps that may undo each other as (strength, first, second), strongest first."""
    size = jumps.size
    pairs = []
    for i in range(len(size)):
        for j in range(i + 1, len(size)):
            if jumps.at[j] - jumps.at[i] > longest_frames:
                break
            against = -float(jumps.whitened[i] @ jumps.whitened[j])
            cosine = against / max(size[i] * size[j], 1e-12)
            if cosine > _OPPOSED:
                pairs.append((float(np.sqrt(against) * cosine), i, j))
    return sorted(pairs, reverse=True)
