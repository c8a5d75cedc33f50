"""Distances between poses in which the lips count for more."""

from __future__ import annotations

import numpy as np

from core.motion.marker_set import MarkerSet
from core.motion.pca import MotionPca


def pose_metric(pca: MotionPca, markers: MarkerSet, lip_weight: float) -> np.ndarray:
    """Return L with ``|c L|² = Σ_k w_k |x_k|²`` for the marker positions x of coefficients c; (n_dims, n_dims).

    Markers of the group ``lips`` weigh ``lip_weight`` times the others; the weights' mean is 1, so that a distance
    keeps its scale. L is the Cholesky factor of ``Bᵀ W B``, B being the marker basis; with a weight of 1 (equations 8
    and 9 of Deng and Neumann 2008) it is the identity.
    """
    if not lip_weight > 0:
        raise ValueError(f"lips cannot weigh {lip_weight}")
    weights = np.ones(len(markers))
    weights[markers.group("lips")] = lip_weight
    weights /= weights.mean()
    basis = pca.basis.reshape(len(markers), 3, -1)
    return np.linalg.cholesky(np.einsum("k,kxi,kxj->ij", weights, basis, basis))
