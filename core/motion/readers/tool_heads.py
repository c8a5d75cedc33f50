"""What the lines above the axes of a table say: names of markers, kinds of columns, rate and unit."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from core.errors import UserFacingError
from core.motion.readers.column_names import is_length
from core.motion.readers.delimited import DelimitedText, is_number

_RATES = ("export frame rate", "frame rate", "framerate", "capture frame rate", "frequency", "datarate", "data rate",
          "sample rate", "fps", "rate")  # fmt: skip
_UNITS = ("length units", "units", "unit")
# Motive's kinds of columns that are places of markers; the first that a file has is read
_MOTIVE_MARKERS = (("marker",), ("rigid body marker", "bone marker"))


def names_above(text: DelimitedText, above: list, row: int, axes: list, kept: set[int]) -> list[str]:
    """Return one name a column: from Motive's row ``Name``, else the nearest row above.

    A name stands over its x or over all its axes. ``above`` are the lines before ``row`` with their numbers, ``axes``
    the axis of each column or None, ``kept`` the columns that need a name. Raises `UserFacingError` where one lacks it.
    """
    first = next(c for c, axis in enumerate(axes) if axis is not None)
    rows = [cells for _, cells in above if len(cells) > 1 and cells[1].lower() == "name"]
    rows += [cells for _, cells in reversed(above) if any(cells[first : first + 3])]
    if not rows:
        raise UserFacingError(f"'{text.path}', line {row + 1}: no row above the axes names the markers.")
    names, current = [], ""
    for c, axis in enumerate(axes):
        cell = rows[0][c] if c < len(rows[0]) else ""
        current = cell or ("" if axis == 0 else current)
        names.append(current)
    nameless = next((c for c in sorted(kept) if not names[c]), None)
    if nameless is not None:
        raise UserFacingError(f"'{text.path}', line {row + 1}: column {nameless + 1} belongs to no marker.")
    return names


def marker_columns(above: list, axes: list) -> set[int]:
    """Return the columns that are places of markers; all, where no row says what each is."""
    kinds = next((cells for _, cells in above if sum(cell.lower() == "position" for cell in cells) >= 2), None)
    types = next((cells for _, cells in above if sum(cell.lower().endswith("marker") for cell in cells) >= 3), None)
    columns = {c for c, axis in enumerate(axes) if axis is not None}
    if kinds is not None:
        columns = {c for c in columns if c < len(kinds) and kinds[c].lower() == "position"}
    if types is not None:
        for wanted in _MOTIVE_MARKERS:
            chosen = {c for c in columns if c < len(types) and types[c].lower() in wanted}
            if chosen:
                return chosen
    return columns


def stated_rate(above: list) -> float | None:
    """Return the rate that the lines above state: a key and its number, or Nexus's number in its own line."""
    for key in _RATES:
        for _, cells in above:
            for name, value in _pairs(cells):
                if name == key and numeric_cell(value) and float(value.replace(",", ".")) > 0:
                    return float(value.replace(",", "."))
    for _, cells in above:
        filled = [cell for cell in cells if cell]
        if len(filled) == 1 and numeric_cell(filled[0]) and float(filled[0].replace(",", ".")) > 0:
            return float(filled[0].replace(",", "."))
    return None


def stated_unit(above: list) -> str | None:
    """Return the unit of length that the lines above state."""
    for key in _UNITS:
        for _, cells in above:
            for name, value in _pairs(cells):
                if name == key and is_length(value):
                    return value
    return None


def numeric_cell(cell: str) -> bool:
    """Tell whether a cell is a number, with a decimal point or comma."""
    return is_number(cell.replace(",", "."))


def _pairs(cells: Sequence[str]) -> list[tuple[str, str]]:
    """Keys with what follows them; also ``# fps: 60`` within one cell."""
    plain = [cell.lower().strip(" #:=") for cell in cells]
    inner = [part for cell in plain for sep in ":=" if sep in cell for part in [cell.split(sep, 1)]]
    return [*pairwise(plain), *((a.strip(), b.strip()) for a, b in inner)]
