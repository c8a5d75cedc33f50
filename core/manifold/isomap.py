"""Phoneme-Isomaps: two-dimensional maps of all captured frames of one phoneme.

Deng and Neumann 2008, section 4; Tenenbaum, de Silva and Langford 2000; landmarks after de Silva and Tenenbaum 2002.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.sparse.linalg import eigsh
from scipy.spatial import Delaunay, QhullError

from core.progress import SILENT, Progress

_DISTANCES_AT_ONCE = 10_000_000


class PhonemeIsomap:
    """Isomap of the frames of one phoneme cluster.

    n_neighbors : neighbours that a frame is joined to; the paper's 12
    n_components : dimensions of the map
    landmark_above : clusters with more frames than this use landmark Isomap
    n_landmarks : landmarks then
    seed : choice of the landmarks

    After `fit`: ``embedding_`` float64, shape (n_frames, n_components); ``n_joined_``, edges that were added because
    the neighbour graph fell apart (captures at a high rate often have all their neighbours in their own node);
    ``n_landmarks_``, 0 for the full method; ``residual_variance_``, 1 - r² between geodesic and map distances.
    """

    def __init__(
        self,
        n_neighbors: int = 12,
        n_components: int = 2,
        landmark_above: int = 4000,
        n_landmarks: int = 800,
        seed: int = 2008,
    ) -> None:
        self.n_neighbors = n_neighbors
        self.n_components = n_components
        self.landmark_above = landmark_above
        self.n_landmarks = n_landmarks
        self.seed = seed

    def fit(self, frames: np.ndarray, progress: Progress = SILENT) -> PhonemeIsomap:
        """Embed ``frames``, shape (n_frames, n_dims); raises `ValueError` when there is none."""
        frames = np.asarray(frames, float)
        n = len(frames)
        if n == 0:
            raise ValueError("a map needs at least one frame")
        graph, self.n_joined_ = joined_neighbour_graph(frames, min(self.n_neighbors, n - 1))
        progress.step(0.2, "measuring geodesics")
        if n > self.landmark_above:
            landmarks = np.sort(np.random.default_rng(self.seed).choice(n, self.n_landmarks, replace=False))
        else:
            landmarks = np.arange(n)
        self.n_landmarks_ = len(landmarks) if len(landmarks) < n else 0
        rows = []
        for first in range(0, len(landmarks), 200):  # in pieces, so that a cancel is heard
            # the graph holds each edge both ways, and one-way search is a third faster
            rows.append(dijkstra(graph, indices=landmarks[first : first + 200]))
            progress.step(0.2 + 0.6 * first / len(landmarks), "measuring geodesics")
        geodesics = np.concatenate(rows)
        self.embedding_ = landmark_mds(geodesics, landmarks, self.n_components)
        self.residual_variance_ = _residual_variance(geodesics, self.embedding_, landmarks)
        return self


def joined_neighbour_graph(frames: np.ndarray, n_neighbors: int) -> tuple[csr_matrix, int]:
    """Return the neighbour graph of ``frames``, made whole, and the number of edges that this took.

    Edges carry Euclidean distances. Components are joined by a shortest spanning tree of them (Borůvka's method: in
    each round every component but the largest takes its shortest edge to another one).
    """
    from sklearn.neighbors import NearestNeighbors

    n = len(frames)
    if n_neighbors < 1:
        return csr_matrix((n, n)), 0
    distance, index = NearestNeighbors(n_neighbors=n_neighbors).fit(frames).kneighbors()
    source = np.repeat(np.arange(n), n_neighbors)
    # a sparse graph forgets edges of length zero; equal frames stay neighbours at a negligible distance
    graph = coo_matrix((distance.ravel().clip(1e-9), (source, index.ravel())), shape=(n, n)).tocsr()
    graph = graph.maximum(graph.T)
    joined = 0
    while True:
        n_parts, part = connected_components(graph, directed=False)
        if n_parts == 1:
            return graph, joined
        bridges = _shortest_bridges(frames, part, n_parts)
        added = np.array(sorted(bridges)).reshape(-1, 3)
        joined += len(added)
        i, j, length = added[:, 0].astype(int), added[:, 1].astype(int), added[:, 2].clip(1e-9)
        bridge = coo_matrix((length, (i, j)), shape=(n, n)).tocsr()
        graph = graph.maximum(bridge.maximum(bridge.T))


def _shortest_bridges(frames: np.ndarray, part: np.ndarray, n_parts: int) -> set[tuple[int, int, float]]:
    """One edge for each component but the largest: its shortest to a frame outside, as (lower row, higher row, length).

    The largest is left out because it alone may hold nearly all frames; whatever joins it, the others find.
    """
    squares = (frames**2).sum(axis=1)
    largest = np.bincount(part).argmax()
    rows = np.flatnonzero(part != largest)
    best = np.full(n_parts, np.inf)
    edge = np.zeros((n_parts, 2), int)
    at_once = max(1, _DISTANCES_AT_ONCE // len(frames))
    for first in range(0, len(rows), at_once):
        block = rows[first : first + at_once]
        distance = squares[block, None] + squares[None] - 2 * frames[block] @ frames.T
        distance[part[block, None] == part[None]] = np.inf
        nearest = distance.argmin(axis=1)
        shortest = distance[np.arange(len(nearest)), nearest]
        for i in np.argsort(shortest, kind="stable"):
            own = part[block[i]]
            if shortest[i] < best[own]:
                best[own] = shortest[i]
                edge[own] = sorted((block[i], nearest[i]))
    edge = np.delete(edge, largest, axis=0)
    lengths = np.linalg.norm(frames[edge[:, 0]] - frames[edge[:, 1]], axis=1)
    return {(int(i), int(j), float(length)) for (i, j), length in zip(edge, lengths)}


def landmark_mds(geodesics: np.ndarray, landmarks: np.ndarray, n_components: int) -> np.ndarray:
    """Classical scaling of the landmarks, and every other point placed by its distances to them.

    de Silva and Tenenbaum 2002: x = -½ L# (δ - μ), δ a point's squared distances to the landmarks, μ their mean among
    the landmarks, L# the eigenvectors of the centred matrix over the roots of their eigenvalues.

    geodesics : shape (n_landmarks, n), from each landmark to all points; landmarks : int, shape (n_landmarks,)
    returns : float64, shape (n, n_components); 0 in dimensions that the distances do not span
    """
    n_landmarks, n = geodesics.shape
    squared = geodesics**2
    among = squared[:, landmarks]
    mean = among.mean(axis=0)
    centred = -0.5 * (among - mean[None] - mean[:, None] + mean.mean())
    if n_landmarks < 100 or not centred.any():  # Lanczos wants room, and something to work on
        values, vectors = np.linalg.eigh(centred)
        values, vectors = values[::-1][:n_components], vectors[:, ::-1][:, :n_components]
    else:
        start = np.random.default_rng(0).normal(size=n_landmarks)  # fixed, so that equal data give an equal map
        values, vectors = eigsh(centred, k=n_components, which="LA", v0=start)
        values, vectors = values[::-1], vectors[:, ::-1]
    embedding = np.zeros((n, n_components))
    real = values > max(values.max(initial=0.0), 0.0) * 1e-12
    vectors = vectors * np.sign(vectors[np.abs(vectors).argmax(axis=0), np.arange(vectors.shape[1])])
    placing = vectors[:, real] / np.sqrt(values[real])
    embedding[:, np.flatnonzero(real)] = -0.5 * (squared.T @ placing - mean @ placing)
    return embedding


def _residual_variance(geodesics: np.ndarray, embedding: np.ndarray, landmarks: np.ndarray) -> float:
    """1 - r² of geodesic against map distance, over at most 200 landmarks and all frames."""
    some = np.linspace(0, len(landmarks) - 1, min(200, len(landmarks))).astype(int)
    flat = np.linalg.norm(embedding[landmarks[some], None] - embedding[None], axis=2).ravel()
    true = geodesics[some].ravel()
    if flat.std() == 0 or true.std() == 0:
        return 0.0
    return float(1.0 - np.corrcoef(flat, true)[0, 1] ** 2)


def geodesic_residual(frames: np.ndarray, embedding: np.ndarray, n_neighbors: int = 12) -> float:
    """Return 1 - r² of geodesic against map distance, over 200 frames and all others, of a map made in any way."""
    frames = np.asarray(frames, float)
    graph, _ = joined_neighbour_graph(frames, min(n_neighbors, len(frames) - 1))
    some = np.linspace(0, len(frames) - 1, min(200, len(frames))).astype(int)
    return _residual_variance(dijkstra(graph, indices=some), embedding, some)


@dataclass(frozen=True)
class PhonemeMap:
    """The stored map of one phoneme cluster, ready to be shown and picked.

    frames : int64, shape (n,), rows of the database's frames
    embedding : float32, shape (n, 2), Isomap; pca : float32, shape (n, 2), the linear map kept for comparison
    triangles : int32, shape (n_triangles, 3), Delaunay triangles over ``embedding``
    n_joined, n_landmarks, residual_variance : as in `PhonemeIsomap`, when the map was made
    n_placed : frames that came later and were placed on the finished map (see `core.manifold.placing`)
    """

    frames: np.ndarray
    embedding: np.ndarray
    pca: np.ndarray
    triangles: np.ndarray
    n_joined: int
    n_landmarks: int
    residual_variance: float
    n_placed: int = 0

    @classmethod
    def make(cls, rows: np.ndarray, coefficients: np.ndarray, progress: Progress = SILENT) -> PhonemeMap:
        """Embed and triangulate the frames at ``rows`` with ``coefficients``, shape (n, n_dims)."""
        isomap = PhonemeIsomap().fit(coefficients, progress)
        centred = coefficients - coefficients.mean(axis=0)
        linear = np.zeros((len(rows), 2), np.float32)
        _, _, axes = np.linalg.svd(centred, full_matrices=False)
        shown = min(2, len(axes))
        linear[:, :shown] = centred @ axes[:shown].T
        embedding = isomap.embedding_.astype(np.float32)
        return cls(rows, embedding, linear, delaunay_triangles(embedding), isomap.n_joined_, isomap.n_landmarks_,
                   isomap.residual_variance_)  # fmt: skip

    def summary(self) -> dict[str, object]:
        """Return counts and quality for `efase info`."""
        return {"frames": len(self.frames), "joined": self.n_joined, "landmarks": self.n_landmarks,
                "residual_variance": round(self.residual_variance, 4), "placed": self.n_placed}  # fmt: skip

    def write(self, group) -> None:
        """Store into an HDF5 group."""
        for name in ("frames", "embedding", "pca", "triangles"):
            group.create_dataset(name, data=getattr(self, name))
        group.attrs.update(n_joined=self.n_joined, n_landmarks=self.n_landmarks, residual=self.residual_variance,
                           n_placed=self.n_placed)  # fmt: skip


def delaunay_triangles(points: np.ndarray) -> np.ndarray:
    """Return Delaunay triangles of ``points``, shape (n, 2), as int32 (t, 3); none for fewer than 3 or on a line."""
    if len(points) < 3:
        return np.zeros((0, 3), np.int32)
    try:
        return Delaunay(np.asarray(points, float)).simplices.astype(np.int32)
    except QhullError:
        return np.zeros((0, 3), np.int32)
