"""Classes of motion nodes between which a transition cannot be cheap: the viseme captured before a node, and its own.

Rules 3 and 4 of table 1 (Deng and Neumann 2008) price a join by PNT, or by α1·PNT, as soon as the viseme that is left
is not the one after which the next node was captured. That alone bounds TC from below for all pairs of two classes, and
joins of natural paths cost less than PNT: so most nodes of a slot are told apart from those worth a look.
"""

from __future__ import annotations

import numpy as np

from core.motion.node import NIL, NodeTable
from core.search.weights import SearchWeights
from core.speech.phoneme import VISEME_OF_PHONEME

N_VISEMES = max(VISEME_OF_PHONEME) + 1
N_FOLLOWS = N_VISEMES + 1  # what a node follows: a viseme, or the start of a captured stretch (NIL)


class EntryClasses:
    """Motion nodes by the viseme a that they follow in capture and their own viseme v.

    follows : int, shape (n_nodes,), viseme(pre(n)), `N_VISEMES` where pre(n) = NIL
    viseme : int, shape (n_nodes,)
    least_transition : float64, shape (N_FOLLOWS, N_VISEMES); TC from a node of viseme v to one that follows a is never
        less than ``least_transition[a, v]``
    """

    def __init__(self, nodes: NodeTable, weights: SearchWeights) -> None:
        self.viseme = nodes.viseme.astype(int)
        self.follows = np.where(nodes.pre == NIL, N_VISEMES, self.viseme[nodes.pre])
        # rounded as transition costs are, so that the bound holds for what the search adds up
        self.least_transition = np.full((N_FOLLOWS, N_VISEMES), float(np.float32(weights.pnt)))
        np.fill_diagonal(self.least_transition, 0.0)
        self.least_transition[N_VISEMES] = float(np.float32(weights.alpha1 * weights.pnt))
        self.of_node = self.follows * N_VISEMES + self.viseme
        self._order = np.argsort(self.of_node, kind="stable")
        self._present, self._first = np.unique(self.of_node[self._order], return_index=True)

    def least(self, values: np.ndarray) -> np.ndarray:
        """Return the least of ``values`` (one a node) in each class; float64, (N_FOLLOWS, N_VISEMES), inf if empty."""
        least = np.full(N_FOLLOWS * N_VISEMES, np.inf)
        least[self._present] = np.minimum.reduceat(values[self._order], self._first)
        return least.reshape(N_FOLLOWS, N_VISEMES)

    def least_by_viseme(self, values: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return the least of ``values`` (one a row of ``rows``) for each viseme; float64, shape (N_VISEMES,)."""
        least = np.full(N_VISEMES, np.inf)
        np.minimum.at(least, self.viseme[rows], values)
        return least

    def least_by_follows(self, values: np.ndarray, rows: np.ndarray) -> np.ndarray:
        """Return the same for each viseme followed; float64, shape (N_FOLLOWS,)."""
        least = np.full(N_FOLLOWS, np.inf)
        np.minimum.at(least, self.follows[rows], values)
        return least
