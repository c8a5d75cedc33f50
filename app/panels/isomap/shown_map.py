"""A phoneme map as it is on show: where each captured frame lies, and whose it is."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from core.manifold.isomap import PhonemeMap, delaunay_triangles
from core.manifold.picking import Picker
from core.motion.database import MotionDatabase


class ShownMap:
    """The Isomap of a phone, or its PCA map, with what the panel asks of it again and again.

    points : float64, shape (n, 2), map units; a place is an index into it
    node : int, shape (n,), row of each place's motion node
    rows : int, shape (n_nodes,), the nodes on the map, in the order of their places
    first, count : int, shape (n_nodes,), where each node's places begin, and how many they are
    """

    def __init__(self, database: MotionDatabase, phone: str, phoneme_map: PhonemeMap) -> None:
        self.database, self.phone, self.map = database, phone, phoneme_map
        self.points = phoneme_map.embedding.astype(float)
        self.node = np.searchsorted(database.nodes.start, phoneme_map.frames, side="right") - 1
        self.rows, self.first, self.count = np.unique(self.node, return_index=True, return_counts=True)

    @classmethod
    def isomap(cls, database: MotionDatabase, phone: str) -> ShownMap:
        """Return the Isomap of ``phone``."""
        return cls(database, phone, database.maps[phone])

    @classmethod
    def pca(cls, database: MotionDatabase, phone: str) -> ShownMap:
        """Return the linear map of ``phone``."""
        stored = database.maps[phone]
        return cls(database, phone, replace(stored, embedding=stored.pca, triangles=delaunay_triangles(stored.pca)))

    @cached_property
    def picker(self) -> Picker:
        """Picks points of this map."""
        return Picker(self.map)

    @cached_property
    def emotion(self) -> np.ndarray:
        """Index into `EMOTIONS` of each place."""
        return self.database.nodes.emotion[self.node].astype(int)

    @cached_property
    def relative_time(self) -> np.ndarray:
        """Relative time, 0 to 1, of each place within its node; the only frame of a node is at 0."""
        nodes = self.database.nodes
        return (self.map.frames - nodes.start[self.node]) / np.maximum(nodes.n_frames[self.node] - 1, 1)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Left, bottom, right, top of all points; never without area."""
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        high = np.maximum(high, low + max(float((high - low).max()), 1.0) * 1e-3)
        return (*low, *high)

    def trajectory(self, row: int) -> np.ndarray:
        """Return the way of a node over the map, shape (n_frames, 2); empty when it is not on this map."""
        i = int(np.searchsorted(self.rows, row))
        if i == len(self.rows) or self.rows[i] != row:
            return np.zeros((0, 2))
        return self.points[self.first[i] : self.first[i] + self.count[i]]

    def at_share(self, share: float) -> np.ndarray:
        """Return where each node of the map is at relative time ``share``, 0 to 1; shape (n_nodes, 2)."""
        place = min(max(share, 0.0), 1.0) * (self.count - 1)
        low = np.floor(place).astype(int)
        between = (place - low)[:, None]
        start = self.points[self.first + low]
        end = self.points[self.first + np.minimum(low + 1, self.count - 1)]
        return start + between * (end - start)

    def in_context(self, previous: str, following: str) -> np.ndarray:
        """Return for each node of the map whether it was captured between these phones: bool, shape (n_nodes,)."""
        from core.speech.phoneme import PHONEME_INDEX

        nodes = self.database.nodes
        before, after = PHONEME_INDEX.get(previous, -1), PHONEME_INDEX.get(following, -1)
        return (nodes.previous[self.rows] == before) & (nodes.following[self.rows] == after)

    def nodes_inside(self, inside: np.ndarray) -> frozenset[int]:
        """Return the nodes with at least half of their places ``inside``, else all with any; bool, shape (n,)."""
        share = np.add.reduceat(inside.astype(float), self.first) / self.count
        chosen = share >= 0.5
        if not chosen.any():
            chosen = share > 0
        return frozenset(self.rows[chosen].tolist())
