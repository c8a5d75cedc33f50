"""Motion that is unlike its kind: far from its cluster, or never the best choice anywhere. Rare need not be wrong."""

from __future__ import annotations

import numpy as np

from core.motion.node import NIL, NodeTable
from core.progress import SILENT, Progress
from core.search.terms import TransitionTerms
from core.search.weights import SearchWeights

N_NEIGHBORS = 5
_ASKED_NEIGHBORS = 60
_FEWEST_SLOTS = 4


def cluster_distance(frames: np.ndarray, nodes: NodeTable, progress: Progress = SILENT) -> np.ndarray:
    """Distance of each node to the others of its phoneme: that of the farthest of its first, middle and last frame.

    A frame's distance is the mean of those to its 5 nearest frames of other nodes; where all of its 60 nearest
    frames are of its own node, the largest distance stands in.

    frames : shape (n_frames, n_dims); returns : float64, shape (n_nodes,), in the frames' unit; 0 for a lone node
    """
    from sklearn.neighbors import NearestNeighbors

    distance = np.zeros(len(nodes))
    kinds = np.unique(nodes.phoneme)
    for done, phoneme in enumerate(kinds):
        progress.step(done / len(kinds), "measuring clusters")
        rows = np.flatnonzero(nodes.phoneme == phoneme)
        if len(rows) < 2:
            continue
        of_cluster = np.concatenate([np.arange(nodes.start[n], nodes.stop[n]) for n in rows])
        owner = np.repeat(rows, nodes.n_frames[rows])
        looked_at = np.concatenate(
            [nodes.start[rows], (nodes.start[rows] + nodes.stop[rows]) // 2, nodes.stop[rows] - 1]
        )
        own = np.tile(rows, 3)
        search = NearestNeighbors(n_neighbors=min(_ASKED_NEIGHBORS, len(owner)), algorithm="brute")
        near, index = search.fit(frames[of_cluster]).kneighbors(frames[looked_at])
        near = np.where(owner[index] == own[:, None], np.nan, near)
        near = np.sort(near, axis=1)[:, :N_NEIGHBORS]  # NaN sorts last
        found = np.isfinite(near)
        mean = np.where(found, near, 0.0).sum(axis=1) / np.maximum(found.sum(axis=1), 1)
        mean[~found.any(axis=1)] = mean.max(initial=0.0)
        np.maximum.at(distance, own, mean)
    return distance


def losing_margin(terms: TransitionTerms, weights: SearchWeights, progress: Progress = SILENT) -> np.ndarray:
    """Return by how much each node loses against the best one, where it loses least.

    Each place of the corpus between a captured predecessor and successor is offered to all nodes of its phoneme from
    other sentences; the cost of standing there is that of arriving, leaving and of an emotion that does not match.
    A node of margin 0 is the best choice somewhere.

    returns : float64, shape (n_nodes,), in units of PNT; 0 where there is nothing to compare with
    """
    nodes = terms.nodes
    margin = np.zeros(len(nodes))
    kinds = np.unique(nodes.phoneme)
    for done, phoneme in enumerate(kinds):
        progress.step(done / len(kinds), "looking for places to win")
        rows = np.flatnonzero(nodes.phoneme == phoneme)
        places = rows[(nodes.pre[rows] != NIL) & (nodes.suc[rows] != NIL)]
        if len(places) < _FEWEST_SLOTS:
            continue
        cost = terms.costs(rows, nodes.pre[places], weights).astype(float)
        cost += terms.costs(nodes.suc[places], rows, weights).T
        cost += weights.alpha6 * weights.pnt * (nodes.emotion[rows][:, None] != nodes.emotion[places][None])
        cost[nodes.sentence[rows][:, None] == nodes.sentence[places][None]] = np.inf
        best = cost.min(axis=0)
        contested = np.isfinite(best)
        if contested.any():
            least = (cost[:, contested] - best[contested]).min(axis=1)
            margin[rows] = np.where(np.isfinite(least), least, 0.0) / weights.pnt
    return margin


def robust_deviations(values: np.ndarray) -> np.ndarray:
    """Return how many robust standard deviations the logarithm of each positive value lies above the median's."""
    positive = values > 0
    deviations = np.full(len(values), -np.inf)
    if positive.sum() < 3:
        return deviations
    logarithm = np.log(values[positive])
    middle = np.median(logarithm)
    spread = 1.4826 * np.median(np.abs(logarithm - middle))
    deviations[positive] = (logarithm - middle) / max(float(spread), 1e-9)
    return deviations
