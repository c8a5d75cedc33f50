"""Which markers keep their places on the head, and how well they agree once its motion is taken out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.importing.matching import typical_pose
from core.motion.normalise import normalise

_MOST_FRAMES = 600
_LEAST, _MOST = 4, 10
# Further markers join while they move less than this much more than the steadiest few.
_TIMES_STEADIEST = 1.6


@dataclass(frozen=True)
class SteadyMarkers:
    """A proposal.

    rigid : names, steadiest first; origin : the one that the whole head turns about least surprisingly
    residual_mm : root mean square of each rigid marker after the head's motion is taken out by them
    """

    rigid: tuple[str, ...]
    origin: str
    residual_mm: tuple[float, ...]


def propose_steady(names: Sequence[str], takes: Sequence[np.ndarray], midline: Sequence[str] = ()) -> SteadyMarkers:
    """Propose the near-rigid markers and the origin: least motion relative to each other, over all takes.

    The standard deviation of the distance of two markers is a measure that knows no head motion. From the three that
    agree best and span a triangle, markers join one by one, the one that adds least first.

    takes : each of shape (n_frames, n_markers, 3), mm, NaN where missing
    midline : names that are fit to be the origin (bridge of the nose), the fittest first; when none of them is rigid,
        the steadiest of all is taken
    """
    frames = np.concatenate([np.asarray(t, float)[:: max(1, len(t) * len(takes) // _MOST_FRAMES)] for t in takes])
    unrest, length = _pairwise(frames)
    chosen = _first_three(unrest, length)
    n_most = min(_MOST, len(names))
    while len(chosen) < n_most:
        others = [k for k in range(len(names)) if k not in chosen]
        added = [float(np.mean(unrest[k, chosen])) for k in others]
        best = int(np.argmin(added))
        agreed = float(np.mean(unrest[np.ix_(chosen, chosen)])) * len(chosen) / max(len(chosen) - 1, 1)
        if not np.isfinite(added[best]) or (len(chosen) >= _LEAST and added[best] > _TIMES_STEADIEST * agreed):
            break
        chosen.append(others[best])
    residual = rigid_residual_mm(frames, chosen)
    order = np.argsort(residual, kind="stable")
    rigid = tuple(names[chosen[i]] for i in order)
    fit = [name for name in midline if name in rigid] or list(rigid)
    return SteadyMarkers(rigid, fit[0], tuple(float(residual[i]) for i in order))


def _pairwise(frames: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    n_markers = frames.shape[1]
    unrest = np.full((n_markers, n_markers), np.inf)
    length = np.zeros((n_markers, n_markers))
    for k in range(n_markers):
        distance = np.linalg.norm(frames - frames[:, k : k + 1], axis=2)
        counted = np.isfinite(distance).sum(axis=0)
        enough = counted >= max(3, len(frames) // 4)
        unrest[k, enough] = np.nanstd(distance[:, enough], axis=0)
        length[k, enough] = np.nanmean(distance[:, enough], axis=0)
    np.fill_diagonal(unrest, 0.0)
    return unrest, length


def _first_three(unrest: np.ndarray, length: np.ndarray) -> list[int]:
    """The three markers that agree best; a small triangle tells a turn badly, so unrest counts by its size."""
    n = len(unrest)
    best, least = [0, 1, 2], np.inf
    for a in range(n):
        for b in range(a + 1, n):
            sides = np.array([np.full(n, length[a, b]), length[a], length[b]])
            unease = np.array([np.full(n, unrest[a, b]), unrest[a], unrest[b]]).max(axis=0)
            half = sides.sum(axis=0) / 2
            area = np.sqrt(np.maximum(half * np.prod(half - sides, axis=0), 0.0))
            with np.errstate(divide="ignore", invalid="ignore"):
                height = np.where(area > 0, 2 * area / sides.max(axis=0), 0.0)
                worth = np.where(height > 0, unease / height, np.inf)
            worth[: b + 1] = np.inf
            c = int(np.argmin(worth))
            if worth[c] < least:
                best, least = [a, b, c], float(worth[c])
    return best


def rigid_residual_mm(positions: np.ndarray, rigid: Sequence[int]) -> np.ndarray:
    """Return how much each rigid marker still moves after head stabilisation by all of them: RMS, mm, shape (n_rigid,).

    positions : shape (n_frames, n_markers, 3), mm, NaN where missing; rigid : rows of the near-rigid markers, 3 or more
    """
    return np.sqrt(np.nanmean(rigid_away_mm(positions, rigid) ** 2, axis=0))


def rigid_away_mm(positions: np.ndarray, rigid: Sequence[int]) -> np.ndarray:
    """Return how far each rigid marker is off its mean place, frame by frame: mm, shape (n_frames, n_rigid).

    As in `rigid_residual_mm`; NaN where a marker is missing.
    """
    points = np.asarray(positions, float)[:, list(rigid)]
    reference = typical_pose(points)
    for _ in range(3):
        face, _ = normalise(points, reference)
        with np.errstate(invalid="ignore"):
            reference = np.nanmean(face, axis=0)
    return np.linalg.norm(face - reference, axis=2)
