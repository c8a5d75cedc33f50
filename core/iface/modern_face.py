"""The modern mapping beside the paper's: perceptrons tell the phones that are heard, and others move by those."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.iface.ear import FRAMES_AROUND, phone_shares
from core.iface.perceptrons import Perceptron
from core.iface.speech_features import N_CEPSTRA
from core.iface.unit_face import UnitFace, windows


@dataclass(frozen=True, eq=False)
class ModernFace(UnitFace):
    """One window for all sounds, one trunk for all expressions.

    ears : of the same shape, from different seeds; see `core.iface.ear`
    nets : of the same shape, from different seeds; each gives the MUPs of neutral and of every expression, side by
        side, for one window of what `told` returns
    """

    ears: tuple[Perceptron, ...]
    nets: tuple[Perceptron, ...]

    def parameters(self, context: np.ndarray) -> tuple[np.ndarray, ...]:
        """See `UnitFace.parameters`."""
        heard = told(self.ears, context, len(context) - self.n_back - self.n_ahead)
        mean = sum(net(heard) for net in self.nets) / np.float32(len(self.nets))
        counts = [self.units.n_parameters(state) for state in ("neutral", *self.expressions)]
        return tuple(np.split(mean, np.cumsum(counts)[:-1], axis=1))


def told(ears: Sequence[Perceptron], context: np.ndarray, n_frames: int) -> np.ndarray:
    """Return what is known of the sound around each of ``n_frames``, float32, shape (n_frames, `n_told`).

    Roots of the shares of the phones, as far ahead as ears can tell, and the ten cepstra of each frame.

    context : shape (n_back + n_frames + n_ahead, 70)
    """
    phones = windows(np.sqrt(phone_shares(ears, context)), n_frames)
    cepstra = windows(context[FRAMES_AROUND:, :N_CEPSTRA], n_frames)
    return np.concatenate([phones, cepstra], axis=1).astype(np.float32, copy=False)


def n_told(n_window: int, n_phones: int) -> int:
    """How many numbers `told` returns for a frame that is heard in a window of ``n_window`` frames."""
    return (n_window - 2 * FRAMES_AROUND) * n_phones + (n_window - FRAMES_AROUND) * N_CEPSTRA
