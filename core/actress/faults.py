"""Capture faults planted in the demo corpus, and the list of them, by which detectors are measured.

An optical system fails in four ways: two markers exchange their names (swap), a reflection is taken for a marker for
a moment (spike), a marker works loose or its reconstruction creeps (drift), or a lost marker is filled with its last
position (freeze). The list is made from the transcripts alone and is never stored in a database.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.actress.randomness import Chance
from core.motion.marker_set import MarkerSet
from core.speech.phoneme import PAU
from core.speech.transcript import Transcript

KINDS = ("swap", "spike", "drift", "freeze")
FAULTY_SHARE = 0.02
# A node of fewer frames (at 120 Hz) has no room for a fault that could be told from noise.
SHORTEST_S = 0.05
# Markers swap with one of so many nearest ones.
NEIGHBOURS = 3
SPIKE_MM = (8.0, 30.0)
SPIKE_FRAMES = (1, 3)
DRIFT_MM = (5.0, 14.0)
FREEZE_MARKERS = (3, 7)
# Where there is motion enough that a frozen marker is wrong.
FREEZE_GROUP = "lips"


@dataclass(frozen=True)
class PlantedFault:
    """One motion node that was contaminated on purpose.

    node : its public name, ``sentence:order``
    kind : one of `KINDS`
    markers : names of the markers concerned
    start_s, end_s : of the phone; the fault lies within
    """

    node: str
    kind: str
    markers: tuple[str, ...]
    start_s: float
    end_s: float

    @property
    def sentence(self) -> str:
        """The name of the sentence."""
        return self.node.rpartition(":")[0]


def plant(transcripts: Mapping[str, Transcript], markers: MarkerSet) -> tuple[PlantedFault, ...]:
    """Choose `FAULTY_SHARE` of all nodes, the four kinds in turn, and the markers that fail.

    Near-rigid markers, which all others are stabilised by, are spared: their failure would contaminate the face.

    transcripts : sentence name to its transcript
    markers : kept markers
    """
    nodes = [
        (f"{sentence}:{order}", u)
        for sentence, transcript in transcripts.items()
        for order, u in enumerate(u for u in transcript.phonemes if u.phone != PAU)
    ]
    roomy = [(node, u) for node, u in nodes if u.end_s - u.start_s >= SHORTEST_S]
    chance = Chance("planted faults")
    faults = []
    for i in range(round(FAULTY_SHARE * len(nodes))):
        node, u = roomy.pop(chance.below(len(roomy)))
        kind = KINDS[i % len(KINDS)]
        faults.append(PlantedFault(node, kind, _markers_for(kind, markers, chance), u.start_s, u.end_s))
    places = {node: place for place, (node, _) in enumerate(nodes)}
    return tuple(sorted(faults, key=lambda fault: places[fault.node]))


def contaminate(
    positions: np.ndarray, names: Sequence[str], rate_hz: float, faults: Sequence[PlantedFault]
) -> np.ndarray:
    """Return captured ``positions``, shape (n_frames, n_markers, 3), mm, with the faults of that sentence in them."""
    spoilt = positions.copy()
    for fault in faults:
        chance = Chance(f"fault {fault.node}")
        rows = [names.index(name) for name in fault.markers]
        first, stop = round(fault.start_s * rate_hz), min(round(fault.end_s * rate_hz), len(positions))
        span = slice(first, stop)
        if fault.kind == "swap":
            spoilt[span, rows] = positions[span, rows[::-1]]
        elif fault.kind == "freeze":
            spoilt[span, rows] = positions[first, rows]
        elif fault.kind == "drift":
            # away and, as the system finds the marker again, back at once
            away = np.linspace(0, 1, stop - first)[:, None, None] ** 1.5
            spoilt[span, rows] += away * _displacement(DRIFT_MM, chance)
        else:
            length = SPIKE_FRAMES[0] + chance.below(SPIKE_FRAMES[1] - SPIKE_FRAMES[0] + 1)
            at = first + chance.below(max(1, stop - first - length + 1))
            spoilt[at : at + length, rows] += _displacement(SPIKE_MM, chance)
    return spoilt


def _markers_for(kind: str, markers: MarkerSet, chance: Chance) -> tuple[str, ...]:
    rigid = {*markers.group("rigid"), *markers.group("origin")}
    free = [row for row in range(len(markers)) if row not in rigid]
    if kind == "freeze":
        lips = list(markers.group(FREEZE_GROUP))
        count = FREEZE_MARKERS[0] + chance.below(FREEZE_MARKERS[1] - FREEZE_MARKERS[0] + 1)
        seed = lips[chance.below(len(lips))]
        rows = sorted(lips, key=lambda row: np.linalg.norm(markers.rest[row] - markers.rest[seed]))[:count]
    elif kind == "swap":
        one = free[chance.below(len(free))]
        near = sorted((row for row in free if row != one), key=lambda row: _distance_mm(markers, one, row))
        rows = [one, near[chance.below(NEIGHBOURS)]]
    else:
        rows = [free[chance.below(len(free))]]
    return tuple(markers.names[row] for row in rows)


def _distance_mm(markers: MarkerSet, one: int, other: int) -> float:
    return float(np.linalg.norm(markers.rest[one] - markers.rest[other]))


def _displacement(size_mm: tuple[float, float], chance: Chance) -> np.ndarray:
    direction = chance.normal(3)
    return chance.between(*size_mm) * direction / np.linalg.norm(direction)
