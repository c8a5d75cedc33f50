"""What is shown of a map: a frame, interpolated or captured, and whose it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from app import texts
from core.motion.database import MotionDatabase
from core.motion.node import MotionNode, NodeTable

if TYPE_CHECKING:
    from app.panels.isomap.shown_map import ShownMap


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
    price : what forcing the node into the selected slot adds to the cost, in units of PNT; None when not known
    """

    at: np.ndarray | None
    frames: np.ndarray
    weights: np.ndarray
    node: int
    inside: bool = True
    in_use: bool = False
    price: float | None = None

    @classmethod
    def under(cls, shown: ShownMap, point: np.ndarray) -> MapPick:
        """Pick ``point``, map units: a mix of three captured frames, or the nearest one outside of all triangles."""
        picked = shown.picker.pick(point)
        return cls(np.asarray(point, float), picked.frames, picked.weights, int(shown.node[picked.nearest]),
                   picked.inside)  # fmt: skip

    @classmethod
    def captured(cls, shown: ShownMap, place: int) -> MapPick:
        """Return the captured frame at a place of the map."""
        return cls(shown.points[place], shown.map.frames[[place]], np.ones(1), int(shown.node[place]))

    @classmethod
    def of_node(cls, database: MotionDatabase, node: int, share: float, shown: ShownMap | None = None) -> MapPick:
        """Return the frame of ``node`` at relative time ``share`` (0..1), interpolated as the synthesis does."""
        start, stop = int(database.nodes.start[node]), int(database.nodes.stop[node])
        place = min(max(share, 0.0), 1.0) * (stop - start - 1)
        low = int(place)
        high = min(low + 1, stop - start - 1)
        weights = np.array([1.0 - (place - low), place - low])
        walked = np.zeros((0, 2)) if shown is None else shown.trajectory(node)
        at = weights @ walked[[low, high]] if len(walked) else None
        return cls(at, np.array([start + low, start + high]), weights, node)

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
        if self.price is not None:
            said += texts.PREVIEW_PRICE.format(price=self.price) if np.isfinite(self.price) else texts.PREVIEW_NO_PRICE
        text = database.sentence(node.sentence).text
        sign = texts.PREVIEW_USED if self.in_use else "" if self.inside else texts.PREVIEW_OUTSIDE
        return f"{sign}{said} · “{text}”" if text else f"{sign}{said}"
