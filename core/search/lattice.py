"""The relaxed lattice: some motion nodes of each slot as they are, all others behind imaginary ones."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from core.search.entry_classes import N_FOLLOWS, N_VISEMES, EntryClasses

_STRIPE = 1 << 22  # transitions that are summed at a time: a wide slot would take three times its own size otherwise


class Slot:
    """The lattice of one slot.

    local : float64, shape (n_nodes,), OC + EMP + B; inf for nodes that can lie on no best path
    active : int, ascending rows
    rest : float64, shape (N_FOLLOWS, N_VISEMES), least local cost of the inactive nodes of each class: its imaginary
        node; inf where there is none
    arriving : float32, shape (n_active, n_active of the slot before), transition costs; None until asked for
    """

    def __init__(self, local: np.ndarray, active: np.ndarray) -> None:
        self.local = local
        self.active = active
        self.rest = np.empty((0, 0))
        self.arriving: np.ndarray | None = None

    def update_rest(self, classes: EntryClasses) -> None:
        """Find anew what the imaginary nodes stand for, after ``active`` or ``local`` changed."""
        inactive = self.local.copy()
        inactive[self.active] = np.inf
        self.rest = classes.least(inactive)

    @property
    def own(self) -> np.ndarray:
        """Local costs of the active nodes."""
        return self.local[self.active]


@dataclass(frozen=True)
class Solution:
    """Least costs in the lattice, a list entry a slot.

    real : over active nodes alone, each float64, shape (n_active,), the node's own cost included
    relaxed, following : the same in the relaxed lattice, of what ends and of what starts in each active node
    reach : shape (N_FOLLOWS,), of coming to a node that follows a viseme, its own cost left out
    leave : shape (N_VISEMES,), of what comes after a node of a viseme
    reach_unseen, leave_unseen : the same, of those that come from, or go to, an imaginary node
    """

    real: list[np.ndarray]
    relaxed: list[np.ndarray]
    following: list[np.ndarray]
    reach: list[np.ndarray]
    leave: list[np.ndarray]
    reach_unseen: list[np.ndarray]
    leave_unseen: list[np.ndarray]
    lower_bound: float

    def least_through(self, p: int, slot: Slot) -> np.ndarray:
        """Least cost of the relaxed paths through each active node of slot p."""
        return self.relaxed[p] + self.following[p] - slot.own


def solve_lattice(slots: list[Slot], classes: EntryClasses) -> Solution:
    """Solve forward over active nodes alone, and forward and backward in the relaxed lattice."""
    real, relaxed, reach, reach_unseen, lower_bound = _forward(slots, classes)
    following, leave, leave_unseen = _backward(slots, classes)
    return Solution(real, relaxed, following, reach, leave, reach_unseen, leave_unseen, lower_bound)


def _forward(slots: list[Slot], classes: EntryClasses):
    join = classes.least_transition
    real, relaxed = [slots[0].own], [slots[0].own]
    reach, reach_unseen = [np.zeros(N_FOLLOWS)], [np.full(N_FOLLOWS, np.inf)]
    imaginary = slots[0].rest.min(axis=0)
    for before, slot in itertools.pairwise(slots):
        unseen = (imaginary + join).min(axis=1)
        seen = (classes.least_by_viseme(relaxed[-1], before.active) + join).min(axis=1)
        real_arrival, arrival = np.empty(len(slot.active)), np.empty(len(slot.active))
        for rows in _stripes(slot.arriving):
            real_arrival[rows] = (slot.arriving[rows] + real[-1]).min(axis=1)
            arrival[rows] = (slot.arriving[rows] + relaxed[-1]).min(axis=1)
        real.append(slot.own + real_arrival)
        relaxed.append(slot.own + np.minimum(arrival, unseen[classes.follows[slot.active]]))
        reach_unseen.append(unseen)
        reach.append(np.minimum(seen, unseen))
        imaginary = (reach[-1][:, None] + slot.rest).min(axis=0)
    return real, relaxed, reach, reach_unseen, min(float(relaxed[-1].min()), float(imaginary.min()))


def _backward(slots: list[Slot], classes: EntryClasses):
    join = classes.least_transition
    following, leave, leave_unseen = [slots[-1].own], [np.zeros(N_VISEMES)], [np.full(N_VISEMES, np.inf)]
    imaginary = slots[-1].rest.min(axis=1)
    for after, slot in itertools.pairwise(slots[::-1]):
        unseen = (imaginary[:, None] + join).min(axis=0)
        seen = (classes.least_by_follows(following[-1], after.active)[:, None] + join).min(axis=0)
        onward = np.full(len(slot.active), np.inf)
        for rows in _stripes(after.arriving):
            np.minimum(onward, (after.arriving[rows] + following[-1][rows, None]).min(axis=0), out=onward)
        following.append(slot.own + np.minimum(onward, unseen[classes.viseme[slot.active]]))
        leave_unseen.append(unseen)
        leave.append(np.minimum(seen, unseen))
        imaginary = (slot.rest + leave[-1]).min(axis=1)
    return following[::-1], leave[::-1], leave_unseen[::-1]


def _stripes(arriving: np.ndarray) -> Iterator[slice]:
    step = max(1, _STRIPE // arriving.shape[1])
    for first in range(0, len(arriving), step):
        yield slice(first, first + step)


def best_real_path(slots: list[Slot], real: list[np.ndarray]) -> np.ndarray:
    """Walk back along the best path over active nodes; equal costs go to the lowest row."""
    place = int(real[-1].argmin())
    path = [slots[-1].active[place]]
    for p in range(len(slots) - 1, 0, -1):
        place = int((slots[p].arriving[place] + real[p - 1]).argmin())
        path.append(slots[p - 1].active[place])
    return np.array(path[::-1])
