"""Motion units under an affine camera, fitted to noisy points (Hong, Wen and Huang 2002, equation 5, appendix A)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_STEPS = 60
_STILL = 1e-10  # relative fall of the error at which the minimum is reached


@dataclass(frozen=True)
class PosedUnits:
    """A face in the plane that motion units deform.

    base : float64, shape (n_points, 2), ``s̄ = s_0 + m_00 + m_k0``
    units : float64, shape (A, n_points, 2), utterance and expression units together
    """

    base: np.ndarray
    units: np.ndarray

    def shape(self, parameters: np.ndarray) -> np.ndarray:
        """Return s̄ + Σ c_i m_i, shape (n_points, 2)."""
        return self.base + np.tensordot(parameters, self.units, axes=1)


@dataclass(frozen=True)
class AffineFit:
    """Where the face is, and how it is deformed.

    parameters : float64, shape (A,), the MUPs C
    affine : float64, shape (2, 3), ``T_β`` as a matrix: ``[[β1 β2 β5] [β3 β4 β6]]``
    """

    parameters: np.ndarray
    affine: np.ndarray

    def points(self, face: PosedUnits) -> np.ndarray:
        """Return T_β of the deformed face, shape (n_points, 2), pixels."""
        return face.shape(self.parameters) @ self.affine[:, :2].T + self.affine[:, 2]


def too_few_points(face: PosedUnits, n_seen: int) -> bool:
    """Whether fewer points are seen than appendix A has unknowns for: 2N equations, 6 + 4A unknowns."""
    return n_seen < 3 + 2 * len(face.units)


def linear_start(face: PosedUnits, points: np.ndarray, weights: np.ndarray | None = None) -> AffineFit:
    """Appendix A: the affine and the MUPs by one linear system, exact on noise-free points.

    points : shape (n_points, 2), pixels; weights : shape (n_points,), 0 for a lost point

    Expanded, ``T_β (s̄ + Σ c_i m_i)`` is linear in ``v = [β1 β2 β5 β3 β4 β6 | ψ_1 … ψ_A]`` with ``ψ_i = c_i (β1 β2
    β3 β4)``. The solution is free where ψ_i must be parallel to β, so with noise it is a start only; see `refined`.
    Raises ValueError with too few points (`too_few_points`).
    """
    points, weights = _seen(points, weights)
    if too_few_points(face, int((weights > 0).sum())):
        raise ValueError("too few points for the linear start of appendix A")
    n_points, n_units = len(points), len(face.units)
    rows = np.zeros((n_points, 2, 6 + 4 * n_units))
    rows[:, 0, :2] = rows[:, 1, 3:5] = face.base
    rows[:, 0, 2] = rows[:, 1, 5] = 1.0
    for i, unit in enumerate(face.units):
        rows[:, 0, 6 + 4 * i : 8 + 4 * i] = rows[:, 1, 8 + 4 * i : 10 + 4 * i] = unit
    solved = _least_squares(rows.reshape(2 * n_points, -1), points.reshape(-1), np.repeat(weights, 2))
    linear = solved[[0, 1, 3, 4]]
    parameters = solved[6:].reshape(n_units, 4) @ linear / (linear @ linear)
    return AffineFit(parameters, np.array([solved[[0, 1, 2]], solved[[3, 4, 5]]]))


def refined(
    face: PosedUnits, points: np.ndarray, start: AffineFit, weights: np.ndarray | None = None,
    prior: np.ndarray | None = None,
) -> AffineFit:  # fmt: skip
    """Walk from ``start`` to the minimum of equation 5 by damped Gauss–Newton steps on all 6 + A unknowns.

    prior : shape (A,), precisions that pull every MUP towards 0 (its mean), in squared pixels; None as in the paper
    """
    points, weights = _seen(points, weights)
    root = np.sqrt(np.repeat(weights, 2))
    prior = np.zeros(len(face.units)) if prior is None else np.asarray(prior, float)

    def error(fit: AffineFit) -> float:
        left = (fit.points(face) - points).reshape(-1) * root
        return float(left @ left + prior @ fit.parameters**2)

    fit, now, damping = start, error(start), 1e-6
    for _ in range(_STEPS):
        left = (points - fit.points(face)).reshape(-1) * root
        jacobian = _jacobian(face, fit) * root[:, None]
        normal = jacobian.T @ jacobian
        right = jacobian.T @ left
        normal[np.arange(6, len(normal)), np.arange(6, len(normal))] += prior
        right[6:] -= prior * fit.parameters
        scale = np.diag(normal).clip(1e-12)
        while damping < 1e12:
            step = np.linalg.solve(normal + np.diag(damping * scale), right)
            tried = AffineFit(fit.parameters + step[6:], fit.affine + step[:6].reshape(2, 3))
            then = error(tried)
            if then <= now:
                break
            damping *= 10.0
        else:
            return fit
        fallen, fit, now, damping = now - then, tried, then, max(damping * 0.1, 1e-12)
        if fallen <= _STILL * now:
            return fit
    return fit


def _jacobian(face: PosedUnits, fit: AffineFit) -> np.ndarray:
    """Derivative of the points by (β1 β2 β5 β3 β4 β6 | c), shape (2 n_points, 6 + A)."""
    shape = face.shape(fit.parameters)
    jacobian = np.zeros((len(shape), 2, 6 + len(face.units)))
    jacobian[:, 0, :2] = jacobian[:, 1, 3:5] = shape
    jacobian[:, 0, 2] = jacobian[:, 1, 5] = 1.0
    jacobian[:, :, 6:] = np.einsum("ij,anj->nia", fit.affine[:, :2], face.units)
    return jacobian.reshape(2 * len(shape), -1)


def _seen(points: np.ndarray, weights: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights in which a lost point (NaN) counts for nothing."""
    seen = np.isfinite(points).all(axis=1)
    weights = seen.astype(float) if weights is None else np.where(seen, weights, 0.0)
    return np.where(seen[:, None], points, 0.0), weights


def _least_squares(matrix: np.ndarray, wanted: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Weighted, with scaled columns, by singular values."""
    used = weights > 0
    root = np.sqrt(weights[used])
    matrix = matrix[used] * root[:, None]
    scale = np.linalg.norm(matrix, axis=0)
    scale[scale == 0] = 1.0
    return np.linalg.lstsq(matrix / scale, wanted[used] * root, rcond=None)[0] / scale
