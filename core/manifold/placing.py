"""Frames that came after a map was made are placed on it, and nothing that was there moves.

The geodesic of a new frame goes by its nearest old frames, as in the out-of-sample extension of Isomap (Bengio et al.
2004); from its distances to some old frames, the anchors, it is triangulated (de Silva and Tenenbaum 2002).
"""

from __future__ import annotations

import numpy as np
from scipy.sparse.csgraph import dijkstra

from core.manifold.isomap import PhonemeMap, delaunay_triangles, joined_neighbour_graph, landmark_mds
from core.progress import SILENT, Progress

N_NEIGHBORS = 12
N_ANCHORS = 400
MOST_CARRIERS = 4000
_DIMENSIONS = 8  # of the anchors' own scaling; the map's two lie among the first, in whatever order a subset gives them
_SEED = 2008


def place_frames(
    old: np.ndarray,
    places: np.ndarray,
    new: np.ndarray,
    n_neighbors: int = N_NEIGHBORS,
    n_anchors: int = N_ANCHORS,
    most_carriers: int = MOST_CARRIERS,
    progress: Progress = SILENT,
) -> np.ndarray:
    """Return where frames ``new`` lie on a map that was made of ``old``.

    Anchors are scaled anew, all frames are triangulated from them, and the affine map that carries the old frames from
    there to their ``places`` carries the new ones too. What it leaves over at the nearest old frames, weighted by
    1 / distance, is added, so that a frame that is captured again lands where it is. On a map of more than
    ``most_carriers`` frames as many, evenly spread, carry the new ones, with all that are nearest to one: a session
    that is added costs what it is, and not what the map is.

    old : shape (n_old, n_dims), at least one; places : shape (n_old, 2); new : shape (n_new, n_dims)
    returns : float64, shape (n_new, 2)
    """
    from sklearn.neighbors import NearestNeighbors

    old, places, new = (np.asarray(values, float) for values in (old, places, new))
    k = min(n_neighbors, len(old))
    distance, near = NearestNeighbors(n_neighbors=k).fit(old).kneighbors(new)
    if len(old) > most_carriers:
        spread = np.linspace(0, len(old) - 1, most_carriers).astype(int)
        carriers = np.union1d(spread, near)
        old, places, near = old[carriers], places[carriers], np.searchsorted(carriers, near)
    n = len(old)
    progress.step(0.2, "measuring geodesics")
    graph, _ = joined_neighbour_graph(old, min(n_neighbors, n - 1))
    anchors = np.arange(n)
    if n > n_anchors:
        anchors = np.sort(np.random.default_rng(_SEED).choice(n, n_anchors, replace=False))
    among_old = dijkstra(graph, indices=anchors)
    progress.step(0.8, "placing new frames")
    to_new = np.full((len(anchors), len(new)), np.inf)
    for j in range(k):
        np.minimum(to_new, among_old[:, near[:, j]] + distance[:, j], out=to_new)
    scaled = landmark_mds(np.concatenate([among_old, to_new], axis=1), anchors, min(_DIMENSIONS, len(anchors)))
    scaled = np.column_stack([scaled, np.ones(len(scaled))])
    carry, *_ = np.linalg.lstsq(scaled[:n], places, rcond=None)
    carried = scaled @ carry
    weight = 1.0 / distance.clip(1e-9)
    left_over = (places - carried[:n])[near]
    return carried[n:] + (weight[:, :, None] * left_over).sum(axis=1) / weight.sum(axis=1)[:, None]


def grow_map(
    old_map: PhonemeMap, kept: np.ndarray, rows: np.ndarray, is_new: np.ndarray, coefficients: np.ndarray,
    progress: Progress = SILENT,
) -> PhonemeMap:  # fmt: skip
    """Return a map with frames taken off and others placed on it; those that stay stay where they are.

    kept : int, places on ``old_map`` of the frames that stay, in the order in which they come in ``rows``
    rows : int64, shape (n,), rows of the database that it is for; is_new : bool, shape (n,)
    coefficients : shape (n, n_dims), the frames at ``rows``
    """
    coefficients = np.asarray(coefficients, float)
    embedding, linear = np.empty((len(rows), 2), np.float32), np.empty((len(rows), 2), np.float32)
    embedding[~is_new], linear[~is_new] = old_map.embedding[kept], old_map.pca[kept]
    if is_new.any():
        embedding[is_new] = place_frames(
            coefficients[~is_new], embedding[~is_new], coefficients[is_new], progress=progress
        )
        with_one = np.column_stack([coefficients, np.ones(len(rows))])
        axes, *_ = np.linalg.lstsq(with_one[~is_new], linear[~is_new], rcond=1e-9)
        linear[is_new] = with_one[is_new] @ axes
    unchanged = not is_new.any() and len(kept) == len(old_map.frames)
    triangles = old_map.triangles if unchanged else delaunay_triangles(embedding)
    return PhonemeMap(rows, embedding, linear, triangles, old_map.n_joined, old_map.n_landmarks,
                      old_map.residual_variance, old_map.n_placed + int(is_new.sum()))  # fmt: skip
