"""Which search weights are tuned, and between what bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from core.motion.node import NodeTable
from core.search.weights import SearchWeights


@dataclass(frozen=True)
class TunableWeight:
    """One dimension of the tuning, walked in its logarithm.

    low, high : bounds, as a multiple of the untuned weight when ``relative``, else as the weight itself
    start : where to begin when the untuned weight is 0, its term off
    """

    low: float
    high: float
    relative: bool = False
    start: float | None = None


# VGap has no weight of its own (equation 7), so it is the unit of all others and no scale is left over: PNT is a
# dimension like any other. PNT, α2 and α3 carry units that depend on the capture, hence bounds about the untuned ones.
PAPER_WEIGHTS: Mapping[str, TunableWeight] = {
    "pnt": TunableWeight(0.2, 100.0, relative=True),
    "alpha1": TunableWeight(0.02, 20.0),
    "alpha2": TunableWeight(0.003, 30.0, relative=True),
    "alpha3": TunableWeight(0.01, 100.0, relative=True),
    "alpha4": TunableWeight(0.05, 1.0),
    "alpha5": TunableWeight(2.0, 50.0),
    "alpha6": TunableWeight(0.5, 50.0),
}
# What the paper does not have; see `SearchWeights`.
FURTHER_WEIGHTS: Mapping[str, TunableWeight] = {
    "context_before": TunableWeight(0.02, 20.0, start=0.3),
    "context_after": TunableWeight(0.02, 20.0, start=0.3),
    "context_decay": TunableWeight(0.1, 1.0, start=0.5),
    "duration": TunableWeight(0.02, 20.0, start=0.3),
}


class TuningSpace:
    """Weights as points: the logarithms of those that matter to a database.

    low, high : the bounds; start : where to begin, the untuned weights for the most part; each shape (n_dims,)
    untuned : what relative bounds refer to, and the values of weights that are left alone
    with_further : tune the terms beyond the paper too
    """

    def __init__(self, untuned: SearchWeights, nodes: NodeTable, with_further: bool = False) -> None:
        table = {**PAPER_WEIGHTS, **(FURTHER_WEIGHTS if with_further else {})}
        if len(np.unique(nodes.emotion)) < 2:
            del table["alpha6"]  # the same for every node: it moves no path
        self.names = tuple(table)
        self.untuned = untuned
        scale = [getattr(untuned, name) if table[name].relative else 1.0 for name in table]
        self.low = np.log([w.low * s for w, s in zip(table.values(), scale)])
        self.high = np.log([w.high * s for w, s in zip(table.values(), scale)])
        starts = [getattr(untuned, name) or w.start or 0.0 for name, w in table.items()]
        self.start = np.log(np.maximum(starts, 1e-300)).clip(self.low, self.high)

    def weights(self, point: np.ndarray) -> SearchWeights:
        """Weights at ``point``, float64, shape (n_dims,); beyond the bounds the bounds hold."""
        values = np.exp(np.clip(point, self.low, self.high))
        return replace(self.untuned, **{name: float(value) for name, value in zip(self.names, values)})

    def random_points(self, rng: np.random.Generator, count: int) -> np.ndarray:
        """Draw points evenly between the bounds, shape (count, n_dims)."""
        return rng.uniform(self.low, self.high, (count, len(self.names)))
