"""The suspicion list: all detectors together, worst node first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.search.terms import TransitionTerms
from core.suspicion.capture_faults import Fault, FaultScores, capture_faults
from core.suspicion.jumps import LEAST_JUMP, Jumps
from core.suspicion.rarity import cluster_distance, losing_margin, robust_deviations

# Rare motion is worth a look, but only what no fault of the capture explains better: it never outranks a jump.
RARE_AT_MOST = LEAST_JUMP


@dataclass(frozen=True)
class Suspicion:
    """What speaks against one motion node.

    row : of the node
    fault : the strongest reason
    score : robust standard deviations above what is usual in the corpus; from 3 on it is worth watching
    frame : database frame where it shows, or -1 where no single one does
    marker : name of the marker that jumps farthest, or "" where none does; size_mm : how far
    """

    row: int
    fault: Fault
    score: float
    frame: int = -1
    marker: str = ""
    size_mm: float = 0.0


@dataclass(frozen=True)
class SuspicionList:
    """Suspicions of all motion nodes of a database, found without knowing any of them to be contaminated.

    score : float64, shape (n_nodes,), by row
    by_fault : each detector's own score, by row
    ranked : one a node, worst first
    """

    score: np.ndarray
    by_fault: dict[Fault, np.ndarray]
    ranked: tuple[Suspicion, ...]

    @property
    def worth_watching(self) -> tuple[Suspicion, ...]:
        """Those that a detector speaks against clearly."""
        return tuple(s for s in self.ranked if s.score >= LEAST_JUMP)

    @classmethod
    def of(cls, database: MotionDatabase, progress: Progress = SILENT) -> SuspicionList:
        """Run all detectors over ``database``."""
        nodes = database.nodes
        frames = np.asarray(database.frames, float)
        bounds = [(s.start_frame, s.stop_frame) for s in database.sentences]
        progress.step(0.0, "looking for jumps")
        jumps = Jumps.find(frames, bounds)
        faults = capture_faults(frames, database.rate_hz, bounds, nodes.start, nodes.stop, jumps)
        distance = cluster_distance(frames, nodes, progress.part(0.1, 0.6))
        terms = TransitionTerms(database.frames, nodes, database.rate_hz)
        margin = losing_margin(terms, database.weights, progress.part(0.6, 1.0))
        by_fault = {fault: scores.score for fault, scores in faults.items()}
        by_fault[Fault.FAR] = _within_phoneme(distance, nodes.phoneme).clip(max=RARE_AT_MOST)
        by_fault[Fault.NEVER_WINS] = robust_deviations(margin).clip(max=RARE_AT_MOST)
        kinds = list(by_fault)
        table = np.array([by_fault[fault] for fault in kinds])
        strongest = table.argmax(axis=0)
        unrest = np.array([jumps.left[a : b + 1].max() for a, b in zip(nodes.start, nodes.stop)])
        # nodes that nothing speaks against keep an order too: by how unquiet they are
        score = np.maximum(table.max(axis=0), jumps.deviations(unrest))
        order = np.argsort(-score, kind="stable")
        ranked = tuple(_suspicion(database, int(n), kinds[strongest[n]], float(score[n]), faults) for n in order)
        return cls(score, by_fault, ranked)


def _within_phoneme(distance: np.ndarray, phoneme: np.ndarray) -> np.ndarray:
    deviations = np.full(len(distance), -np.inf)
    for p in np.unique(phoneme):
        rows = phoneme == p
        deviations[rows] = robust_deviations(distance[rows])
    return deviations


def _suspicion(
    database: MotionDatabase, row: int, fault: Fault, score: float, faults: dict[Fault, FaultScores]
) -> Suspicion:
    scores = faults.get(fault)
    if scores is None or scores.frame[row] < 0:
        return Suspicion(row, fault, score)
    moved = database.pca.positions(scores.step[row]) - database.pca.positions(np.zeros_like(scores.step[row]))
    far_mm = np.linalg.norm(moved, axis=1)
    marker = int(far_mm.argmax())
    return Suspicion(row, fault, score, int(scores.frame[row]), database.markers.names[marker], float(far_mm[marker]))
