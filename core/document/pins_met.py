"""Whether the motion nodes that a project ties its slots to are what they were when it did."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.motion.database import MotionDatabase

# Poses that are this close are the same capture: a database that grew or was thinned out has another basis, which moves
# each pose by less; two takes of one phone differ by more than this somewhere.
SAME_MM = 0.5
N_LOOKS = 8
_SHOWN = 6


@dataclass(frozen=True)
class NodeContent:
    """What a motion node held, in few numbers.

    phone : what it says; n_frames : how long, in captured frames
    looks_mm : its first and its last displacement from rest, each seen along `N_LOOKS` fixed random directions over all
        markers, scaled so that the root mean square of differences estimates that of the markers, mm
    """

    phone: str
    n_frames: int
    looks_mm: tuple[float, ...]

    @classmethod
    def of(cls, database: MotionDatabase, name: str) -> NodeContent:
        """Look at a node; raises `UserFacingError` when there is none of that name."""
        node = database.nodes[database.nodes.row(name)]
        ends = database.frames[[node.start_frame, node.stop_frame - 1]]
        moved = (database.pca.positions(ends) - database.markers.rest).reshape(2, -1)
        directions = np.random.default_rng(2008).standard_normal((moved.shape[1], N_LOOKS))
        looks = moved @ directions / np.sqrt(moved.shape[1])
        return cls(node.phone, node.n_frames, tuple(round(float(look), 3) for look in looks.ravel()))

    def is_like(self, other: NodeContent) -> bool:
        """Whether both are the same capture."""
        if (self.phone, self.n_frames, len(self.looks_mm)) != (other.phone, other.n_frames, len(other.looks_mm)):
            return False
        difference = np.subtract(self.looks_mm, other.looks_mm).reshape(2, -1)
        return bool((np.sqrt((difference**2).mean(axis=1)) < SAME_MM).all())


class Ties(Protocol):
    """What asks for nodes: `core.document.content.ProjectContent`."""

    pins: Mapping[int, str]
    locks: Mapping[int, str]
    tied: Mapping[str, NodeContent]


def what_pins_met(content: Ties, database: MotionDatabase) -> list[str]:
    """Return sentences about pinned or locked nodes that ``database`` lacks, or has with other motion in them."""
    nodes = database.nodes
    names = {nodes.name(row) for row in range(len(nodes))}
    asked = {*content.pins.values(), *content.locks.values()}
    lost = sorted(asked - names)
    other = sorted(
        name
        for name in asked & names
        if name in content.tied and not content.tied[name].is_like(NodeContent.of(database, name))
    )
    sentences = []
    if lost:
        sentences.append(f"It lacks pinned or locked motion nodes ({_listed(lost)}); these are kept and tie nothing.")
    if other:
        sentences.append(f"Pinned or locked motion nodes hold another motion under their old name ({_listed(other)}).")
    return sentences


def _listed(names: list[str]) -> str:
    return ", ".join(names[:_SHOWN]) + (" …" if len(names) > _SHOWN else "")
