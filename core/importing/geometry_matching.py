"""One cloud of markers laid on another whose order and scale are unknown."""

from __future__ import annotations

import itertools

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from core.face.similarity import Similarity, fit_similarity

# A marker set of another studio covers another part of the face: this share of the worst pairs steers nothing.
_TRIMMED_SHARE = 0.2
_STEPS = 40
# Adult faces differ less than this in size; without bounds a small cloud shrinks into a dense one.
_SCALE_BOUNDS = (0.75, 1.33)


def align_clouds(found: np.ndarray, wanted: np.ndarray, pairs: np.ndarray | None = None) -> Similarity:
    """Find the similarity that lays ``found`` on ``wanted``, whichever marker is which.

    With three or more known ``pairs`` (int, shape (n, 2), rows of both) those decide, the worst left out; without them
    the clouds are laid on each other along their principal axes in all 24 ways, each is bettered by turns of
    assignment and fit (iterated closest points, one to one, trimmed), and the closest wins.

    found : shape (n_found, 3), mm; wanted : shape (n_wanted, 3), mm
    """
    if pairs is not None and len(pairs) >= 3:
        return _robust(found[pairs[:, 0]], wanted[pairs[:, 1]])
    best, least = None, np.inf
    for start in _starts(found, wanted):
        placed, cost = _iterated(found, wanted, start)
        if cost < least:
            best, least = placed, cost
    return best


def _robust(points: np.ndarray, goal: np.ndarray) -> Similarity:
    kept = np.ones(len(points), bool)
    fit = fit_similarity(points, goal)
    for _ in range(5):
        away = np.linalg.norm(fit(points) - goal, axis=1)
        kept = away <= max(3.0 * np.median(away), 1e-6)
        if kept.sum() < 3:
            break
        fit = fit_similarity(points[kept], goal[kept])
    return fit


def _size(points: np.ndarray) -> float:
    return float(np.median(np.linalg.norm(points - np.median(points, axis=0), axis=1))) or 1.0


def _starts(found: np.ndarray, wanted: np.ndarray):
    scale = _size(wanted) / _size(found)
    middle, goal_middle = np.median(found, axis=0), np.median(wanted, axis=0)
    axes, goal_axes = (np.linalg.svd(p - m, full_matrices=False)[2]
                       for p, m in ((found, middle), (wanted, goal_middle)))  # fmt: skip
    turns = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1.0, -1.0), repeat=3):
            turn = np.eye(3)[list(order)] * np.array(signs)[:, None]
            turns += [goal_axes.T @ turn @ axes, turn]
    for rotation in turns:
        if np.linalg.det(rotation) > 0:
            yield Similarity(scale, rotation, goal_middle - scale * rotation @ middle)


def _iterated(found: np.ndarray, wanted: np.ndarray, fit: Similarity) -> tuple[Similarity, float]:
    first_scale = fit.scale
    rows = None
    for _ in range(_STEPS):
        ours, theirs, cost = assigned(fit(found), wanted)
        kept = np.argsort(cost)[: max(3, round(len(cost) * (1 - _TRIMMED_SHARE)))]
        now = (ours[kept].tobytes(), theirs[kept].tobytes())
        if now == rows:
            break
        rows = now
        fit = fit_similarity(found[ours[kept]], wanted[theirs[kept]])
        scale = float(np.clip(fit.scale, *(bound * first_scale for bound in _SCALE_BOUNDS)))
        if scale != fit.scale:
            fit = fit_similarity(found[ours[kept]], wanted[theirs[kept]], scale)
    # both ways, each to its nearest: a cloud that sits on a corner of the other shall not win
    there = cKDTree(wanted).query(fit(found))[0]
    back = cKDTree(fit(found)).query(wanted)[0]
    return fit, float(np.mean(np.minimum(there, 4 * np.median(there))) + 0.5 * np.mean(back))


def assigned(placed: np.ndarray, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pair two clouds one to one at the least sum of distances; returns rows of both and the distances."""
    distance = np.linalg.norm(placed[:, None] - wanted[None], axis=2)
    ours, theirs = linear_sum_assignment(distance)
    return ours, theirs, distance[ours, theirs]
