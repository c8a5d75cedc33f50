"""Best paths of the tuning sentences under many weights, quickly.

The transition terms between the motion nodes that can be expected in neighbouring slots do not depend on the weights:
they are computed once, and a change of weights only weighs them anew. The best path over those nodes is exact whenever
the relaxed lattice of `core.search.relaxation`, in which one imaginary node stands for all others, has a best path that
avoids the imaginary nodes: no path is cheaper than that one. Otherwise the relaxation itself answers, which takes tens
of times as long; where the walk over weights only asks which way is down, nodes of other phonemes are left out instead.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np

from core.motion.node import NIL, NodeTable
from core.search.best_path import slot_costs
from core.search.constraints import SearchRequest
from core.search.context import SILENCE
from core.search.relaxation import find_path_by_relaxation
from core.search.terms import TransitionTerms
from core.search.transitions import TransitionCosts
from core.search.weights import SearchWeights

_STRIPE = 1 << 16  # pairs that are weighed at a time, so that they stay in the cache
Candidates = tuple[int, int]  # phoneme, and for silence also the emotion, else NIL


class TuningLattice:
    """The joins that the given sentences can be expected to need, without weights.

    Silence at either end is not laid out: whatever was captured beside the first node stands there for nothing.

    requests : of the sentences
    parts : PGap, VGap and DSC of all pairs of nodes, float32, shape (3, n_nodes, n_nodes), the node arrived at first;
        None computes what is needed and leaves the rest to be computed when asked for
    expected : flat float32, what `expected` of another lattice of the same terms and requests was (a memory map, say)
    allocate : makes room for so many float32, where ``expected`` is made
    """

    def __init__(
        self,
        terms: TransitionTerms,
        requests: Sequence[SearchRequest],
        parts: np.ndarray | None = None,
        expected: np.ndarray | None = None,
        allocate: Callable[[int], np.ndarray] = lambda size: np.empty(size, np.float32),
    ) -> None:
        self.terms = terms
        self.parts = parts
        nodes = terms.nodes
        self._slots = [_inner_candidates(request, nodes) for request in requests]
        self._rows = {key: _rows_of(key, nodes) for slots in self._slots for key in slots}
        followed = sorted({pair for slots in self._slots for pair in itertools.pairwise(slots)})
        ending = {slots[-1] for slots, request in zip(self._slots, requests) if slots and _ends_silent(request)}
        # where a sentence may end although nothing was captured after the node
        last = [self._rows[key][nodes.suc[self._rows[key]] == NIL] for key in sorted(ending)]
        self._last = np.unique(np.concatenate(last)) if last else np.zeros(0, int)
        sizes = [(3, len(self._rows[after]), len(self._rows[before])) for before, after in followed]
        shapes = [*sizes, (len(self._last), 3, len(nodes), 1)]
        stops = np.cumsum([0, *(math.prod(shape) for shape in shapes)])
        self.expected = allocate(int(stops[-1])) if expected is None else expected
        rooms = [self.expected[a:b].reshape(shape) for a, b, shape in zip(stops, stops[1:], shapes)]
        self._joins = {
            (before, after): Join(room, self._rows[after], self._rows[before], nodes)
            for (before, after), room in zip(followed, rooms)
        }
        self._into_silence = rooms[-1]
        self._ends: dict[int, Join] = {}
        if expected is None:
            self._compute()

    def _compute(self) -> None:
        for before, pairs in itertools.groupby(self._joins, key=lambda pair: pair[0]):
            followers = [after for _, after in pairs]
            targets = np.unique(np.concatenate([self._rows[after] for after in followers]))
            computed = self._parts(targets, self._rows[before])
            for after in followers:
                self._joins[before, after].parts[:] = computed[:, np.searchsorted(targets, self._rows[after])]
        if len(self._last):
            self._into_silence[..., 0] = self._parts(np.arange(len(self.terms.nodes)), self._last).transpose(2, 0, 1)

    def _parts(self, targets: np.ndarray, sources: np.ndarray) -> np.ndarray:
        if self.parts is not None:
            return self.parts[:, targets[:, None], sources[None]]
        parts = np.zeros((3, len(targets), len(sources)), np.float32)
        for block in self.terms.blocks(targets, sources):
            at = np.searchsorted(targets, block.targets)
            parts[0, at], parts[1, at], parts[2, at] = block.position_gap, block.velocity_gap, block.smoothing
        return parts

    def best_path(
        self, sentence: int, request: SearchRequest, weights: SearchWeights, exact: bool
    ) -> tuple[np.ndarray, bool]:
        """Rows of the best path, int, shape (n_slots,), and whether its cost is proved to be that of the exact search.

        Silent slots at the ends are given some node that costs the least. Where the expected nodes do not prove it at
        once and ``exact`` is not asked for, it is the best path over nodes that say the phonemes.
        """
        slots = self._slots[sentence]
        path = self._expected_path(slots, request, weights) if slots else None
        if path is not None:
            return path, True
        if slots and not exact:
            path = self._expected_path(slots, request, weights, others=False)
        if path is not None:
            return path, False
        if self.parts is None:
            return find_path_by_relaxation(request, TransitionCosts(self.terms, weights, budget_bytes=0)).nodes, True
        return find_path_by_relaxation(request, _WeighedWhenAsked(self, weights)).nodes, True

    def _expected_path(
        self, slots: list[Candidates], request: SearchRequest, weights: SearchWeights, others: bool = True
    ) -> np.ndarray | None:
        """Best path over the expected nodes; None if one that uses any of the ``others`` may be better."""
        nodes = self.terms.nodes
        opening = int(_opens_silent(request))
        local = [slot_costs(request, p, nodes, weights) for p in range(request.n_slots)]
        fronts, imaginary, is_imaginary = [], [], []
        for i, key in enumerate(slots):
            rows, own = self._rows[key], local[i + opening]
            if i == 0:
                arrived, is_sure = self._after_opening(rows, local, opening, weights)
                reach = float(local[0].min()) if opening else 0.0
                through = ~is_sure & others
            else:
                real = self._joins[slots[i - 1], key].arrive(fronts[-1], weights)
                reach = min(float(fronts[-1].min()), imaginary[-1])
                through = real > imaginary[-1]
                arrived = np.minimum(real, imaginary[-1])
            rest = own.copy()
            rest[rows] = np.inf
            imaginary.append(reach + float(rest.min()) if others else np.inf)
            is_imaginary.append(through)
            fronts.append(own[rows] + arrived)
        ending = self._end(slots[-1], fronts[-1], imaginary[-1], local, request, weights, others)
        if ending is None:
            return None
        return self._trace_back(ending, slots, fronts, is_imaginary, request, local, weights)

    def _after_opening(
        self, rows: np.ndarray, local: list[np.ndarray], opening: int, weights: SearchWeights
    ) -> tuple[np.ndarray, np.ndarray]:
        """Least cost of arriving in the first inner slot, and where that is no mere bound."""
        if not opening:
            return np.zeros(len(rows)), np.ones(len(rows), bool)
        silence = local[0]
        pre = self.terms.nodes.pre[rows]
        least = float(silence.min())
        without = pre == NIL
        arrived = np.where(without, least + np.float64(np.float32(weights.alpha1 * weights.pnt)), least)
        return arrived, without | (silence[pre] == least)

    def _end(
        self, key: Candidates, front: np.ndarray, imaginary: float, local: list[np.ndarray], request: SearchRequest,
        weights: SearchWeights, others: bool,
    ) -> tuple[int, int | None] | None:  # fmt: skip
        """Place of the last inner node on the best path, and the node of the silence after it; None if not proved."""
        rows, suc = self._rows[key], self.terms.nodes.suc[self._rows[key]]
        if not _ends_silent(request):
            place = int(front.argmin())
            return None if imaginary < front[place] else (place, None)
        silence = local[-1]
        least = float(silence.min())
        final = front + least
        known: dict[int, int] = {}
        while True:
            place = int(final.argmin())
            if imaginary + least < final[place]:
                return None
            if place in known:
                return place, known[place]
            if suc[place] != NIL and silence[suc[place]] == least:
                return place, int(suc[place])
            i = int(np.searchsorted(self._last, rows[place]))
            if i == len(self._last) or self._last[i] != rows[place]:
                return None if others else (place, int(suc[place]))
            if i not in self._ends:
                nodes = self.terms.nodes
                self._ends[i] = Join(self._into_silence[i], np.arange(len(nodes)), rows[place : place + 1], nodes)
            into = self._ends[i].weighed(weights, slice(None))[:, 0] + silence
            known[place] = int(into.argmin())
            final[place] = front[place] + into[known[place]]

    def _trace_back(
        self, ending: tuple[int, int | None], slots: list[Candidates], fronts: list[np.ndarray],
        is_imaginary: list[np.ndarray], request: SearchRequest, local: list[np.ndarray], weights: SearchWeights,
    ) -> np.ndarray | None:  # fmt: skip
        place, last = ending
        path = [] if last is None else [last]
        for i in range(len(slots) - 1, -1, -1):
            if is_imaginary[i][place]:
                return None
            path.append(int(self._rows[slots[i]][place]))
            if i:
                join = self._joins[slots[i - 1], slots[i]]
                place = int((join.weighed(weights, slice(place, place + 1))[0] + fronts[i - 1]).argmin())
        if _opens_silent(request):
            pre = self.terms.nodes.pre[path[-1]]
            path.append(int(pre) if pre != NIL else int(local[0].argmin()))
        return np.array(path[::-1])


class Join:
    """Terms from some nodes into others.

    parts : float32, shape (3, n_targets, n_sources): PGap, VGap, DSC
    """

    def __init__(self, parts: np.ndarray, targets: np.ndarray, sources: np.ndarray, nodes: NodeTable) -> None:
        self.parts = parts
        pre = nodes.pre[targets]
        self._without_pre = pre == NIL
        visemes = np.unique(nodes.viseme[sources])
        self._differs = nodes.viseme[pre][:, None] != (visemes if len(visemes) == 1 else nodes.viseme[sources])[None]
        # where the source is the captured predecessor
        place = np.searchsorted(sources, pre).clip(max=len(sources) - 1)
        captured = ~self._without_pre & (sources[place] == pre)
        self._captured = np.where(captured, place, -1)

    def weighed(self, weights: SearchWeights, rows: slice) -> np.ndarray:
        """TC of table 1, rounded as `core.search.transitions` does; float32, shape (n_rows, n_sources)."""
        position, velocity, smoothing = self.parts[:, rows]
        cost = position * np.float32(weights.alpha3)
        cost += velocity
        cost += smoothing * np.float32(weights.alpha2)
        np.add(cost, np.float32(weights.pnt), out=cost, where=self._differs[rows])
        cost[self._without_pre[rows]] = weights.alpha1 * weights.pnt
        captured = self._captured[rows]
        at = np.flatnonzero(captured >= 0)
        cost[at, captured[at]] = 0.0
        return cost

    def arrive(self, front: np.ndarray, weights: SearchWeights) -> np.ndarray:
        """``min_n(front[n] + TC[m, n])`` for every target m; float64."""
        n_targets, n_sources = self.parts.shape[1:]
        arrived = np.empty(n_targets)
        step = max(1, _STRIPE // n_sources)
        for first in range(0, n_targets, step):
            rows = slice(first, first + step)
            arrived[rows] = (self.weighed(weights, rows) + front).min(axis=1)
        return arrived


class _WeighedWhenAsked:
    """What the relaxation asks of `core.search.transitions.TransitionCosts`, from parts that processes share."""

    is_held = True

    def __init__(self, lattice: TuningLattice, weights: SearchWeights) -> None:
        self.terms, self.weights = lattice.terms, weights
        self._lattice = lattice

    def block(self, targets: np.ndarray, sources: np.ndarray) -> np.ndarray:
        """See `TransitionCosts.block`."""
        parts = self._lattice._parts(targets, sources)
        return Join(parts, targets, sources, self.terms.nodes).weighed(self.weights, slice(None))


def _opens_silent(request: SearchRequest) -> bool:
    return bool(request.phonemes[0] == SILENCE)


def _ends_silent(request: SearchRequest) -> bool:
    return bool(request.phonemes[-1] == SILENCE)


def _inner_candidates(request: SearchRequest, nodes: NodeTable) -> list[Candidates]:
    """Candidates of the slots between the silences at the ends; none for sentences that are left to the relaxation."""
    inner = range(int(_opens_silent(request)), request.n_slots - int(_ends_silent(request)))
    phonemes = request.phonemes[list(inner)]
    spoken = set(np.unique(nodes.phoneme).tolist())
    # two silences side by side, or a phoneme that the database lacks, are left to the relaxation
    silent = np.flatnonzero(phonemes == SILENCE)
    missing = set(phonemes.tolist()) - spoken - {SILENCE}
    if not len(phonemes) or missing or {0, len(phonemes) - 1} & set(silent.tolist()) or (np.diff(silent) == 1).any():
        return []
    return [
        (SILENCE, int(request.emotions[p].argmax()))
        if request.phonemes[p] == SILENCE
        else (int(request.phonemes[p]), NIL)
        for p in inner
    ]


def _rows_of(key: Candidates, nodes: NodeTable) -> np.ndarray:
    phoneme, emotion = key
    return np.flatnonzero(nodes.emotion == emotion if phoneme == SILENCE else nodes.phoneme == phoneme)
