"""A stand-in for a trained model: each frame is a fixed linear picture of the features around it."""

from __future__ import annotations

import numpy as np

from core.iface.speech_features import N_CEPSTRA, N_FEATURES


class LinearFace:
    """Hears one frame back and ``n_ahead`` ahead; each expression adds a shape of its own."""

    def __init__(self, rest: np.ndarray, n_ahead: int = 3, expressions=("happiness", "anger", "sadness"), seed=5):
        rng = np.random.default_rng(seed)
        self.neutral = np.asarray(rest, np.float32)
        self.expressions, self.n_ahead = tuple(expressions), n_ahead
        self.taps = 0.01 * rng.normal(size=(n_ahead + 2, N_CEPSTRA, self.neutral.size))
        self.shapes = {name: rng.normal(size=self.neutral.shape) for name in expressions}

    def motion(self, features, strengths):
        n, features = len(features), np.asarray(features)[:, :N_CEPSTRA]
        padded = np.concatenate([np.zeros((1, N_CEPSTRA)), features, np.zeros((self.n_ahead, N_CEPSTRA))])
        moved = sum(padded[tap : tap + n] @ self.taps[tap] for tap in range(len(self.taps)))
        moved = moved.reshape(n, *self.neutral.shape)
        for name, shape in self.shapes.items():
            moved = moved + np.broadcast_to(strengths.get(name, 0.0), n)[:, None, None] * shape
        return (self.neutral + moved).astype(np.float32)

    def stream(self):
        return _Stream(self)


class _Stream:
    def __init__(self, face):
        self._face, self._heard, self._n_given, self._last = face, [], 0, {}

    def accept(self, features, strengths):
        self._heard += list(features)
        self._last = strengths
        return self._due(len(self._heard) - self._face.n_ahead)

    def finish(self):
        return self._due(len(self._heard))

    def _due(self, stop):
        first, self._n_given = self._n_given, max(stop, self._n_given)
        whole = self._face.motion(np.array(self._heard).reshape(-1, N_FEATURES), self._last)
        return whole[first : self._n_given]
