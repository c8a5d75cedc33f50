"""What the search knows beyond the phone itself: the phones around it, and how long it lasts.

Not in Deng and Neumann (2008), whose observation cost looks at one phone only. Lips move towards the next phones before
they are said and come away from the last ones late, so a motion node that was captured among the same phones fits
better. Both terms are local costs of a slot and a node, so that the search stays exact whatever they weigh.
"""

from __future__ import annotations

import numpy as np

from core.motion.node import CONTEXT_REACH, NodeTable
from core.search.weights import SearchWeights
from core.speech.phoneme import PAU, PHONEME_INDEX, VISEME_OF_PHONEME

SILENCE = PHONEME_INDEX[PAU]


def context_around(phonemes: np.ndarray, slot: int) -> np.ndarray:
    """Return the phones around ``slot`` as `NodeTable.context` has them of a node; int, shape (2, CONTEXT_REACH)."""
    around = np.full((2, CONTEXT_REACH), SILENCE)
    for side, step in enumerate((-1, 1)):
        at = slot + step
        for d in range(CONTEXT_REACH):
            if not 0 <= at < len(phonemes) or phonemes[at] == SILENCE:
                break
            around[side, d] = phonemes[at]
            at += step
    return around


def context_costs(phonemes: np.ndarray, slot: int, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """Cost of phones around a node that differ from those around the slot.

    ``PNT Σ_d decay^(d-1) (before · mismatch_-d + after · mismatch_+d)``, d up to `CONTEXT_REACH`; a mismatch is 0 for
    the phone itself, α4 within its viseme class and 1 otherwise. Silence has no context.

    returns : float64, shape (n_nodes,)
    """
    cost = np.zeros(len(nodes))
    if phonemes[slot] == SILENCE:
        return cost
    mismatch = mismatches(weights.alpha4)
    for wanted, captured, strength in zip(
        context_around(phonemes, slot), nodes.context, (weights.context_before, weights.context_after)
    ):
        for d in range(CONTEXT_REACH if strength else 0):
            cost += (strength * weights.context_decay**d * weights.pnt * mismatch[wanted[d]])[captured[d]]
    return cost


def mismatches(alpha4: float) -> np.ndarray:
    """0 for equal phones, ``alpha4`` within a viseme class, 1 otherwise; float64, shape (n_phonemes, n_phonemes)."""
    visemes = np.asarray(VISEME_OF_PHONEME)
    table = np.where(visemes[:, None] == visemes[None], alpha4, 1.0)
    np.fill_diagonal(table, 0.0)
    return table


def duration_costs(length: float, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """``duration · PNT · ln²(length / n_frames)``: a node is best at about its own length; float64, (n_nodes,)."""
    return weights.duration * weights.pnt * np.log(max(float(length), 1.0) / nodes.n_frames) ** 2
