"""The linear space of face poses: packed marker positions to a few coefficients and back."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits


@dataclass(frozen=True)
class MotionPca:
    """Principal components of marker poses (Deng and Neumann 2008, section 3 and equation 11).

    mean : float64, shape (3 n_markers,), millimetres
    basis : float64, shape (3 n_markers, n_dims), orthonormal columns, largest variance first (the paper's EigMx)
    variance : float64, shape (n_dims,), mm²
    coverage : share (0..1) of the variance that the kept components carry
    """

    mean: np.ndarray
    basis: np.ndarray
    variance: np.ndarray
    coverage: float

    @property
    def n_dims(self) -> int:
        """Number of kept components."""
        return self.basis.shape[1]

    def coefficients(self, positions: np.ndarray) -> np.ndarray:
        """Project poses, shape (..., n_markers, 3) in mm, to coefficients, shape (..., n_dims)."""
        packed = np.reshape(positions, (*np.shape(positions)[:-2], -1))
        return (packed - self.mean) @ self.basis

    def positions(self, coefficients: np.ndarray) -> np.ndarray:
        """MrkMotion = MeanMotion + EigMx · PcaCoef (equation 11); shape (..., n_markers, 3), mm."""
        packed = self.mean + np.asarray(coefficients, float) @ self.basis.T
        return packed.reshape(*packed.shape[:-1], -1, 3)

    @classmethod
    def fit(cls, poses: Iterable[np.ndarray], n_dims: int = 25) -> MotionPca:
        """Fit to ``poses``, an iterable of arrays of shape (n_frames, n_markers, 3), one pass, constant memory.

        Fewer than ``n_dims`` components are kept when the poses do not span that many.
        """
        # on more threads the last bits depend on how many, and with them the content hash of a database
        with threadpool_limits(1):
            return cls._fitted(poses, n_dims)

    @classmethod
    def _fitted(cls, poses: Iterable[np.ndarray], n_dims: int) -> MotionPca:
        total, moment, count, shift = 0.0, 0.0, 0, None
        for block in poses:
            packed = np.asarray(block, float).reshape(len(block), -1)
            if shift is None and len(packed):
                shift = packed[0].copy()  # near the mean, so that the moment sums lose no digits
            centred = packed - shift
            total = total + centred.sum(axis=0)
            moment = moment + centred.T @ centred
            count += len(packed)
        if count < 2:
            raise ValueError("principal components need at least two poses")
        offset = total / count
        covariance = moment / count - np.outer(offset, offset)
        variance, vectors = np.linalg.eigh(covariance)
        variance, vectors = variance[::-1].clip(0.0), vectors[:, ::-1]
        kept = min(n_dims, int((variance > variance[0] * 1e-12).sum()))
        basis = vectors[:, :kept]
        # a component's sign is free; fixed here so that equal data give equal bytes
        basis = basis * np.sign(basis[np.abs(basis).argmax(axis=0), np.arange(kept)])
        coverage = float(variance[:kept].sum() / variance.sum())
        return cls(shift + offset, basis, variance[:kept], coverage)
