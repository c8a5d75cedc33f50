"""Key lip shapes: a few captured frames that the others are blended from (Kuo et al. 2012, section 4)."""

from __future__ import annotations

import warnings

import numpy as np

from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

_MOST_CAPTURED, _MOST_FRAMES = 6000, 600
_TRIALS = 12
# messages among lips that move along a line oscillate under the first, and every frame becomes an exemplar
_DAMPINGS = (0.8, 0.95)
_ITERATIONS = {0.8: 300, 0.95: 1000}


def key_lip_shapes(
    lip_displacements: np.ndarray, n_shapes: int = 7, seed: int = 2008, progress: Progress = SILENT
) -> np.ndarray:
    """Choose about ``n_shapes`` frames by affinity propagation (Frey and Dueck 2007).

    Affinity propagation finds the number of clusters from a preference; the preference is bisected until the number is
    ``n_shapes``, or as near as it comes. Frames at rest say nothing about how lips move, and are left out.

    lip_displacements : shape (F, K, 3), mm from rest
    returns : the frames of the exemplars, int, ascending
    Raises `UserFacingError` when fewer than two different frames move, or none comes out as an exemplar.
    """
    packed = np.reshape(lip_displacements, (len(lip_displacements), -1)).astype(float)
    away = np.linalg.norm(packed, axis=1)
    moving = np.flatnonzero(away > 0.2 * away.max(initial=0.0))
    rng = np.random.default_rng(seed)
    chosen = np.sort(rng.choice(moving, min(_MOST_FRAMES, len(moving)), replace=False))
    if len(np.unique(packed[chosen], axis=0)) < max(2, n_shapes):
        raise UserFacingError(f"The captured lips do not move enough to find {n_shapes} key shapes in them.")
    similar = -np.square(packed[chosen, None] - packed[None, chosen]).sum(axis=2)
    best = np.empty(0, int)
    for attempt, damping in enumerate(_DAMPINGS):
        part = progress.part(attempt / len(_DAMPINGS), (attempt + 1) / len(_DAMPINGS))
        found = _nearest_in_number(similar, n_shapes, damping, seed, part)
        if attempt == 0 or abs(len(found) - n_shapes) < abs(len(best) - n_shapes):
            best = found
        if n_shapes <= 2 * len(best) <= 4 * n_shapes:
            break
    if not len(best):
        raise UserFacingError(f"The captured lips do not fall into {n_shapes} key shapes.", "Ask for another number.")
    return chosen[np.sort(best)]


def captured_keys(
    database: MotionDatabase, n_shapes: int = 7, seed: int = 2008, progress: Progress = SILENT
) -> tuple[np.ndarray, np.ndarray]:
    """Choose key lip shapes among the captured frames; see `key_lip_shapes`.

    returns : rows of the lip markers, int, shape (K,), and the shapes, float64, shape (N, K, 3), mm from rest
    Raises `UserFacingError` where the database does not say which markers are the lips.
    """
    lips = database.markers.group("lips")
    if len(lips) == 0:
        raise UserFacingError(
            f"The database '{database.name}' does not say which markers are the lips.",
            "Name them in the group lips of markers.csv and build it anew.",
        )
    step = max(1, len(database.frames) // _MOST_CAPTURED)
    moved = database.pca.positions(database.frames[::step].astype(float))[:, lips] - database.markers.rest[lips]
    return lips, moved[key_lip_shapes(moved, n_shapes, seed, progress)]


def _nearest_in_number(similar: np.ndarray, n_shapes: int, damping: float, seed: int, progress: Progress) -> np.ndarray:
    """Bisect the preference; returns the exemplars whose number comes nearest to ``n_shapes``."""
    low, high = 200.0 * similar.min(), 0.0
    best: np.ndarray | None = None
    for trial in range(_TRIALS):
        progress.step(trial / _TRIALS, "choosing key lip shapes")
        middle = (low + high) / 2 if high else low / 8
        exemplars = _exemplars(similar, middle, damping, seed)
        if best is None or abs(len(exemplars) - n_shapes) < abs(len(best) - n_shapes):
            best = exemplars
        if len(exemplars) == n_shapes:
            break
        low, high = (middle, high) if len(exemplars) < n_shapes else (low, middle)
    return best


def _exemplars(similar: np.ndarray, preference: float, damping: float, seed: int) -> np.ndarray:
    from sklearn.cluster import AffinityPropagation
    from sklearn.exceptions import ConvergenceWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # without exemplars it counts as none found
        found = AffinityPropagation(
            damping=damping,
            max_iter=_ITERATIONS[damping],
            affinity="precomputed",
            preference=preference,
            random_state=seed,
        ).fit(similar)
    return np.asarray(found.cluster_centers_indices_, int)
