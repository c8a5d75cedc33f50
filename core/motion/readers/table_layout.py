"""Where a table of points keeps what: heads of one row, of several as motion tools write them, or one row a point."""

from __future__ import annotations

from dataclasses import dataclass, field

from core.errors import UserFacingError
from core.motion.readers.column_names import axis_column, bare_axis, is_frame, is_length, time_factor
from core.motion.readers.delimited import HEAD_LINES, DelimitedText, first_repeated
from core.motion.readers.tool_heads import marker_columns, names_above, numeric_cell, stated_rate, stated_unit

# of several such columns the first in this list counts
_POINT_NAMES = ("marker", "marker name", "landmark", "landmark_index", "landmark_id", "landmark id", "keypoint",
                "point", "point_id", "name", "index", "id")  # fmt: skip
_OTHER_UNITS = {"s", "ms", "sec", "seconds", "px", "deg", "rad", "-", "frame", "frames", "hz", "#"}
_OWN_HEADER = ("frame", "time_s")


@dataclass(frozen=True)
class TableLayout:
    """Columns count from 0.

    points : name to its columns of x, y and, if it has depth, z
    first_row : of the data; n_columns : cells of a row
    time : column of times, with ``seconds`` a unit; frame : column of frame numbers; valid : column that is 0 where
        nothing was tracked; point : with one row a point, the column of its name, and ``points`` has one entry
    rate_hz, unit : as the file states them
    capital : heads were X, Y, Z rather than x, y, z
    zero_is_missing : the tool writes 0, 0, 0 for a marker that it did not see
    own : the workstation's own layout, in millimetres
    camera : axes are a camera's: x right in the picture, y down, z away
    """

    points: dict[str, tuple[int, ...]]
    first_row: int
    n_columns: int
    time: int | None = None
    seconds: float = 1.0
    frame: int | None = None
    valid: int | None = None
    point: int | None = None
    rate_hz: float | None = None
    unit: str | None = None
    capital: bool = False
    zero_is_missing: bool = True
    own: bool = False
    camera: bool = False
    notes: tuple[str, ...] = field(default=())


def table_layout(text: DelimitedText) -> TableLayout:
    """Find the layout of a table; raises `UserFacingError` naming the line that is not understood."""
    start = _section(text)
    head: list[tuple[int, list[str]]] = []
    for row in range(start, min(len(text.lines), start + HEAD_LINES)):
        if text.is_blank(row):
            continue
        cells = text.cells(row)
        layout = _of_head(text, head, row, cells)
        if layout is not None:
            return layout
        if cells[0].upper() == "MARKER_NAMES":
            return _qualisys(text, head, row, cells)
        head.append((row, cells))
    line = head[0][0] + 1 if head else 1
    raise UserFacingError(
        f"'{text.path}', line {line}: there is no header that names points and their axes.",
        "Write frame,time_s,<marker>_x,<marker>_y,<marker>_z and so on, or export it from your motion tool again.",
    )


def _section(text: DelimitedText) -> int:
    """The line after ``Trajectories``, Nexus's title of its markers; 0 in any other file."""
    for row, line in enumerate(text.lines):
        if line[:14].strip(' "').lower().startswith("trajectories"):
            return row + 1
    return 0


def _of_head(text: DelimitedText, above: list, row: int, cells: list[str]) -> TableLayout | None:
    bare = [bare_axis(cell) for cell in cells]
    axes = [None if column is None else column.axis for column in bare]
    # x0, y0, z0, x1 are names of their own where no line above them names the points
    first = next((c for c, axis in enumerate(axes) if axis is not None), 0)
    unnamed = not any(any(line[first : first + 3]) for _, line in above)
    if unnamed and sum(axis is not None for axis in axes) > 3:
        bare, axes = [], [None] * len(cells)
    if sum(axis is not None for axis in axes) >= 2:
        names = {cell.lower(): c for c, cell in enumerate(cells)}
        named = next((names[name] for name in _POINT_NAMES if name in names), None)
        if named is not None and axes.count(0) == axes.count(1) == 1:
            return _one_row_a_point(text, row, cells, axes, named)
        unit = next((column.unit for column in bare if column and column.unit), None)
        return _several_rows(text, above, row, cells, axes, unit)
    columns = [axis_column(cell) for cell in cells]
    if sum(column is not None for column in columns) >= 2:
        return _one_row(text, above, row, cells, columns)
    return None


def _one_row(text: DelimitedText, above: list, row: int, cells: list[str], columns: list) -> TableLayout:
    openface = {"confidence", "success"} <= {cell.lower() for cell in cells}
    if openface:
        # OpenFace: gaze, pose and the eyes' contours are no points of the skin
        columns = [column if column and column.name.isdigit() else None for column in columns]
    found: dict[tuple[str, bool], dict[int, int]] = {}
    for c, column in enumerate(columns):
        if column is None:
            continue
        axes = found.setdefault((column.name, column.capital), {})
        if column.axis in axes:
            raise UserFacingError(f"'{text.path}', line {row + 1}: the marker '{column.name[:60]}' comes twice.")
        axes[column.axis] = c
    whole = {key: axes for key, axes in found.items() if len(axes) == 3}
    flat = {key: axes for key, axes in found.items() if set(axes) == {0, 1}}
    deep = {name for name, _ in whole}
    shallow = next((name for name, _ in flat if whole and name not in deep), None)
    if shallow is not None:
        raise UserFacingError(f"'{text.path}', line {row + 1}: the marker '{shallow[:60]}' has no column for z.")
    chosen = whole or flat
    if not chosen:
        raise UserFacingError(f"'{text.path}', line {row + 1}: no marker has columns for x, y and z.")
    points: dict[str, tuple[int, ...]] = {}
    for (name, _), axes in chosen.items():
        if name in points:
            raise UserFacingError(f"'{text.path}', line {row + 1}: the marker '{name[:60]}' comes twice.")
        points[name] = tuple(axes[a] for a in sorted(axes))
    units = [columns[c].unit for axes in chosen.values() for c in axes.values() if columns[c].unit]
    used = {c for place in points.values() for c in place}
    own = tuple(cells[:2]) == _OWN_HEADER and cells[2:] == [f"{n}_{a}" for n in points for a in "xyz"]
    return _finished(
        text, above, row, cells, points, used,
        unit=units[0] if units else None, capital=next(iter(chosen))[1], own=own, camera=openface,
    )  # fmt: skip


