"""Perceptrons as they run: weights in float32, standardisation folded into them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ACTIVATIONS = {"relu": lambda x: np.maximum(x, 0.0), "tanh": np.tanh}


@dataclass(frozen=True, eq=False)
class Perceptron:
    """Layers of units; the last one is linear.

    weights : one a layer, float32, shape (n_in, n_out)
    offsets : one a layer, float32, shape (n_out,)
    activation : of the hidden layers, ``relu`` or ``tanh``
    """

    weights: tuple[np.ndarray, ...]
    offsets: tuple[np.ndarray, ...]
    activation: str = "relu"

    def __call__(self, inputs: np.ndarray) -> np.ndarray:
        """Return the outputs for ``inputs``, shape (n, n_in); float32, shape (n, n_out)."""
        active, values = ACTIVATIONS[self.activation], inputs
        for weights, offsets in zip(self.weights[:-1], self.offsets[:-1]):
            values = active(values @ weights + offsets)
        return values @ self.weights[-1] + self.offsets[-1]

    @property
    def n_inputs(self) -> int:
        """How many inputs it has."""
        return len(self.weights[0])

    @property
    def n_outputs(self) -> int:
        """How many outputs it has."""
        return len(self.offsets[-1])

    @classmethod
    def of_sklearn(cls, net: object) -> Perceptron:
        """Take over a trained `sklearn.neural_network.MLPRegressor`."""
        return cls.of_layers(net.coefs_, net.intercepts_, net.activation)

    @classmethod
    def of_layers(cls, weights: list[np.ndarray], offsets: list[np.ndarray], activation: str) -> Perceptron:
        """Keep layers of any floats as float32."""
        return cls(
            tuple(np.asarray(w, np.float32) for w in weights), tuple(np.asarray(b, np.float32) for b in offsets),
            activation,
        )  # fmt: skip

    def taking(self, mean: np.ndarray, scale: np.ndarray) -> Perceptron:
        """Return the perceptron of raw inputs x, when this one takes ``(x - mean) / scale``."""
        first = self.weights[0] / np.asarray(scale, float)[:, None]
        offset = self.offsets[0] - np.asarray(mean, float) @ first
        return self.of_layers([first, *self.weights[1:]], [offset, *self.offsets[1:]], self.activation)

    def giving(self, mean: np.ndarray, mixing: np.ndarray) -> Perceptron:
        """Return the perceptron of raw outputs ``y @ mixing + mean``, when this one gives y."""
        mixing = np.asarray(mixing, float)
        last, offset = self.weights[-1] @ mixing, self.offsets[-1] @ mixing + mean
        return self.of_layers([*self.weights[:-1], last], [*self.offsets[:-1], offset], self.activation)
