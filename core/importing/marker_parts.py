"""What part each marker of an unknown set plays, told by a set whose parts are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from core.importing.matching import FARTHEST_MM, match_markers
from core.importing.name_matching import likeness
from core.motion.marker_set import MarkerSet

_FARTHEST_PART_MM = 12.0
# A name counts as much as this many millimetres of nearness.
_NAME_MM = 20.0
# The parts, and the landmarks that belong to each whatever is near.
_LANDMARKS_OF = {
    "jaw": ("chin",), "upper_lip": ("upper_lip",), "lower_lip": ("lower_lip",),
    "lips": ("upper_lip", "lower_lip", "mouth_corner_left", "mouth_corner_right"),
}  # fmt: skip


@dataclass(frozen=True)
class MarkerParts:
    """A proposal: landmarks (anatomical name to marker name) and groups (part to marker names)."""

    landmarks: dict[str, str]
    groups: dict[str, tuple[str, ...]]


def propose_parts(names: Sequence[str], pose: np.ndarray, known: MarkerSet) -> MarkerParts:
    """Propose landmarks and groups for markers that keep their own names, from a set whose parts are known.

    The markers are laid on the known set (`match_markers`). A landmark goes to the marker that is near it or named
    like it, one to one; a marker belongs to the parts of the known marker nearest to it, within 12 mm.

    pose : shape (n_markers, 3), mm, NaN where unknown
    """
    placed = match_markers(names, pose, known).placed
    seen = np.flatnonzero(np.isfinite(placed).all(axis=1))
    if len(seen) < 4:
        return MarkerParts({}, {})
    anatomy = list(known.landmarks)
    places = known.rest[known.indices([known.landmarks[a] for a in anatomy])]
    away = np.linalg.norm(placed[seen][:, None] - places[None], axis=2)
    alike = np.array([[max(likeness(names[f], a), likeness(names[f], known.landmarks[a])) for a in anatomy]
                      for f in seen])  # fmt: skip
    alike[alike < 0.8] = 0.0
    landmarks = {}
    for i, j in zip(*linear_sum_assignment(away - _NAME_MM * alike)):
        if away[i, j] <= FARTHEST_MM or (alike[i, j] >= 0.95 and away[i, j] <= 2 * FARTHEST_MM):
            landmarks[anatomy[j]] = names[seen[i]]
    distance = np.linalg.norm(placed[seen][:, None] - known.rest[None], axis=2)
    nearest = distance.argmin(axis=1)
    groups = {}
    for part in _LANDMARKS_OF:
        members = set(known.group(part).tolist())
        inside = [names[f] for i, f in enumerate(seen)
                  if nearest[i] in members and distance[i, nearest[i]] <= _FARTHEST_PART_MM]  # fmt: skip
        inside += [landmarks[a] for a in _LANDMARKS_OF[part] if a in landmarks and landmarks[a] not in inside]
        if inside:
            groups[part] = tuple(inside)
    return MarkerParts(landmarks, groups)