def _several_rows(
    text: DelimitedText, above: list, row: int, cells: list[str], axes: list, unit: str | None
) -> TableLayout:
    kept = marker_columns(above, axes)
    names = names_above(text, above, row, axes, kept)
    points: dict[str, list[int]] = {}
    for c in sorted(kept):
        axis = axes[c]
        columns = points.setdefault(names[c], [])
        if axis != len(columns):
            raise UserFacingError(
                f"'{text.path}', line {row + 1}: column {c + 1} is not the "
                f"{'xyz'[min(len(columns), 2)]} of '{names[c][:60]}'."
            )
        columns.append(c)
    depth = max(map(len, points.values()), default=0)
    short = next((name for name, columns in points.items() if len(columns) < max(depth, 2)), None)
    if short is not None or not points:
        raise UserFacingError(f"'{text.path}', line {row + 1}: the marker '{(short or '')[:60]}' lacks an axis.")
    places = {name: tuple(columns) for name, columns in points.items()}
    used = {c for c, axis in enumerate(axes) if axis is not None}
    # the heads of frames and times may stand in the line of names, with a unit below
    lines = [cells, *(line for _, line in reversed(above))]
    heads = list(cells)
    for c in set(range(len(cells))) - used:
        heads[c] = next((line[c] for line in lines if c < len(line) and _counts(line[c])), "")
    return _finished(text, above, row, heads, places, used, unit=unit, capital=True)


def _one_row_a_point(text: DelimitedText, row: int, cells: list[str], axes: list, named: int) -> TableLayout:
    places = tuple(axes.index(axis) for axis in range(3) if axis in axes)
    return _finished(text, [], row, cells, {"": places}, {*places, named}, point=named)


def _qualisys(text: DelimitedText, above: list, row: int, cells: list[str]) -> TableLayout:
    """Qualisys Track Manager: key and value a line, names in a line of their own, often no heads of columns."""
    names = [cell for cell in cells[1:] if cell]
    first = row + 1
    while first < len(text.lines) and (text.is_blank(first) or not numeric_cell(text.cells(first)[0])):
        first += 1
    heads = next((text.cells(r) for r in range(row + 1, first) if text.cells(r)[0].lower() == "frame"), [])
    start = 2 if heads else 0
    if not names or first_repeated(names) is not None:
        raise UserFacingError(f"'{text.path}', line {row + 1}: markers have no names, or the same one.")
    points = {name: tuple(range(start + 3 * k, start + 3 * k + 3)) for k, name in enumerate(names)}
    return TableLayout(points, first, start + 3 * len(names), rate_hz=stated_rate(above), unit="mm", capital=True)


def _finished(
    text: DelimitedText, above: list, row: int, cells: list[str], points: dict, used: set[int], *,
    unit: str | None = None, capital: bool = False, point: int | None = None, own: bool = False,
    camera: bool = False,
) -> TableLayout:  # fmt: skip
    others = [c for c in range(len(cells)) if c not in used]
    times = [c for c in others if time_factor(cells[c]) is not None]
    frames = [c for c in others if is_frame(cells[c])]
    valid = next((c for c in others if cells[c].lower() == "success"), None)
    first = row + 1
    while first < len(text.lines) and text.is_blank(first):
        first += 1
    if first < len(text.lines):
        below = text.cells(first)
        units = [cell for cell in below if cell]
        if units and all(is_length(cell) or cell.lower() in _OTHER_UNITS for cell in units):
            here = [below[c] for place in points.values() for c in place if c < len(below)]
            unit = unit or next((cell for cell in here if is_length(cell)), None)
            first += 1
    known = {*times, *frames} | ({valid} if valid is not None else set())
    strangers = [cells[c] for c in others if cells[c] and c not in known and cells[c].lower() != "sub frame"]
    notes = ()
    if strangers:
        listed = ", ".join(f"'{name[:40]}'" for name in strangers[:3]) + (" ..." if len(strangers) > 3 else "")
        notes = (f"Columns that are no points were left out: {listed}.",)
    return TableLayout(
        points, first, len(cells), times[0] if times else None, time_factor(cells[times[0]]) if times else 1.0,
        frames[0] if frames else None, valid, point, stated_rate(above), unit or stated_unit(above), capital,
        zero_is_missing=not own, own=own, camera=camera, notes=notes,
    )  # fmt: skip


def _counts(head: str) -> bool:
    return time_factor(head) is not None or is_frame(head)
