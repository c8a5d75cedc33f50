"""Hard constraints: which motion nodes may stand in which slot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from core.errors import UserFacingError
from core.motion.node import NodeTable
from core.speech.phoneme import PHONEMES


@dataclass(frozen=True)
class SearchRequest:
    """One question to the search; captures all it needs.

    phonemes : int, shape (n_slots,), indices into `PHONEMES`, silences included
    emotions : float64, shape (n_slots, n_emotions), rows sum to 1 (the emotion modifiers, soft)
    pins : slot to row of the motion node that is tied to it (the motion-node constraints, hard)
    removed : rows of nodes that the search must not use
    """

    phonemes: np.ndarray
    emotions: np.ndarray
    pins: Mapping[int, int] = field(default_factory=dict)
    removed: frozenset[int] = frozenset()

    @property
    def n_slots(self) -> int:
        """Number of phoneme slots."""
        return len(self.phonemes)


def check_feasible(request: SearchRequest, nodes: NodeTable) -> None:
    """Raise `UserFacingError`, naming the slot and what would mend it, when no path can satisfy ``request``."""
    if request.n_slots == 0:
        raise UserFacingError("There is no phoneme to find motion for.")
    for slot, row in sorted(request.pins.items()):
        if not 0 <= slot < request.n_slots:
            raise UserFacingError(
                f"A motion node is pinned to slot {slot}, but the sentence has slots 0 to {request.n_slots - 1}."
            )
        if row in request.removed:
            raise UserFacingError(
                f"Slot {slot} (/{PHONEMES[request.phonemes[slot]]}/) is pinned to the motion node {nodes.name(row)}, "
                "which was removed from the database.",
                "Restore the node, or unpin the slot.",
            )
    if len(request.removed) >= len(nodes):
        raise UserFacingError("Every motion node of the database was removed.", "Restore some of them.")


def blocked_nodes(request: SearchRequest, slot: int, n_nodes: int) -> np.ndarray:
    """Return a bool mask, shape (n_nodes,), of the nodes that must not stand in ``slot``.

    This is B(t, j) of equation 10, built as exact blocking: at unconstrained times it blocks nothing but removed nodes
    (as printed it would block every node there), and it holds at the first slot too, which Algorithm 1 forgets.
    """
    pinned = request.pins.get(slot)
    if pinned is not None:
        mask = np.ones(n_nodes, bool)
        mask[pinned] = False
        return mask
    mask = np.zeros(n_nodes, bool)
    mask[list(request.removed)] = True
    return mask
