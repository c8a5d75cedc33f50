"""Feature points that are clicked on a scan and on the generic face: the guided list, and the file that keeps them."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import Face
from core.media.swap_in import swapped_in

TABLE = Path(__file__).resolve().parents[2] / "resources" / "face" / "feature-points.csv"
FORMAT, VERSION = "efase-face-points", 1
MOST_BYTES = 2**20


@dataclass(frozen=True)
class FeaturePoint:
    """One line of the guided list.

    key : its name in files; vertices : of the generic face (our characters' numbering), whose middle it is
    is_needed : whether no face can be fitted without it
    title, hint : for the user
    """

    key: str
    vertices: tuple[int, ...]
    is_needed: bool
    title: str
    hint: str


@lru_cache(maxsize=1)
def feature_points() -> tuple[FeaturePoint, ...]:
    """Return the guided list in its order, from ``resources/face/feature-points.csv``."""
    with TABLE.open(encoding="utf-8", newline="") as file:
        return tuple(
            FeaturePoint(row["point"], tuple(int(v) for v in row["vertices"].split(";")), row["needed"] == "1",
                         row["title"], row["hint"])
            for row in csv.DictReader(file)
        )  # fmt: skip


def generic_points(face: Face, moved: Mapping[str, np.ndarray] | None = None) -> dict[str, np.ndarray]:
    """Return where the points lie on ``face``, one of our characters: key to shape (3,), mm.

    moved : points that the user put elsewhere on it
    """
    at = {point.key: face.positions[list(point.vertices)].mean(axis=0).astype(float) for point in feature_points()}
    return at | {key: np.asarray(place, float) for key, place in (moved or {}).items()}


@dataclass(frozen=True)
class PointFile:
    """What a file of points holds.

    points : key to shape (3,), in the unit of the scan's file
    vertices : key to a vertex of the scan, where a file names that instead
    moved : key to shape (3,), mm, on the generic face, for points that were put elsewhere on it
    photo : key to shape (2,), pixels from the left and from the top of a photo
    """

    points: Mapping[str, np.ndarray] = field(default_factory=dict)
    vertices: Mapping[str, int] = field(default_factory=dict)
    moved: Mapping[str, np.ndarray] = field(default_factory=dict)
    photo: Mapping[str, np.ndarray] = field(default_factory=dict)

    def on(self, positions: np.ndarray, name: str) -> dict[str, np.ndarray]:
        """Return the points on a scan with vertices at ``positions`` (V, 3); `UserFacingError` for one beyond them."""
        beyond = next((key for key, vertex in self.vertices.items() if vertex >= len(positions)), None)
        if beyond is not None:
            raise UserFacingError(
                f"The point {beyond} is on vertex {self.vertices[beyond]}, "
                f"but {name} has only {len(positions)} vertices."
            )
        return dict(self.points) | {key: positions[vertex] for key, vertex in self.vertices.items()}


def save_points(path: Path, file: PointFile) -> None:
    """Write ``file`` as JSON, whole or not at all; raises `UserFacingError`."""

    def listed(places: Mapping[str, np.ndarray]) -> dict[str, list[float]]:
        return {key: [round(float(x), 6) for x in place] for key, place in places.items()}

    document = {
        "format": FORMAT, "version": VERSION, "points": listed(file.points) | dict(file.vertices),
        "generic": listed(file.moved), "photo": listed(file.photo),
    }  # fmt: skip
    with swapped_in(path) as beside:
        beside.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def load_points(path: Path) -> PointFile:
    """Read what `save_points` wrote; raises `UserFacingError` for anything else."""
    try:
        if path.stat().st_size > MOST_BYTES:
            raise UserFacingError(f"{path} is too large for a file of feature points.")
        document = json.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise UserFacingError(f"The points {path} cannot be read: {error.strerror}.") from error
    except (ValueError, RecursionError) as error:
        raise UserFacingError(f"{path} is not a JSON file.") from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise UserFacingError(f"{path} holds no feature points.", "The window of own faces writes such files.")
    if document.get("version") != VERSION:
        raise UserFacingError(f"{path} is from another version of the workstation.")
    points, vertices = {}, {}
    for key, place in _table(path, document, "points").items():
        if isinstance(place, int) and not isinstance(place, bool) and 0 <= place < 2**31:
            vertices[key] = place
        else:
            points[key] = _place(path, key, place, 3)
    moved = {key: _place(path, key, place, 3) for key, place in _table(path, document, "generic").items()}
    photo = {key: _place(path, key, place, 2) for key, place in _table(path, document, "photo").items()}
    return PointFile(points, vertices, moved, photo)


def _table(path: Path, document: dict, name: str) -> dict[str, object]:
    table = document.get(name, {})
    if not isinstance(table, dict):
        raise UserFacingError(f"{path}: '{name}' is not a table of points.")
    known = {point.key for point in feature_points()}
    strange = next((key for key in table if key not in known), None)
    if strange is not None:
        raise UserFacingError(f"{path}: there is no feature point '{strange[:40]}'.", f"Known are {', '.join(known)}.")
    return table


def _place(path: Path, key: str, place: object, n: int) -> np.ndarray:
    good = isinstance(place, list) and len(place) == n
    good = good and all(isinstance(x, (int, float)) and not isinstance(x, bool) and abs(x) < 1e9 for x in place)
    if not good:
        raise UserFacingError(f"{path}: the point {key} needs {n} finite numbers.")
    return np.array(place, float)
