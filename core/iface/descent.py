"""Perceptrons trained by stochastic gradient descent (Adam; Kingma and Ba 2015) on inputs that vary from pass to pass.

scikit-learn's own cannot leave out outputs that a sample says nothing of, nor hear each pass anew.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from core.iface.ear import shares
from core.iface.perceptrons import Perceptron
from core.progress import SILENT, Progress

_MEAN_DECAY, _SQUARE_DECAY, _TINY = 0.9, 0.999, 1e-8  # as in the paper


@dataclass(frozen=True)
class DescentSettings:
    """How the weights are walked down.

    n_passes : over all samples; step : the first one, which falls to 0 along half a cosine
    batch : samples a step
    noise : standard deviation of what is added to each input, which are of the order of 1
    decay : share of the weights that a step takes away, times its length
    """

    n_passes: int = 60
    step: float = 3e-3
    batch: int = 256
    noise: float = 0.5
    decay: float = 1e-4


Layers = list[np.ndarray]  # weights and offsets of the layers in turn


def descend(
    inputs: Callable[[np.random.Generator], np.ndarray], wanted: np.ndarray, told: np.ndarray,
    hidden: Sequence[int], settings: DescentSettings, seed: int, progress: Progress = SILENT,
    as_shares: bool = False,
) -> Perceptron:  # fmt: skip
    """Train a perceptron of ReLU layers by squared error; see `gradient` for ``as_shares``.

    inputs : called once a pass; float32, shape (n_samples, n_in), of the order of 1
    wanted, told : float32, shape (n_samples, n_out), and which of it counts (1 or 0)
    """
    rng = np.random.default_rng(seed)
    heard = inputs(rng)
    layers = started((heard.shape[1], *hidden, wanted.shape[1]), rng)
    means, squares = ([np.zeros_like(p) for p in layers] for _ in range(2))
    n_steps, t = settings.n_passes * -(-len(wanted) // settings.batch), 0
    for p in range(settings.n_passes):
        progress.step(p / settings.n_passes)
        heard = inputs(rng)
        order = rng.permutation(len(wanted))
        for first in range(0, len(order), settings.batch):
            rows = order[first : first + settings.batch]
            noise = rng.standard_normal((len(rows), heard.shape[1]), dtype=np.float32) * np.float32(settings.noise)
            slopes = gradient(layers, heard[rows] + noise, wanted[rows], told[rows], as_shares)
            step, t = settings.step * 0.5 * (1.0 + np.cos(np.pi * t / n_steps)), t + 1
            upright = np.sqrt(1.0 - _SQUARE_DECAY**t) / (1.0 - _MEAN_DECAY**t)
            for layer, slope, mean, square in zip(layers, slopes, means, squares):
                mean += np.float32(1.0 - _MEAN_DECAY) * (slope - mean)
                square += np.float32(1.0 - _SQUARE_DECAY) * (slope * slope - square)
                if layer.ndim == 2:
                    layer *= np.float32(1.0 - step * settings.decay)
                layer -= np.float32(step * upright) * mean / (np.sqrt(square) + np.float32(_TINY))
    return Perceptron.of_layers(layers[::2], layers[1::2], "relu")


def started(sizes: Sequence[int], rng: np.random.Generator) -> Layers:
    """Return layers to start from: He's spread for ReLU, a quieter last layer, no offsets."""
    layers: Layers = []
    for i, (n_in, n_out) in enumerate(pairwise(sizes)):
        spread = np.sqrt(2.0 / n_in) * (0.3 if i == len(sizes) - 2 else 1.0)
        layers += [rng.standard_normal((n_in, n_out), dtype=np.float32) * np.float32(spread),
                   np.zeros(n_out, np.float32)]  # fmt: skip
    return layers


def gradient(
    layers: Layers, inputs: np.ndarray, wanted: np.ndarray, told: np.ndarray, as_shares: bool = False
) -> Layers:
    """Return the slope of the mean over samples of ``Σ told (output - wanted)²`` by each weight and offset.

    as_shares : outputs are logarithms of shares, and the slope is that of ``-2 Σ wanted log(share)`` where all is told
    """
    values = [inputs]
    for weights, offsets in zip(layers[:-2:2], layers[1:-2:2]):
        values.append(np.maximum(values[-1] @ weights + offsets, 0.0))
    given = values[-1] @ layers[-2] + layers[-1]
    pulled = ((shares(given) if as_shares else given) - wanted) * told * (values[0].dtype.type(2.0) / len(inputs))
    slopes: Layers = []
    for i in range(len(values) - 1, -1, -1):
        slopes = [values[i].T @ pulled, pulled.sum(axis=0), *slopes]
        if i:
            pulled = (pulled @ layers[2 * i].T) * (values[i] > 0)
    return slopes
