"""The modern mapping beside the paper's: a few deeper perceptrons hear the window, and are averaged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core.iface.perceptrons import Perceptron
from core.iface.unit_face import UnitFace, windows


@dataclass(frozen=True, eq=False)
class ModernFace(UnitFace):
    """One window for all sounds, one trunk for all expressions.

    nets : of the same shape, trained from different seeds; each gives the MUPs of neutral and of every expression, side
        by side, for one window
    """

    nets: tuple[Perceptron, ...]

    def parameters(self, context: np.ndarray) -> tuple[np.ndarray, ...]:
        """See `UnitFace.parameters`."""
        heard = windows(context, len(context) - self.n_back - self.n_ahead)
        mean = sum(net(heard) for net in self.nets) / np.float32(len(self.nets))
        counts = [self.units.n_parameters(state) for state in ("neutral", *self.expressions)]
        return tuple(np.split(mean, np.cumsum(counts)[:-1], axis=1))
