"""Distance along the surface, so that the openings of mouth and eyes keep lips and lids apart."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree


def surface_distances(positions: np.ndarray, triangles: np.ndarray, sources: np.ndarray) -> np.ndarray:
    """Return MeshDist(k, i), the length of the shortest way along the surface (Deng and Neumann 2008, section 7.1).

    positions : shape (V, 3); triangles : int, shape (T, 3); sources : int, shape (K,), vertices
    returns : float64, shape (K, V), in the unit of ``positions``; inf where no way leads

    Computed by the heat method: the paper's sum of edge lengths is a fifth too long on a regular grid. Vertices
    that a file holds twice along a texture seam count as one (see `seam_partners`).
    """
    import potpourri3d

    sources = np.asarray(sources, int)
    same = seam_partners(positions, triangles)
    welded = same[triangles]
    solid = (welded[:, [0, 1, 2]] != welded[:, [1, 2, 0]]).all(axis=1) & (_areas(positions, welded) > 0)
    welded = welded[solid]
    piece = components(len(positions), welded)
    distances = np.full((len(sources), len(positions)), np.inf)
    distances[np.arange(len(sources)), same[sources]] = 0.0
    piece_of_triangle = piece[welded[:, 0]]
    for number in np.unique(piece[same[sources]]):
        part = welded[piece_of_triangle == number]
        if len(part) == 0:
            continue
        vertices, local = np.unique(part, return_inverse=True)
        solver = potpourri3d.MeshHeatMethodDistanceSolver(positions[vertices].astype(float), local.reshape(-1, 3))
        for k in np.flatnonzero(piece[same[sources]] == number):
            source = int(np.searchsorted(vertices, same[sources[k]]))
            straight = np.linalg.norm(positions[vertices].astype(float) - positions[vertices[source]], axis=1)
            # within an edge or two of the source the heat method falls short, and no way is shorter than straight
            distances[k, vertices] = np.maximum(solver.compute_distance(source), straight)
    return distances[:, same]


def components(count: int, triangles: np.ndarray) -> np.ndarray:
    """Return the number of the connected piece that each of ``count`` vertices belongs to; int, shape (count,)."""
    edges = np.concatenate([triangles[:, :2], triangles[:, 1:]])
    graph = coo_matrix((np.ones(len(edges), bool), (edges[:, 0], edges[:, 1])), shape=(count, count))
    return connected_components(graph, directed=False)[1]


def seam_partners(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return for every vertex the first vertex at the same place on the same sheet of surface; int, shape (V,).

    glTF and PLY store one texture coordinate a vertex and so tear a surface along its texture seams. Lips that
    touch are also at one place, but look in opposite directions: those stay apart.
    """
    same = np.arange(len(positions))
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    rim = np.unique(unique[uses == 1])
    if len(rim) == 0:
        return same
    normals = _normals(positions, triangles)
    size = float(np.ptp(positions, axis=0).max())
    pairs = cKDTree(positions[rim]).query_pairs(1e-6 * size, output_type="ndarray")
    a, b = rim[pairs].T if len(pairs) else np.zeros((2, 0), int)
    alike = (normals[a] * normals[b]).sum(axis=1) > 0
    for first, second in sorted(zip(np.minimum(a, b)[alike].tolist(), np.maximum(a, b)[alike].tolist())):
        same[second] = same[first]
    return same


def _normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = positions[triangles].astype(float).transpose(1, 0, 2)
    face_normals = np.cross(b - a, c - a)
    normals = np.zeros((len(positions), 3))
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], face_normals)
    return normals


def _areas(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = positions[triangles].astype(float).transpose(1, 0, 2)
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
