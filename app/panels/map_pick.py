"""What is shown of a map: a frame, interpolated or captured, and whose it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from app import texts
from core.manifold.isomap import PhonemeMap
from core.manifold.picking import Pick, pick
from core.motion.database import MotionDatabase
from core.motion.node import MotionNode, NodeTable


def node_of_frame(nodes: NodeTable, frame: int) -> int:
    """Return the row of the motion node that a frame belongs to; nodes follow each other in the order of frames."""
    return int(np.searchsorted(nodes.start, frame, side="right")) - 1


@dataclass(frozen=True)
class MapPick:
    """A place on the map of one phone.

    at : float, shape (2,), map units; None when the frame is not on that map
    frames, weights : rows of the database's frames and how they are mixed
    node : row of the motion node, of the nearest frame where several mix
    inside : False where the place is outside the map's triangles and its nearest frame stands in
    in_use : whether this is the frame that the path uses in the selected slot
    """

    at: np.ndarray | None
    frames: np.ndarray
    weights: np.ndarray
    node: int
    inside: bool = True
    in_use: bool = False

    @classmethod
    def under(cls, database: MotionDatabase, phoneme_map: PhonemeMap, point: np.ndarray) -> MapPick:
        """Pick ``point``, map units."""
        picked: Pick = pick(phoneme_map, point)
        node = node_of_frame(database.nodes, int(phoneme_map.frames[picked.nearest]))
        return cls(np.asarray(point, float), picked.frames, picked.weights, node, picked.inside)

    @classmethod
    def used(cls, database: MotionDatabase, phone: str, node: int, share: float) -> MapPick:
        """Return the frame of ``node`` at relative time ``share`` (0..1), as it is used, on the map of ``phone``."""
        start, stop = int(database.nodes.start[node]), int(database.nodes.stop[node])
        place = min(max(share, 0.0), 1.0) * (stop - start - 1)
        low = int(place)
        high = min(low + 1, stop - start - 1)
        weights = np.array([1.0 - (place - low), place - low])
        walked = trajectory(database, phone, node)
        at = weights @ walked[[low, high]] if len(walked) else None
        return cls(at, np.array([start + low, start + high]), weights, node, True, True)

    def blend(self, frames: np.ndarray) -> np.ndarray:
        """Return the coefficients of the frame, shape (n_dims,)."""
        return self.weights @ frames[self.frames]

    def node_name(self, database: MotionDatabase) -> str:
        """Return the node's public name."""
        return database.nodes.name(self.node)

    def caption(self, database: MotionDatabase) -> str:
        """Say what it is: node, emotion, context, length, and the sentence."""
        node: MotionNode = database.nodes[self.node]
        before, _, after = node.triphone
        said = texts.PREVIEW_NODE.format(
            node=node.name, emotion=node.emotion, before=before, phone=node.phone, after=after,
            milliseconds=1000 * node.n_frames / database.rate_hz,
        )  # fmt: skip
        text = database.sentence(node.sentence).text
        sign = texts.PREVIEW_USED if self.in_use else "" if self.inside else texts.PREVIEW_OUTSIDE
        return f"{sign}{said} · “{text}”" if text else f"{sign}{said}"


def trajectory(database: MotionDatabase, phone: str, node: int) -> np.ndarray:
    """Return the path of a node over the map of ``phone``, shape (n_frames, 2); empty when it is not on that map."""
    nodes, phoneme_map = database.nodes, database.maps[phone]
    if nodes[node].phone != phone:
        return np.zeros((0, 2))
    first = int(np.searchsorted(phoneme_map.frames, nodes.start[node]))
    return phoneme_map.embedding[first : first + int(nodes.n_frames[node])].astype(float)
