"""From a studio's own blendshapes to ARKit's 52: a table of names, read from the sheet that came with the data."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, BlendshapeTrack, arkit_name
from core.motion.readers.blendshape_files import read_blendshapes
from core.motion.readers.delimited import read_delimited
from core.motion.readers.sheet import read_sheet

_MAXIMUM = re.compile(r"max\s*\(([^()]*)\)", re.IGNORECASE)
_MOST_ROWS = 20_000
# arrays of weights without a rate of their own are video's
_ARRAY_RATE_HZ = 30.0


@dataclass(frozen=True)
class ShapeMapping:
    """Which shapes of a track make which unit.

    sources : ARKit unit to the shapes whose largest weight it takes
    unused : ARKit units that the table names and marks as not valid: its author says their weights mean nothing
    """

    sources: Mapping[str, tuple[str, ...]]
    unused: tuple[str, ...] = ()


def read_shape_mapping(path: str | Path) -> ShapeMapping:
    """Read a mapping from .xlsx, .csv or .tsv.

    A line of heads has a cell ``ARKit``; the next filled cell heads the shapes of the track, and a cell ``Status``,
    where there is one, the column in which ``invalid`` rules a line out. A line names a unit of ARKit and a shape, or
    ``max(shape, shape, ...)``. Capitals do not matter. Lines that name no unit are remarks. Raises `UserFacingError`
    naming the row that cannot be used.
    """
    path = Path(path)
    if path.suffix.lower() == ".xlsx":
        rows = read_sheet(path)
    elif path.suffix.lower() in (".csv", ".tsv"):
        text = read_delimited(path)
        if len(text.lines) > _MOST_ROWS:
            raise UserFacingError(f"'{path}' is too large for a table of names.")
        rows = [text.cells(row) for row in range(len(text.lines))]
    else:
        raise UserFacingError(f"'{path}' is no kind of table that can be read.", "Use .xlsx, .csv or .tsv.")
    head, unit_column, shape_column, status_column = _heads(rows, path)
    sources: dict[str, tuple[str, ...]] = {}
    unused: list[str] = []
    for number, row in enumerate(rows[head + 1 :], start=head + 2):
        cells = [row[c] if c is not None and c < len(row) else "" for c in (unit_column, shape_column, status_column)]
        unit = arkit_name(cells[0]) if len(cells[0]) < 100 else None
        if unit not in ARKIT_UNITS or not cells[1]:
            continue
        if unit in sources or unit in unused:
            raise UserFacingError(f"'{path}', row {number}: '{unit}' comes twice.")
        if cells[2].lower() == "invalid":
            unused.append(unit)
        else:
            sources[unit] = _shapes(cells[1], path, number)
    if not sources:
        raise UserFacingError(f"'{path}' maps no shape to a unit of ARKit.")
    return ShapeMapping(sources, tuple(unused))


def read_units(
    path: str | Path, names: str | Path | None = None, sheet: str | Path | None = None, rate_hz: float | None = None
) -> BlendshapeTrack:
    """Read blendshape weights, by way of a studio's table where it comes with them.

    names, rate_hz : see `core.motion.readers.blendshape_files.read_blendshapes`; an .npy is taken to have 30 frames a
        second when nobody tells, and a note says so
    sheet : see `read_shape_mapping`; None leaves the shapes as they are
    """
    is_untold = Path(path).suffix.lower() == ".npy" and rate_hz is None
    track = read_blendshapes(path, names, _ARRAY_RATE_HZ if is_untold else rate_hz)
    if is_untold:
        track = replace(track, notes=(*track.notes, f"Taken to have {_ARRAY_RATE_HZ:g} frames a second."))
    return track if sheet is None else mapped(track, read_shape_mapping(sheet))


def mapped(track: BlendshapeTrack, mapping: ShapeMapping) -> BlendshapeTrack:
    """Return the track in units of ARKit; a unit that the mapping leaves out is absent.

    The notes say which shapes that move are not mapped. Raises `UserFacingError` when the mapping names no shape of the
    track.
    """
    column = {name.lower(): b for b, name in enumerate(track.names)}
    units, made, strangers = [], [], []
    used: set[int] = set()
    for unit, shapes in mapping.sources.items():
        rows = [column[shape.lower()] for shape in shapes if shape.lower() in column]
        strangers += [shape for shape in shapes if shape.lower() not in column]
        if rows:
            units.append(unit)
            made.append(track.weights[:, rows].max(axis=1))
            used.update(rows)
    if not units:
        raise UserFacingError(f"The mapping names no shape of this track, such as '{mapping_example(mapping)}'.")
    moving = np.flatnonzero(np.nan_to_num(track.weights).max(axis=0, initial=0.0) > 0)
    lost = [track.names[b] for b in moving if b not in used]
    notes = list(track.notes)
    if lost:
        notes.append(f"Shapes that move and are not mapped: {', '.join(lost)}.")
    if strangers:
        notes.append(f"Shapes that the mapping names and the track lacks: {', '.join(strangers)}.")
    return replace(track, weights=np.stack(made, axis=1), names=tuple(units), notes=tuple(notes))


def mapping_example(mapping: ShapeMapping) -> str:
    """Return one shape that the mapping names, for messages."""
    return next(iter(mapping.sources.values()))[0]


def _heads(rows: list[list[str]], path: Path) -> tuple[int, int, int, int | None]:
    for number, row in enumerate(rows):
        plain = [cell.lower() for cell in row]
        if "arkit" not in plain:
            continue
        unit_column = plain.index("arkit")
        status = plain.index("status") if "status" in plain else None
        named = [c for c, cell in enumerate(plain) if cell and c not in (unit_column, status)]
        after = [c for c in named if c > unit_column]
        if named:
            return number, unit_column, (after or named)[0], status
    raise UserFacingError(f"'{path}' has no line of heads with a cell ARKit and one for the shapes.")


def _shapes(cell: str, path: Path, number: int) -> tuple[str, ...]:
    match = _MAXIMUM.fullmatch(cell)
    shapes = tuple(part.strip() for part in match[1].split(",")) if match else (cell,)
    if not all(shapes) or any(set("()+*,") & set(shape) for shape in shapes):
        raise UserFacingError(f"'{path}', row {number}: '{cell[:60]}' is neither a shape nor max(shape, ...).")
    return shapes
