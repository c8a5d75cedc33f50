"""One control group at given widths: its coefficients (E-step), and where its widths should go (M-step)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csr_matrix

from core.animeme.design import Scene
from core.animeme.levels import N_PHONEMES

_DENSE_COLUMNS = 500  # up to here a dense product is quicker than one of sparse matrices


@dataclass(frozen=True, eq=False)
class Solved:
    """Coefficients that are best for some widths, and how good that is.

    loss : sum of squared residuals, with emphasis, plus what the ridge asks
    coefficients : float64, shape (n_columns, U)
    fitted, residual : float64, shape (n_frames, U); the residual times the root of the emphasis
    design : rows are frames, times the same
    """

    loss: float
    coefficients: np.ndarray
    fitted: np.ndarray
    residual: np.ndarray
    design: np.ndarray | csr_matrix
    factor: tuple


class Regression:
    """Fit controls that share their widths; ``targets`` everywhere: float64, shape (n_frames, U), about unit variance.

    scene : the sentences over their frames
    shared : see `core.animeme.levels.sharing`; its columns with data only
    ridge : shape (n_columns,), frames
    emphasis : float64, shape (n_frames,), what a squared residual counts in each frame
    """

    def __init__(self, scene: Scene, shared: csr_matrix, ridge: np.ndarray, emphasis: np.ndarray) -> None:
        self.scene, self.shared, self.ridge = scene, shared, ridge
        self._root = np.sqrt(emphasis)[:, None]
        self.said = np.unique(scene.utterances.phoneme)
        self._row = np.full(N_PHONEMES, -1)
        self._row[self.said] = np.arange(len(self.said))

    def solve(self, widths: np.ndarray, targets: np.ndarray) -> Solved:
        """E-step: the normal equations of equation 4, summed over occurrences (equation 6), with the ridge."""
        design = (self.scene.matrix(self.scene.weights(widths)) @ self.shared).multiply(self._root).tocsr()
        if design.shape[1] <= _DENSE_COLUMNS:
            design = design.toarray()
        normal = design.T @ design
        normal = normal if isinstance(normal, np.ndarray) else normal.toarray()
        # the floor keeps a model without a ridge solvable where two columns cannot be told apart
        normal[np.diag_indices_from(normal)] += self.ridge + 1e-10 * max(1.0, normal.diagonal().max(initial=0.0))
        factor = cho_factor(normal, overwrite_a=True)
        coefficients = cho_solve(factor, design.T @ (self._root * targets))
        residual = self._root * targets - design @ coefficients
        fitted = targets - residual / self._root
        loss = float((residual**2).sum() + (self.ridge[:, None] * coefficients**2).sum())
        return Solved(loss, coefficients, fitted, residual, design, factor)

    def loss(self, widths: np.ndarray, targets: np.ndarray, coefficients: np.ndarray) -> float:
        """Return what `solve` makes least, for coefficients that stay as they are."""
        said = self.scene.matrix(self.scene.weights(widths)) @ (self.shared @ coefficients)
        residual = self._root * (targets - said)
        return float((residual**2).sum() + (self.ridge[:, None] * coefficients**2).sum())

    def curvature(self, widths: np.ndarray, solved: Solved, is_projected: bool) -> tuple[np.ndarray, np.ndarray]:
        """JᵀJ and Jᵀr of equation 9 by the logarithms of σ1 and σ2 of the phonemes that are said.

        is_projected : let the coefficients follow the widths (variable projection; Golub and Pereyra 1973, in Kaufman's
            form): J loses what the coefficients could make up for, and a step is that of both together. Otherwise they
            stay as they are, as in the paper
        returns : shapes (2 n_said, 2 n_said) and (2 n_said,), σ1 of all before σ2 of all
        """
        scene, n_said = self.scene, len(self.said)
        weights, n_widths = scene.weights(widths), 2 * n_said
        by_keep, by_reach = scene.slopes(widths)
        seen = scene.seen(weights)
        frame, row = scene.nearby.frame[seen], self._row[scene.phoneme[seen]]
        place = np.concatenate([frame * n_widths + row, frame * n_widths + n_said + row])
        shapes = scene.shapes(self.shared @ solved.coefficients)[seen]
        if weights.total is not None:  # d(ΣDA/ΣD) = dD (A − C)/ΣD
            shapes = (shapes - solved.fitted[frame]) / weights.total[frame, None]
        squared, slope = np.zeros((n_widths, n_widths)), np.zeros(n_widths)
        by_width = np.concatenate([by_keep[seen], by_reach[seen]])
        for u in range(solved.residual.shape[1]):
            one = shapes[:, u]
            jacobian = np.bincount(place, by_width * np.concatenate([one, one]), scene.n_frames * n_widths)
            jacobian = jacobian.reshape(scene.n_frames, n_widths) * self._root
            squared += jacobian.T @ jacobian
            slope += jacobian.T @ solved.residual[:, u]
            if is_projected:
                mixed = solved.design.T @ jacobian
                squared -= mixed.T @ cho_solve(solved.factor, mixed)
        return squared, slope
