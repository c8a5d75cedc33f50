"""Which captured marker is which of the set: by name where names tell, by place where they do not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from core.importing.geometry_matching import align_clouds, assigned
from core.importing.name_matching import name_likeness
from core.motion.marker_set import MarkerSet

# A name that is only alike gives way when the place speaks against it by more than this.
_CONTRADICTED_MM = 25.0
FARTHEST_MM = 15.0


@dataclass(frozen=True)
class MarkerMatch:
    """One pair.

    found, wanted : names; how : ``name``, ``alike`` or ``place``
    confidence : 0..1; away_mm : distance after the clouds were laid on each other, NaN where no place is known
    """

    found: str
    wanted: str
    how: str
    confidence: float
    away_mm: float


@dataclass(frozen=True)
class MarkerMatching:
    """All pairs, and what stays alone.

    matches : in the order of the wanted set; unmatched_found, unmatched_wanted : names
    placed : float64, shape (n_found, 3), the found markers laid on the wanted set, for a picture; NaN where unknown
    """

    matches: tuple[MarkerMatch, ...]
    unmatched_found: tuple[str, ...]
    unmatched_wanted: tuple[str, ...]
    placed: np.ndarray

    @property
    def markers(self) -> dict[str, str]:
        """Captured name to wanted name, as `core.importing.plan.ImportPlan.markers` takes it."""
        return {match.found: match.wanted for match in self.matches}


def match_markers(
    found_names: Sequence[str], found_positions: np.ndarray, wanted: MarkerSet, farthest_mm: float = FARTHEST_MM
) -> MarkerMatching:
    """Match captured markers to those of a set, in any order, number, orientation and scale.

    Names decide first: as written, as meant (``LBrow_Out`` and ``eyebrow_outer_left``), then alike. The rest goes by
    place: the clouds are laid on each other (by the pairs that names gave, or by shape alone), then assigned at the
    least sum of distances, none farther than ``farthest_mm``.

    found_positions : shape (n_found, 3), mm, one pose, or (n_frames, n_found, 3), of which `typical_pose` is taken;
        NaN where a marker is missing
    """
    names = list(found_names)
    positions = np.asarray(found_positions, float)
    pose = typical_pose(positions) if positions.ndim == 3 else positions
    if pose.shape != (len(names), 3):
        raise ValueError(f"positions have shape {positions.shape}; {len(names)} markers need (..., {len(names)}, 3)")
    alike = name_likeness(names, wanted.names)
    ours, theirs = linear_sum_assignment(-alike)
    by_name = {(f, w): alike[f, w] for f, w in zip(ours, theirs) if alike[f, w] > 0}
    seen = np.isfinite(pose).all(axis=1)
    placed = _placed(pose, seen, wanted, by_name)
    away = np.linalg.norm(placed[:, None] - wanted.rest[None], axis=2)
    pairs = {
        pair: ("name", sure)
        if sure >= 0.95
        else ("alike", sure * (1.0 - 0.5 * np.nan_to_num(away[pair]) / _CONTRADICTED_MM))
        for pair, sure in by_name.items()
        if sure == 1.0 or not away[pair] > _CONTRADICTED_MM
    }
    pairs |= _by_place(placed, seen, wanted, away, pairs, farthest_mm)
    matches = tuple(
        MarkerMatch(names[f], wanted.names[w], how, float(sure), float(away[f, w]))
        for (f, w), (how, sure) in sorted(pairs.items(), key=lambda item: item[0][1])
    )
    taken, given = {m.found for m in matches}, {m.wanted for m in matches}
    return MarkerMatching(matches, tuple(n for n in names if n not in taken),
                          tuple(n for n in wanted.names if n not in given), placed)  # fmt: skip


def _placed(pose: np.ndarray, seen: np.ndarray, wanted: MarkerSet, by_name: dict) -> np.ndarray:
    placed = np.full_like(pose, np.nan)
    if seen.sum() < 3:
        return placed
    rows = np.flatnonzero(seen)
    of_row = {row: i for i, row in enumerate(rows)}
    pairs = np.array([(of_row[f], w) for f, w in by_name if f in of_row], int).reshape(-1, 2)
    placed[rows] = align_clouds(pose[rows], wanted.rest, pairs)(pose[rows])
    return placed


def _by_place(placed, seen, wanted: MarkerSet, away: np.ndarray, pairs: dict, farthest_mm: float) -> dict:
    free_found = np.array([f for f in np.flatnonzero(seen) if all(f != pair[0] for pair in pairs)], int)
    free_wanted = np.array([w for w in range(len(wanted)) if all(w != pair[1] for pair in pairs)], int)
    if not len(free_found) or not len(free_wanted):
        return {}
    result = {}
    for i, j, distance in zip(*assigned(placed[free_found], wanted.rest[free_wanted])):
        if distance > farthest_mm:
            continue
        f, w = free_found[i], free_wanted[j]
        rivals = np.concatenate([np.delete(away[f, free_wanted], j), np.delete(away[free_found, w], i), [farthest_mm]])
        clear = 1.0 - distance / max(float(rivals.min()), 1e-9)
        result[f, w] = ("place", float(np.clip(clear, 0.0, 1.0)) * (1.0 - 0.5 * distance / farthest_mm))
    return result


def typical_pose(positions: np.ndarray) -> np.ndarray:
    """Return the median pose of a capture, shape (n_markers, 3), in the orientation of its most complete frame.

    positions : shape (n_frames, n_markers, 3), NaN where missing; a marker that is never seen stays NaN
    """
    positions = np.asarray(positions, float)
    seen = np.isfinite(positions).all(axis=2)
    if not seen.any():
        return np.full(positions.shape[1:], np.nan)
    from core.motion.normalise import normalise

    first = positions[int(seen.sum(axis=1).argmax())]
    always = np.flatnonzero(np.isfinite(first).all(axis=1))
    pose = np.full(first.shape, np.nan)
    frames = positions[:: max(1, len(positions) // 500)]
    reference = np.where(np.isfinite(first), first, 0.0)
    turned, _ = normalise(frames, reference, always)
    turned += reference[always].mean(axis=0)
    known = np.isfinite(turned).any(axis=(0, 2))
    pose[known] = np.nanmedian(turned[:, known], axis=0)
    return pose
