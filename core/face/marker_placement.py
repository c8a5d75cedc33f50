"""Which marker sits on which vertex of a face: tables of `marker,vertex`, ours and the user's."""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import Face
from core.motion.marker_set import LANDMARKS, MarkerSet

MARKERS = Path(__file__).resolve().parents[2] / "resources" / "markers"
ACTRESS_FILE = MARKERS / "actress-102.csv"
COLUMNS = ("marker", "vertex", "kept", "groups", "landmark")


@dataclass(frozen=True)
class MarkerPlacement:
    """Markers on the vertices of one face.

    names : one for each of the K markers, unique
    vertices : int, shape (K,)
    kept : bool, shape (K,); false for markers that were captured but are not used (12 of the paper's 102)
    groups, landmarks : as in `core.motion.marker_set.MarkerSet`
    """

    names: tuple[str, ...]
    vertices: np.ndarray
    kept: np.ndarray
    groups: dict[str, tuple[str, ...]] = field(default_factory=dict)
    landmarks: dict[str, str] = field(default_factory=dict)


def load_marker_file(path: Path) -> MarkerPlacement:
    """Read a CSV with the columns ``marker,vertex`` and, if wanted, ``kept``, ``groups`` (``;`` between), ``landmark``.

    Vertices are counted from 0 in the order of the face's file. Raises `UserFacingError` naming file and line.
    """
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except OSError as error:
        raise UserFacingError(f"The marker file {path} cannot be read: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise UserFacingError(f"The marker file {path} is not text.") from error
    reader = csv.reader(text.splitlines())
    try:
        header = [name.strip().lower() for name in next(reader, [])]
        if not {"marker", "vertex"} <= set(header):
            raise UserFacingError(f"{path}, line 1: a marker file begins with a header that has marker,vertex.")
        rows = [_row(path, reader.line_num, dict(zip(header, cells))) for cells in reader if any(cells)]
    except csv.Error as error:
        raise UserFacingError(f"{path}, line {reader.line_num}: not a line of a CSV file.") from error
    if not rows:
        raise UserFacingError(f"{path} names no markers.")
    return _placement(path, rows)


def _row(path: Path, line: int, cells: dict[str, str]) -> tuple[str, int, bool, list[str], str]:
    name = cells["marker"].strip()
    try:
        vertex = int(cells.get("vertex", ""))
    except ValueError:
        vertex = -1
    if not name or not 0 <= vertex < 2**31:
        raise UserFacingError(f"{path}, line {line}: needs a marker's name and a vertex number from 0 up.")
    kept = cells.get("kept", "1").strip()
    if kept not in ("0", "1"):
        raise UserFacingError(f"{path}, line {line}: kept is 0 or 1, not {kept[:20]!r}.")
    groups = [group.strip() for group in cells.get("groups", "").split(";") if group.strip()]
    landmark = cells.get("landmark", "").strip()
    if landmark and landmark not in LANDMARKS:
        raise UserFacingError(
            f"{path}, line {line}: {landmark[:40]!r} is no landmark; known are {', '.join(LANDMARKS)}."
        )
    return name, vertex, kept == "1", groups, landmark


def _placement(path: Path, rows: list[tuple[str, int, bool, list[str], str]]) -> MarkerPlacement:
    names = tuple(row[0] for row in rows)
    vertices = np.array([row[1] for row in rows])
    for what, values in (("marker", list(names)), ("vertex", vertices.tolist())):
        repeated = next((value for value in values if values.count(value) > 1), None)
        if repeated is not None:
            raise UserFacingError(f"{path} names the {what} {str(repeated)[:60]} twice.")
    groups: dict[str, list[str]] = {}
    for name, _, _, members, _ in rows:
        for group in members:
            groups.setdefault(group, []).append(name)
    landmarks = {landmark: name for name, _, _, _, landmark in rows if landmark}
    if len(groups.get("origin", ["one"])) != 1:
        raise UserFacingError(f"{path} names more than one origin marker.")
    kept = np.array([row[2] for row in rows])
    return MarkerPlacement(names, vertices, kept, {g: tuple(m) for g, m in groups.items()}, landmarks)


def marker_set_on(face: Face, placement: MarkerPlacement, kept_only: bool = True) -> MarkerSet:
    """Return the markers as they rest on ``face``, in mm from the origin marker (the middle of all, if none is named).

    Raises `UserFacingError` when the placement names a vertex that the face has not.
    """
    if placement.vertices.max() >= len(face.positions):
        bad = int(np.argmax(placement.vertices))
        raise UserFacingError(
            f"Marker {placement.names[bad]} sits on vertex {placement.vertices[bad]}, "
            f"but the face {face.name} has only {len(face.positions)} vertices."
        )
    chosen = np.flatnonzero(placement.kept) if kept_only else np.arange(len(placement.names))
    names = tuple(placement.names[k] for k in chosen)
    known = set(names)
    groups = {group: tuple(m for m in members if m in known) for group, members in placement.groups.items()}
    groups = {group: members for group, members in groups.items() if members}
    landmarks = {landmark: name for landmark, name in placement.landmarks.items() if name in known}
    rest = face.positions[placement.vertices[chosen]].astype(float)
    origin = rest[names.index(groups["origin"][0])] if "origin" in groups else rest.mean(axis=0)
    return MarkerSet(names, rest - origin, groups, landmarks)
