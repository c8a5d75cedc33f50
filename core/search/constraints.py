"""Hard constraints: which motion nodes may stand in which slot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from core.errors import UserFacingError
from core.motion.node import NodeTable
from core.speech.phoneme import PAU, PHONEMES


@dataclass(frozen=True)
class SearchRequest:
    """One question to the search; captures all it needs.

    phonemes : int, shape (n_slots,), indices into `PHONEMES`, silences included
    emotions : float64, shape (n_slots, n_emotions), rows sum to 1 (the emotion modifiers, soft)
    pins : slot to row of the motion node that is tied to it (the motion-node constraints, hard)
    removed : rows of nodes that the search must not use
    lengths : frames, at the database's rate, that each slot lasts, shape (n_slots,); None when it does not matter
    start_s : when each slot begins, so that messages can say it
    """

    phonemes: np.ndarray
    emotions: np.ndarray
    pins: Mapping[int, int] = field(default_factory=dict)
    removed: frozenset[int] = frozenset()
    lengths: np.ndarray | None = None
    start_s: tuple[float, ...] | None = None

    @property
    def n_slots(self) -> int:
        """Number of phoneme slots."""
        return len(self.phonemes)


def slot_name(request: SearchRequest, slot: int) -> str:
    """Name a slot as an animator finds it: number, phone, and time when it is known."""
    at = "" if request.start_s is None else f" at {request.start_s[slot]:.2f} s"
    return f"slot {slot} (/{PHONEMES[request.phonemes[slot]]}/{at})"


def check_feasible(request: SearchRequest, nodes: NodeTable) -> None:
    """Raise `UserFacingError`, naming the slot and what would mend it, when no path can satisfy ``request``.

    Any node can stand in any slot, at a cost, so a slot lacks candidates only when every node of the database was
    removed; a phone without nodes of its own is no error, see `missing_phonemes`.
    """
    if request.n_slots == 0:
        raise UserFacingError("There is no phoneme to find motion for.")
    for slot, row in sorted(request.pins.items()):
        if not 0 <= slot < request.n_slots:
            raise UserFacingError(
                f"A motion node is pinned to slot {slot}, but the sentence has slots 0 to {request.n_slots - 1}."
            )
        if not 0 <= row < len(nodes):
            raise UserFacingError(
                f"The motion node pinned to {slot_name(request, slot)} is not in the database.", "Unpin the slot."
            )
        if row in request.removed:
            raise UserFacingError(
                f"The motion node {nodes.name(row)}, pinned to {slot_name(request, slot)}, was removed from the "
                "database.",
                "Restore the node, or unpin the slot.",
            )
    if len(request.removed) >= len(nodes):
        raise UserFacingError(
            f"Nothing can stand in {slot_name(request, 0)}: every motion node of the database was removed.",
            "Restore some of them.",
        )


def missing_phonemes(request: SearchRequest, nodes: NodeTable) -> tuple[str, ...]:
    """Return a sentence for each phone, silence aside, that no node left in the database says; pinned slots aside.

    The search then takes another phone's motion, at the cost of table 2: a path, but hardly what the animator wants.
    """
    left = np.ones(len(nodes), bool)
    left[list(request.removed)] = False
    slots_of: dict[int, list[int]] = {}
    for slot, phoneme in enumerate(request.phonemes):
        if slot not in request.pins and PHONEMES[phoneme] != PAU and not (left & (nodes.phoneme == phoneme)).any():
            slots_of.setdefault(int(phoneme), []).append(slot)
    sentences = []
    for phoneme, slots in slots_of.items():
        phone = f"/{PHONEMES[phoneme]}/"
        where = slot_name(request, slots[0]) + (f" and {len(slots) - 1} more" if len(slots) > 1 else "")
        if (nodes.phoneme == phoneme).any():
            why, mend = f"Every motion node of {phone} was removed", " Restore one, or pin what shall stand there."
        else:
            why, mend = f"The database has no motion of {phone}", ""
        sentences.append(f"{why}: another phoneme's stands in for it in {where}.{mend}")
    return tuple(sentences)


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
