"""What an import would do with captures of which nothing was said: markers, steady ones, landmarks and axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.errors import UserFacingError
from core.importing.geometry_matching import align_clouds
from core.importing.marker_parts import propose_parts
from core.importing.matching import MarkerMatching, match_markers, typical_pose
from core.importing.name_matching import name_likeness
from core.importing.plan import ImportPlan, axes_matrix
from core.importing.steady_markers import propose_steady
from core.importing.takes import read_take
from core.motion.marker_set import MarkerSet
from core.motion.motion_track import MotionTrack

_MOST_TAKES = 6
_LEAST_RIGID = 3


def with_proposals(plan: ImportPlan, known: MarkerSet, like: bool = False) -> ImportPlan:
    """Fill in what ``plan`` leaves open, from a few of its takes.

    known : a marker set whose parts are known; the markers keep their own names
    like : take the names, parts and order of ``known`` instead, for the markers that match

    Axes are turned where the face would lie or look away; for tracked video they are what the reader says.
    Raises `UserFacingError` when no take can be read.
    """
    tracks = _some_takes(plan)
    # tracked points are brought to size later: until then a pixel is a millimetre
    axes = plan.reading.axes if plan.with_scale else proposed_axes(tracks[0], known)
    if axes != plan.reading.axes:
        turn = axes_matrix(axes)
        plan = replace(plan, reading=replace(plan.reading, axes=axes))
        tracks = [replace(track, positions=track.positions @ turn.T) for track in tracks]
    names = tracks[0].names
    if like and not plan.markers:
        plan = _like(plan, match_markers(names, tracks[0].positions, known), known)
    kept = list(plan.markers) or list(names)
    shown = {name: plan.markers.get(name, name) for name in kept}
    columns = [names.index(name) for name in kept if name in names]
    takes = [track.positions[:, columns] for track in tracks if track.names == names]
    database_names = [shown[names[c]] for c in columns]
    if not plan.landmarks:
        parts = propose_parts(database_names, typical_pose(takes[0]), known)
        plan = replace(plan, landmarks=parts.landmarks, groups=dict(plan.groups) or parts.groups)
    if len(plan.rigid) < _LEAST_RIGID and len(columns) > _LEAST_RIGID:
        midline = [plan.landmarks[place] for place in ("nose_bridge", "nose_tip") if place in plan.landmarks]
        steady = propose_steady(database_names, takes, midline)
        plan = replace(plan, rigid=steady.rigid, origin=plan.origin or steady.origin)
    return plan


def proposed_axes(track: MotionTrack, known: MarkerSet) -> tuple[str, str, str]:
    """Return which captured axis points left, up and forward: the signed axes nearest to how the face is laid on
    ``known``. Names that tell three markers decide the orientation; otherwise the shape does.
    """
    pose = typical_pose(track.positions)
    seen = np.flatnonzero(np.isfinite(pose).all(axis=1))
    if len(seen) < _LEAST_RIGID + 1:
        return "x", "y", "z"
    alike = name_likeness([track.names[k] for k in seen], known.names)
    pairs = np.array([(i, int(row.argmax())) for i, row in enumerate(alike) if row.max() >= 0.95], int).reshape(-1, 2)
    rotation = align_clouds(pose[seen], known.rest, pairs).rotation
    axes, free = [], [0, 1, 2]
    for row in rotation[:2]:
        axis = max(free, key=lambda a: abs(row[a]))
        free.remove(axis)
        axes.append(("-" if row[axis] < 0 else "") + "xyz"[axis])
    last = "xyz"[free[0]]
    mirrored = np.linalg.det(axes_matrix((*axes, last))) < 0
    return (*axes, f"-{last}" if mirrored else last)


def _like(plan: ImportPlan, matching: MarkerMatching, known: MarkerSet) -> ImportPlan:
    given = set(matching.markers.values())
    groups = {part: tuple(m for m in members if m in given) for part, members in known.groups.items()}
    landmarks = {place: marker for place, marker in known.landmarks.items() if marker in given}
    origin = groups.get("origin", ())
    return replace(plan, markers=matching.markers, origin=origin[0] if origin else None,
                   rigid=groups.get("rigid", ()), landmarks=landmarks,
                   groups={part: members for part, members in groups.items() if members})  # fmt: skip


def _some_takes(plan: ImportPlan) -> list[MotionTrack]:
    tracks, first_error = [], None
    for sentence in _spread(plan.sentences):
        try:
            tracks.append(read_take(sentence, plan.reading))
        except UserFacingError as error:
            first_error = first_error or error
    if not tracks:
        raise first_error or UserFacingError("The import has no sentence.")
    return tracks


def _spread(sentences: Sequence) -> Sequence:
    step = max(1, len(sentences) // _MOST_TAKES)
    return sentences[::step][:_MOST_TAKES]
