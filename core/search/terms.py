"""The terms of the search's cost function, for all pairs of motion nodes at once.

Deng and Neumann 2008, section 6.2, tables 1 and 2, equations 5 to 9.

The marker basis is orthonormal, so a distance between poses is a distance between their PCA coefficients, and every
pairwise term is a matrix product: nothing here loops over pairs of nodes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from core.motion.node import NIL, NodeTable
from core.search.weights import SearchWeights
from core.speech.phoneme import PAU, PHONEME_INDEX, VISEME_OF_PHONEME

_SAMPLED_NODES = 500
_PRODUCT_ROUNDING = 1e-6  # relative; a distance by a matrix product, and the float32 that costs are held in


@dataclass(frozen=True)
class TransitionBlock:
    """Weight-independent transition terms from some nodes n into the nodes m of one block.

    targets : int, shape (n_block,), the rows m
    position_gap, velocity_gap, smoothing : float64, shape (n_block, n_sources); mm², (mm/s)², mm²/s³
    viseme_differs : bool, same shape; viseme(n) is not viseme(pre(m))
    """

    targets: np.ndarray
    position_gap: np.ndarray
    velocity_gap: np.ndarray
    smoothing: np.ndarray
    viseme_differs: np.ndarray


class TransitionTerms:
    """PGap, VGap and DSC between all motion nodes of a database.

    frames : shape (n_frames, n_dims), PCA coefficients in mm
    nodes : the motion nodes; velocities are central differences within the captured sentence
    """

    def __init__(self, frames: np.ndarray, nodes: NodeTable, rate_hz: float) -> None:
        self.nodes = nodes
        self.rate_hz = rate_hz
        self.frames = frames
        frames = np.asarray(frames, float)
        last = nodes.stop - 1
        self._first_pose, self._last_pose = frames[nodes.start], frames[last]
        self._first_velocity = self._velocity(frames, nodes.start)
        self._last_velocity = self._velocity(frames, last)
        self._viseme = nodes.viseme

    def _velocity(self, frames: np.ndarray, at: np.ndarray) -> np.ndarray:
        """mm/s at the frames ``at``; one-sided at the ends of a sentence."""
        sentence_of_node = self.nodes.sentence
        n_sentences = len(self.nodes.sentence_names)
        first = np.full(n_sentences, np.iinfo(np.int64).max)
        stop = np.zeros(n_sentences, np.int64)
        np.minimum.at(first, sentence_of_node, self.nodes.start)
        np.maximum.at(stop, sentence_of_node, self.nodes.stop)
        before = np.maximum(at - 1, first[sentence_of_node])
        after = np.minimum(at + 1, stop[sentence_of_node] - 1)
        span_s = np.maximum(after - before, 1) / self.rate_hz
        return (frames[after] - frames[before]) / span_s[:, None]

    def blocks(
        self, targets: np.ndarray | None = None, sources: np.ndarray | None = None, most_bytes: int = 64 << 20
    ) -> Iterator[TransitionBlock]:
        """Yield the terms from ``sources`` (default all) into ``targets`` (default all with a predecessor).

        Targets are grouped by the length of their predecessor; a block's largest matrix stays near ``most_bytes``.
        """
        pre = self.nodes.pre
        everyone = np.arange(len(self.nodes))
        targets = everyone if targets is None else targets
        n = everyone if sources is None else sources
        targets = targets[pre[targets] != NIL]
        lengths = np.maximum(self.nodes.n_frames[pre[targets]], 3)
        most_rows = max(1, most_bytes // (8 * len(n)))
        poses = self._by_length(n)
        for length in np.unique(lengths):
            of_length = targets[lengths == length]
            fading_out = self._curvature_of_warped(poses, int(length), fading_out=True)
            for first in range(0, len(of_length), most_rows):
                m = of_length[first : first + most_rows]
                fading_in = self._curvature_of_warped(self._by_length(pre[m]), int(length), fading_out=False)
                yield TransitionBlock(
                    m,
                    _squared_distances(self._first_pose[m], self._last_pose[n]),
                    _squared_distances(self._first_velocity[m], self._last_velocity[n]),
                    _squared_distances(fading_in, -fading_out),
                    self._viseme[pre[m]][:, None] != self._viseme[n][None],
                )

    def costs(self, targets: np.ndarray, sources: np.ndarray, weights: SearchWeights) -> np.ndarray:
        """TC of table 1 for a block of pairs, computed on the spot; float32, shape (n_targets, n_sources)."""
        pre = self.nodes.pre[targets]
        block = np.full((len(targets), len(sources)), weights.alpha1 * weights.pnt, np.float32)
        length_of = np.where(pre == NIL, 0, np.maximum(self.nodes.n_frames[pre], 3))
        root = np.sqrt(weights.alpha3)
        leaving = np.concatenate([self._last_pose[sources] * root, self._last_velocity[sources]], axis=1)
        poses = self._by_length(sources)
        for length in np.unique(length_of[pre != NIL]):
            where = np.flatnonzero(length_of == length)
            m = targets[where]
            out = self._curvature_of_warped(poses, int(length), fading_out=True)
            into = self._curvature_of_warped(self._by_length(pre[where]), int(length), fading_out=False)
            cost = weights.alpha2 * _squared_distances(into, -out)
            arriving = np.concatenate([self._first_pose[m] * root, self._first_velocity[m]], axis=1)
            cost += _squared_distances(arriving, leaving)
            cost += weights.pnt * (self._viseme[pre[where]][:, None] != self._viseme[sources][None])
            block[where] = cost
        block[pre[:, None] == sources[None]] = 0.0
        return block

    def least_costs(self, targets: np.ndarray, sources: np.ndarray, weights: SearchWeights) -> np.ndarray:
        """Return costs that TC of table 1 cannot fall below, cheaply: without DSC.

        float64, shape (n_targets, n_sources)
        """
        pre = self.nodes.pre[targets]
        root = np.sqrt(weights.alpha3)
        arriving = np.concatenate([self._first_pose[targets] * root, self._first_velocity[targets]], axis=1)
        leaving = np.concatenate([self._last_pose[sources] * root, self._last_velocity[sources]], axis=1)
        bound = _squared_distances(arriving, leaving)
        bound += weights.pnt * (self._viseme[pre][:, None] != self._viseme[sources][None])
        bound[pre == NIL] = weights.alpha1 * weights.pnt
        bound *= 1.0 - _PRODUCT_ROUNDING
        bound[pre[:, None] == sources[None]] = 0.0
        return bound

    def of_pair(self, source: int, target: int) -> tuple[float, float, float, bool]:
        """Return PGap, VGap, DSC and whether the visemes differ, of one pair; ``target`` has a predecessor."""
        (block,) = self.blocks(np.array([target]), sources=np.array([source]))
        return (float(block.position_gap[0, 0]), float(block.velocity_gap[0, 0]), float(block.smoothing[0, 0]),
                bool(block.viseme_differs[0, 0]))  # fmt: skip

    def _curvature_of_warped(
        self, poses: list[tuple[np.ndarray, np.ndarray]], length: int, fading_out: bool
    ) -> np.ndarray:
        """Second derivative of nodes warped to ``length`` frames and faded, as one vector a node.

        DSC (equation 6) of nodes a and b is the squared length of the sum of a's vector, fading out, and b's, fading
        in, since the blend, the warp and the derivative are linear: so it is the squared distance of one to minus the
        other. t in seconds; the integral is a sum over frames.

        poses : the nodes, as `_by_length` groups them
        returns : float64, shape (n_rows, (length - 2) * n_dims)
        """
        n_dims = self.frames.shape[1]
        vectors = np.empty((sum(len(where) for where, _ in poses), length - 2, n_dims))
        for where, captured in poses:
            bent = (_bending(len(captured), length, fading_out) * self.rate_hz**1.5) @ captured
            vectors[where] = bent.reshape(length - 2, len(where), n_dims).swapaxes(0, 1)
        return vectors.reshape(len(vectors), -1)

    def _by_length(self, rows: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Group nodes by their number of frames: places in ``rows``; float64, shape (n_frames, n_places * n_dims)."""
        own = self.nodes.n_frames[rows]
        groups = []
        for n_own in np.unique(own):
            where = np.flatnonzero(own == n_own)
            span = self.nodes.start[rows[where]] + np.arange(n_own)[:, None]
            groups.append((where, np.asarray(self.frames[span], float).reshape(n_own, -1)))
        return groups


