"""What a matching of markers means for the plan: names, parts and landmarks of the database's markers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.actress.corpus import actress_marker_set
from core.face.characters import DEFAULT
from core.face.default_face import FaceUnavailable, character_face
from core.face.face import Face
from core.face.marker_placement import ACTRESS_FILE, load_marker_file
from core.importing.marker_parts import propose_parts
from core.importing.matching import MarkerMatching, match_markers, typical_pose
from core.importing.plan import ImportPlan
from core.motion.marker_set import MarkerSet
from core.progress import Progress

OWN, OURS, OPEN, FILE = "own", "ours", "open", "file"


@dataclass(frozen=True)
class MatchRequest:
    """Markers to be laid on a set.

    names, sample : of the capture, sample of shape (n_frames, n_markers, 3)
    wanted : a set of markers, or None for ours
    own : keep the capture's names and look for landmarks only
    """

    names: tuple[str, ...]
    sample: np.ndarray
    wanted: MarkerSet | None
    own: bool


@dataclass(frozen=True)
class MatchPicture:
    """What was found, with all that is drawn of it.

    matching : of captured markers to ``wanted`` (for own markers, to the landmarks of our set)
    wanted : the set at the right, on the face's scale; places : where its markers are drawn, shape (n_wanted, 3)
    parts : landmarks and groups proposed for own markers
    face : drawn behind, or None where it is not on this machine
    """

    matching: MarkerMatching
    wanted: MarkerSet
    places: np.ndarray
    landmarks: Mapping[str, str]
    groups: Mapping[str, tuple[str, ...]]
    face: Face | None
    own: bool

    @property
    def how(self) -> dict[tuple[str, str], tuple[str, float, float]]:
        """(found, wanted) to (how it was told, confidence, distance in mm)."""
        return {(m.found, m.wanted): (m.how, m.confidence, m.away_mm) for m in self.matching.matches}


def match(request: MatchRequest, progress: Progress) -> MatchPicture:
    """Match, and find where everything is drawn; a job."""
    progress.step(0.1, "matching markers")
    ours = actress_marker_set()
    try:
        face = character_face(DEFAULT)
    except FaceUnavailable:
        face = None
    wanted = request.wanted or ours
    matching = match_markers(request.names, request.sample, wanted)
    if not request.own:
        places = wanted.rest if face is None else _on_face(face, wanted, ours)
        return MatchPicture(matching, wanted, places, {}, {}, face, False)
    progress.step(0.5, "looking for landmarks")
    parts = propose_parts(request.names, typical_pose(request.sample), wanted)
    anatomy = tuple(wanted.landmarks)
    rest = wanted.rest[wanted.indices([wanted.landmarks[a] for a in anatomy])].reshape(-1, 3)
    points = MarkerSet(anatomy, rest)
    places = rest if face is None else _on_face(face, points, ours)
    return MatchPicture(matching, points, places, parts.landmarks, parts.groups, face, True)


def _on_face(face: Face, wanted: MarkerSet, ours: MarkerSet) -> np.ndarray:
    """Markers of any set, laid on the face by their names or places; mm, the face's own space."""
    origin = face.positions[_origin_vertex()].astype(float)
    if set(wanted.names) <= {*ours.names, *ours.landmarks}:
        return wanted.rest + origin
    return match_markers(wanted.names, wanted.rest, ours).placed + origin


def _origin_vertex() -> int:
    placement = load_marker_file(ACTRESS_FILE)
    return int(placement.vertices[placement.names.index(placement.groups["origin"][0])])


def fields_for_own(plan: ImportPlan, landmarks: Mapping[str, str], groups: Mapping[str, tuple[str, ...]]) -> dict:
    """Return the plan's fields that keep the capture's own names; head markers stay where they were captured ones."""
    return {"markers": {}, "landmarks": dict(landmarks), "groups": dict(groups), **_head_renamed(plan, {})}


def fields_for_set(plan: ImportPlan, wanted: MarkerSet, pairs: Mapping[str, str]) -> dict[str, object]:
    """Return the plan's fields that name markers as ``pairs`` (captured to wanted) says, in the set's order."""
    found = {theirs: ours for ours, theirs in pairs.items()}
    kept = [name for name in wanted.names if name in found]
    inside = set(kept)
    groups = {part: tuple(m for m in members if m in inside) for part, members in wanted.groups.items()}
    head = {part: groups.pop(part, ()) for part in ("origin", "rigid")}
    fields = {
        "markers": {found[name]: name for name in kept},
        "landmarks": {anatomy: m for anatomy, m in wanted.landmarks.items() if m in inside},
        "groups": {part: members for part, members in groups.items() if members},
        "origin": head["origin"][0] if head["origin"] else None,
        "rigid": head["rigid"],
    }
    if len(fields["rigid"]) < 3:
        fields |= _head_renamed(plan, fields["markers"])
    return fields


def _head_renamed(plan: ImportPlan, markers: Mapping[str, str]) -> dict[str, object]:
    """Head markers under their new names; those that are left out are gone."""
    captured = {theirs: ours for ours, theirs in plan.markers.items()}

    def now(name: str) -> str | None:
        ours = captured.get(name, name)
        return markers.get(ours) if markers else ours

    rigid = tuple(name for name in map(now, plan.rigid) if name)
    return {"rigid": rigid, "origin": now(plan.origin) if plan.origin else None}


def is_own(plan: ImportPlan) -> bool:
    """Whether the plan keeps the capture's own names."""
    return all(ours == theirs for ours, theirs in plan.markers.items())


def markers_of_database(path: Path, _progress: Progress) -> MarkerSet:
    """Return the markers of a motion database; a job."""
    from core.motion.database import open_database

    return open_database(path).markers
