"""Equations 14 and 15: how much every marker counts at every vertex of the skin."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix, diags

from core.face.geodesic import surface_distances

SIGMA = 0.45
REACH = 3.0
NEIGHBOURS = 6  # fewer see only the close row of a lip and leave steps between its columns
RESTING_WEIGHT = 0.05
GAP = 1.5  # width, in distances to the nearest marker, where markers are far
SMOOTHING = 0.15  # passes of smoothing for one edge length a marker spacing, squared
NEGLIGIBLE = 1e-3


def marker_weights(
    positions: np.ndarray, triangles: np.ndarray, markers: np.ndarray, sigma: float = SIGMA, reach: float = REACH
) -> csr_matrix:
    """Return the normalised weights of K markers at V vertices; sparse float64, shape (V, K), rows sum to 0..1.

        w_ki = exp(-MeshDist(k, i)² / (2 σ²)) · fade,  W_ik = w_ki / (RESTING_WEIGHT + Σ_k w_ki)

    (Deng and Neumann 2008, equations 14 and 15.) C cancels in equation 15; the resting weight takes its place, so
    that motion fades out past the last marker where, as printed, it would stop dead at the threshold.

    positions : shape (V, 3), mm; triangles : int, shape (T, 3), of the skin only; markers : int, shape (K,), vertices
    sigma : in units of the distance between neighbouring markers thereabouts; the paper's 1.5 is in the units of
        its own mesh and fits its 90 markers only
    reach : the threshold, in sigmas; the weight fades to zero over its last third
    """
    distance = surface_distances(positions, triangles, markers)
    spacing = local_spacing(distance, markers)
    near = distance / (sigma * _width(distance, spacing, markers))
    fade = np.clip((reach - near) / (reach / 3.0), 0.0, 1.0)
    raw = np.exp(-np.square(np.minimum(near, 40.0)) / 2.0) * fade * fade * (3.0 - 2.0 * fade)
    weights = csr_matrix((raw / (raw.sum(axis=0) + RESTING_WEIGHT)).T)
    return _smoothed(weights, positions, triangles, float(np.median(spacing[markers])))


def local_spacing(distance: np.ndarray, markers: np.ndarray) -> np.ndarray:
    """Return how far apart neighbouring markers are around every vertex, from distances (K, V); shape (V,)."""
    between = np.sort(np.where(np.eye(len(markers), dtype=bool), np.inf, distance[:, markers]), axis=1)
    nearest = between[:, : max(1, min(NEIGHBOURS, len(markers) - 1))]
    reachable = np.isfinite(nearest)
    known = reachable.any(axis=1)
    own = np.where(reachable, nearest, 0.0).sum(axis=1) / np.maximum(reachable.sum(axis=1), 1)
    # a marker alone on its piece of surface has no neighbours to go by: a third of the piece
    alone = np.where(np.isfinite(distance), distance, 0.0).max(axis=1) / 3.0
    own = np.maximum(np.where(known, own, alone), 1e-9)
    pull = 1.0 / np.square(np.square(distance) + np.square(0.1 * np.median(own)))
    total = pull.sum(axis=0)
    return np.where(total > 0, own @ pull / np.where(total > 0, total, 1.0), np.median(own))


def _width(distance: np.ndarray, spacing: np.ndarray, markers: np.ndarray) -> np.ndarray:
    """Widen the spacing in the gap between dense and sparse markers, such as lips and chin; shape (V,).

    There the spacing is still that of the lips, and the skin would hang back between two regions that both move.
    """
    gap = np.minimum(GAP * distance.min(axis=0), np.quantile(spacing[markers], 0.75))
    return (spacing**4 + gap**4) ** 0.25


def _smoothed(weights: csr_matrix, positions: np.ndarray, triangles: np.ndarray, spacing: float) -> csr_matrix:
    """Average the weights along the surface over a fifth of a marker spacing, which takes out the last creases."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    length = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1).astype(float)
    near_markers = np.asarray(weights.sum(axis=1)).ravel()[edges[:, 0]] > 0.5
    if not near_markers.any():
        return weights
    edge = float(np.median(length[near_markers]))
    closeness = 1.0 / np.maximum(length, 0.1 * edge)
    rows, columns = np.concatenate([edges, edges[:, ::-1]]).T
    around = csr_matrix((np.concatenate([closeness, closeness]), (rows, columns)), shape=(len(positions),) * 2)
    total = np.asarray(around.sum(axis=1)).ravel()
    mean = diags(1.0 / np.where(total > 0, total, 1.0)) @ around + diags((total == 0).astype(float))
    for _ in range(int(np.clip(round(SMOOTHING * (spacing / edge) ** 2), 0, 60))):
        weights = (weights + mean @ weights) * 0.5
        weights.data[weights.data < 0.1 * NEGLIGIBLE] = 0.0
        weights.eliminate_zeros()
    weights.data[weights.data < NEGLIGIBLE] = 0.0
    weights.eliminate_zeros()
    return csr_matrix(weights)