@lru_cache(maxsize=8192)
def _bending(n_frames: int, length: int, fading_out: bool) -> np.ndarray:
    """Warp, fade and second difference as one matrix; float64, shape (length - 2, n_frames)."""
    second_difference = np.zeros((length - 2, length))
    inner = np.arange(length - 2)
    second_difference[inner, inner] = second_difference[inner, inner + 2] = 1.0
    second_difference[inner, inner + 1] = -2.0
    ramp = np.linspace(1.0, 0.0, length)
    return second_difference * (ramp if fading_out else 1.0 - ramp) @ warp_matrix(n_frames, length)


def warp_matrix(n_frames: int, length: int) -> np.ndarray:
    """Linear time-warp of ``n_frames`` to ``length`` frames, ends on ends; float64, shape (length, n_frames)."""
    matrix = np.zeros((length, n_frames))
    place = np.linspace(0.0, n_frames - 1.0, length) if length > 1 else np.array([(n_frames - 1) / 2.0])
    low = np.minimum(place.astype(int), max(n_frames - 2, 0))
    share = place - low
    rows = np.arange(length)
    matrix[rows, low] += 1.0 - share
    matrix[rows, np.minimum(low + 1, n_frames - 1)] += share
    return matrix


def _squared_distances(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    squared = a @ (-2.0 * b.T)
    squared += np.einsum("ij,ij->i", a, a)[:, None]
    squared += np.einsum("ij,ij->i", b, b)
    return np.maximum(squared, 0.0, out=squared)


def observation_costs(phonemes: np.ndarray, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """OC of table 2: 0 for the phone itself and for silence, discounted within the viseme class.

    phonemes : int, shape (n_slots,), indices into `PHONEMES`
    returns : float64, shape (n_slots, n_nodes)
    """
    visemes = np.asarray(VISEME_OF_PHONEME)
    wanted = np.asarray(phonemes)[:, None]
    mismatch = weights.alpha5 * weights.pnt
    cost = np.where(visemes[wanted] == nodes.viseme[None], weights.alpha4 * mismatch, mismatch)
    cost[np.equal(wanted, nodes.phoneme[None]) | (wanted == PHONEME_INDEX[PAU])] = 0.0
    return cost


def emotion_mismatch_penalties(emotions: np.ndarray, nodes: NodeTable, weights: SearchWeights) -> np.ndarray:
    """EMP of equation 5, for mixes: ``α6 · PNT · (1 - w_emotion(n))``.

    emotions : shape (n_slots, n_emotions), rows sum to 1
    returns : float64, shape (n_slots, n_nodes)
    """
    return weights.alpha6 * weights.pnt * (1.0 - np.asarray(emotions, float)[:, nodes.emotion])


def default_weights(frames: np.ndarray, nodes: NodeTable, rate_hz: float, seed: int = 2008) -> SearchWeights:
    """Untuned weights that let no term drown another, from medians over random pairs of this database.

    α3 = median VGap / median PGap, PNT = median PVC, α2 = median PVC / median DSC / 4; the other weights are
    dimensionless and fixed. A database of one node, or one that never moves, gets 1 for what cannot be measured.
    """
    rng = np.random.default_rng(seed)
    terms = TransitionTerms(frames, nodes, rate_hz)
    # some targets against some sources: a random sample of pairs that costs a few matrix products at any size
    with_pre = np.flatnonzero(nodes.pre != NIL)
    targets = rng.choice(with_pre, min(_SAMPLED_NODES, len(with_pre)), replace=False)
    sources = rng.choice(len(nodes), min(_SAMPLED_NODES, len(nodes)), replace=False)
    blocks = list(terms.blocks(np.sort(targets), np.sort(sources)))
    if not blocks:
        return SearchWeights(pnt=1.0)

    def median(values: list[np.ndarray]) -> float:
        return float(np.median(np.concatenate([v.ravel() for v in values]))) or 1.0

    position = median([b.position_gap for b in blocks])
    velocity = median([b.velocity_gap for b in blocks])
    alpha3 = velocity / position
    pvc = median([alpha3 * b.position_gap + b.velocity_gap for b in blocks])
    return SearchWeights(pnt=pvc, alpha2=pvc / median([b.smoothing for b in blocks]) / 4.0, alpha3=alpha3)
