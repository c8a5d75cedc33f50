"""Blendshape weights drive the markers of a face that has those shapes; `core.rig.rig` moves whole faces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from core.errors import UserFacingError
from core.face.marker_units import MarkerUnits
from core.motion.blendshape_track import BlendshapeTrack
from core.motion.motion_track import MotionTrack


def markers_of_blendshapes(track: BlendshapeTrack, units: MarkerUnits, kept_only: bool = True) -> MotionTrack:
    """Return how the markers of a face move under the weights, at the track's rate.

    Each marker is where it rests plus the sum of the units' moves, each times its weight; frames without a face are
    NaN. The head rests.

    units : of `core.face.marker_units.load_marker_units` (the default face with the actress's markers; needs no face
        file) or `marker_units_of` for a face of one's own
    kept_only : leave out the markers that are captured and not used

    Units that the face lacks are noted. Raises `UserFacingError` when it has none of the track's.
    """
    moves = dict(zip(units.names, units.moves))
    used, note = _shared(track.names, moves, "face")
    chosen = np.flatnonzero(units.kept) if kept_only else np.arange(len(units.markers))
    rest = units.markers.rest[chosen]
    weights = track.weights[:, [track.names.index(name) for name in used]].astype(float)
    offsets = weights @ np.array([moves[name][chosen].ravel() for name in used], float)
    positions = (rest + offsets.reshape(len(weights), len(chosen), 3)).astype(np.float32)
    names = tuple(units.markers.names[k] for k in chosen)
    return MotionTrack(positions, names, track.rate_hz, notes=(*track.notes, *note))


def _shared(names: Sequence[str], known: Mapping[str, np.ndarray], what: str) -> tuple[list[str], tuple[str, ...]]:
    used = [name for name in names if name in known]
    if not used:
        raise UserFacingError(
            f"The {what} has none of the track's shapes, such as '{names[0]}'.",
            "Give the table that maps them to ARKit's units.",
        )
    lost = [name for name in names if name not in known]
    return used, ((f"Shapes that the {what} lacks: {', '.join(lost)}.",) if lost else ())
