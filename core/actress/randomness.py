"""Variation that is the same on every machine and every day."""

from __future__ import annotations

import hashlib

import numpy as np
from scipy.special import ndtri


class Chance:
    """A stream of variation that depends on its name alone.

    Everything is drawn from uniform PCG64 numbers, the one stream that numpy keeps the same from version to version.
    """

    def __init__(self, name: str) -> None:
        seed = int.from_bytes(hashlib.sha256(name.encode("utf-8")).digest()[:16], "big")
        self._uniform = np.random.Generator(np.random.PCG64(seed))

    def between(self, low: float, high: float) -> float:
        """Return one number in ``low``..``high``."""
        return low + (high - low) * float(self._uniform.random())

    def normal(self, *shape: int) -> np.ndarray:
        """Return standard normal numbers, float64."""
        return ndtri(np.clip(self._uniform.random(shape), 1e-12, 1 - 1e-12))

    def below(self, n: int) -> int:
        """Return one of 0..n-1."""
        return min(int(self._uniform.random() * n), n - 1)

    def drift(self, times_s: np.ndarray, slowest_hz: float, fastest_hz: float, waves: int = 4) -> np.ndarray:
        """Return a slow wandering of unit variance, smooth in all derivatives: a sum of sines; shape of ``times_s``."""
        total = np.zeros(len(times_s))
        for _ in range(waves):
            rate_hz, phase = self.between(slowest_hz, fastest_hz), self.between(0, 2 * np.pi)
            total += np.sin(2 * np.pi * rate_hz * times_s + phase)
        return total * np.sqrt(2 / waves)
