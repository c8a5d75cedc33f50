"""How well a map keeps neighbours: what is near on it against what is near among the captured frames.

Venna and Kaski 2001 (trustworthiness, continuity); Lee and Verleysen 2009 (shared neighbours).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.manifold.isomap import PhonemeMap
from core.progress import SILENT, Progress

N_NEIGHBORS = 12  # as many as the Isomap joins a frame to
MOST_ROWS = 8_000  # each is compared with all frames: more would take minutes on the largest maps
_ROWS_AT_ONCE = 256


@dataclass(frozen=True)
class NeighbourPreservation:
    """Figures from 0 to 1 of one map, 1 being perfect.

    trustworthiness : falls when the map puts strangers side by side
    continuity : falls when the map tears neighbours apart
    shared : share of a frame's nearest frames that are among its nearest on the map
    """

    trustworthiness: float
    continuity: float
    shared: float

    @classmethod
    def of(
        cls,
        frames: np.ndarray,
        embedding: np.ndarray,
        n_neighbors: int = N_NEIGHBORS,
        progress: Progress = SILENT,
        most_rows: int = MOST_ROWS,
    ) -> NeighbourPreservation:
        """Compare ``frames``, shape (n, n_dims), with their places ``embedding``, shape (n, 2).

        Fewer neighbours are asked for in a map of under ``2 n_neighbors`` frames; one of under three is perfect. Of
        more than ``most_rows`` frames as many, evenly spread, are asked for their neighbours among all.
        """
        n = len(frames)
        k = min(n_neighbors, (n - 1) // 2)
        if k < 1:
            return cls(1.0, 1.0, 1.0)
        frames, embedding = np.asarray(frames, float), np.asarray(embedding, float)
        intruders = extruders = common = 0.0
        asked = np.arange(n) if n <= most_rows else np.linspace(0, n - 1, most_rows).astype(int)
        for first in range(0, len(asked), _ROWS_AT_ONCE):
            progress.step(first / len(asked), "comparing neighbours")
            rows = asked[first : first + _ROWS_AT_ONCE]
            true_rank, map_rank = _ranks(frames, rows), _ranks(embedding, rows)
            near_truly, near_on_map = true_rank <= k, map_rank <= k
            intruders += (true_rank[near_on_map] - k).clip(0).sum()
            extruders += (map_rank[near_truly] - k).clip(0).sum()
            common += (near_truly & near_on_map).sum()
        worst = len(asked) * k * (2 * n - 3 * k - 1) / 2
        return cls(float(1 - intruders / worst), float(1 - extruders / worst), float(common / (len(asked) * k)))


def map_preservation(
    phoneme_map: PhonemeMap, frames: np.ndarray, progress: Progress = SILENT
) -> tuple[NeighbourPreservation, NeighbourPreservation]:
    """Return the figures of the Isomap and of the PCA map; ``frames`` are those of the database."""
    captured = frames[phoneme_map.frames]
    isomap = NeighbourPreservation.of(captured, phoneme_map.embedding, progress=progress.part(0.0, 0.5))
    linear = NeighbourPreservation.of(captured, phoneme_map.pca, progress=progress.part(0.5, 1.0))
    return isomap, linear


def _ranks(points: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Return for each of ``rows`` the rank of every point by distance, 1 the nearest; the point itself comes last."""
    squares = (points**2).sum(axis=1)
    distance = squares[rows, None] + squares[None] - 2 * points[rows] @ points.T
    distance[np.arange(len(rows)), rows] = np.inf
    order = np.argsort(distance, axis=1, kind="stable")
    ranks = np.empty(order.shape, np.int32)
    np.put_along_axis(ranks, order, np.arange(1, len(points) + 1, dtype=np.int32)[None], axis=1)
    return ranks
