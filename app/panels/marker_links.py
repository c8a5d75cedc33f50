"""Faint lines between neighbouring markers, so that a cloud of them reads as a face."""

from __future__ import annotations

import numpy as np

from core.motion.marker_set import MarkerSet

# the sum below holds n³ distances; a denser set reads as a face without lines
_MOST_MARKERS = 300


def marker_links(markers: MarkerSet) -> np.ndarray:
    """Return pairs of markers to join, int32, shape (n_links, 2): the relative neighbourhood graph of the rest pose.

    Two markers are joined when no third is nearer to both than they are to each other (Toussaint 1980); upper and
    lower lip are not, as they part.
    """
    n = len(markers)
    if n > _MOST_MARKERS:
        return np.zeros((0, 2), np.int32)
    distance = np.linalg.norm(markers.rest[:, None] - markers.rest[None], axis=2)
    np.fill_diagonal(distance, np.inf)
    nearer = np.empty_like(distance)
    for i in range(n):
        nearer[i] = np.maximum(distance[i][None], distance).min(axis=1)
    joined = np.triu(distance <= nearer, k=1)
    upper, lower = markers.group("upper_lip"), markers.group("lower_lip")
    joined[np.ix_(upper, lower)] = joined[np.ix_(lower, upper)] = False
    return np.argwhere(joined).astype(np.int32)
