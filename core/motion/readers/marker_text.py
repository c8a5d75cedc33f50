"""Markers and tracked points from tables of text, whoever wrote them.

Read are: the workstation's own CSV; one row of heads (``nose_x,nose_y,nose_z``, ``nose:X``, ``x_12``, Maya's
``nose.translateX``); heads of two or more rows as Vicon Nexus, OptiTrack Motive and others export them; Qualisys TSV;
OpenFace; MediaPipe's numbered points, one row a frame or one row a point. Columns may come in any order.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.frame_rate import check_rate_hz, rate_of_times
from core.motion.length_units import median_span, mm_per, unit_by_span
from core.motion.motion_track import MotionTrack, RateUnknown, ReadOptions
from core.motion.readers.delimited import DelimitedText, check_places
from core.motion.readers.landmarks import are_landmarks, in_pixels, landmark_names
from core.motion.readers.table_layout import TableLayout, table_layout

# a table with one row a point may leave out this share of its points and frames, and no more
_SPARSEST = 4
_SMALLEST_FACE_MM = 50.0


def read_marker_text(text: DelimitedText, options: ReadOptions) -> MotionTrack:
    """Read a table of markers or tracked points.

    An empty cell, or ``nan``, makes its marker missing in that frame; so do zeros in all axes of a marker that is not
    always there, but for the own layout. The rate is the one that ``options`` gives, the times tell, or the file
    states, in this order; the unit the one that ``options`` gives, the file states, or
    `core.motion.length_units.unit_by_span` tells. The own layout (``frame,time_s,<marker>_x,...``) is millimetres.

    Raises `UserFacingError` with the line of what cannot be used, and its kinds of `core.motion.motion_track`.
    """
    layout = table_layout(text)
    if layout.point is not None:
        names, points, times_s, lines = _one_row_a_point(text, layout)
    else:
        names, points, times_s, lines = _one_row_a_frame(text, layout)
    if not len(points):
        raise UserFacingError(f"'{text.path}' has 0 frames.")
    rate_hz = _rate_hz(text.path, layout, options, times_s, lines)
    check_places(points, lines, text.path)
    notes = list(layout.notes)
    if layout.zero_is_missing:
        _drop_zeros(points, notes)
    has_depth = points.shape[2] == 3
    unit = options.unit or layout.unit or ("mm" if layout.own else None)
    if are_landmarks(names, has_depth, layout.capital, unit):
        names, note = landmark_names(names)
        pixels, more = in_pixels(points, text.path, options.picture_px)
        return MotionTrack(pixels, names, rate_hz, False, has_depth, notes=(*notes, *note, *more))
    return _in_mm(text.path, names, points, rate_hz, layout, unit, notes)


def _in_mm(
    path: Path, names: tuple[str, ...], points: np.ndarray, rate_hz: float, layout: TableLayout, unit: str | None,
    notes: list[str],
) -> MotionTrack:  # fmt: skip
    if unit is None:
        unit, note = unit_by_span(points, path)
        notes.append(note)
    positions = (points * mm_per(unit, path)).astype(np.float32)
    span_mm = median_span(positions)
    if len(names) >= 10 and 0 < span_mm < _SMALLEST_FACE_MM:
        notes.append(f"The markers span only {span_mm:.3g} mm: is the unit right?")
    if layout.camera:
        positions[..., 1:] *= -1.0
        names, _ = landmark_names(names)
        notes.append("The camera's axes were turned: y is up, z towards the camera.")
    return MotionTrack(positions, names, rate_hz, notes=tuple(notes))


def _one_row_a_frame(
    text: DelimitedText, layout: TableLayout
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray | None, np.ndarray]:
    names = tuple(layout.points)
    columns = [c for place in layout.points.values() for c in place]
    extra = [c for c in (layout.time, layout.valid) if c is not None]
    table, lines = text.numbers(layout.first_row, layout.n_columns, [*columns, *extra])
    depth = len(columns) // len(names)
    points = table[:, : len(columns)].reshape(len(table), len(names), depth)
    if layout.valid is not None:
        points[table[:, -1] == 0] = np.nan
    return names, points, table[:, len(columns)] * layout.seconds if layout.time is not None else None, lines


def _one_row_a_point(
    text: DelimitedText, layout: TableLayout
) -> tuple[tuple[str, ...], np.ndarray, np.ndarray | None, np.ndarray]:
    key = layout.frame if layout.frame is not None else layout.time
    if key is None or layout.point is None:
        raise UserFacingError(f"'{text.path}' has one row a point, and no column that says of which frame.")
    (places,) = layout.points.values()
    extra = [key, *([layout.time] if layout.time is not None else [])]
    table, lines = text.numbers(layout.first_row, layout.n_columns, [*places, *extra])
    rows = {name: k for k, name in enumerate(dict.fromkeys(text.cells(line - 1)[layout.point] for line in lines))}
    point = np.array([rows[text.cells(line - 1)[layout.point]] for line in lines], int)
    if np.isnan(table[:, len(places)]).any():
        line = lines[np.isnan(table[:, len(places)]).argmax()]
        raise UserFacingError(f"'{text.path}', line {line}: the row does not say of which frame it is.")
    _, first, frame = np.unique(table[:, len(places)], return_index=True, return_inverse=True)
    if len(rows) * len(first) > _SPARSEST * len(table) + 100:
        raise UserFacingError(f"'{text.path}' has most of its points in few of its frames.")
    points = np.full((len(first), len(rows), len(places)), np.nan)
    points[frame, point] = table[:, : len(places)]
    times_s = table[first, -1] * layout.seconds if layout.time is not None else None
    return tuple(rows), points, times_s, lines[first]


def _rate_hz(
    path: Path, layout: TableLayout, options: ReadOptions, times_s: np.ndarray | None, lines: np.ndarray
) -> float:
    if options.rate_hz is not None:
        return check_rate_hz(options.rate_hz, path)
    if times_s is not None:
        # exports round times to a millisecond, and then what the file states is finer
        timed_hz = rate_of_times(times_s, path, lines)
        stated_hz = layout.rate_hz
        return stated_hz if stated_hz and abs(stated_hz - timed_hz) < 0.01 * timed_hz else timed_hz
    if layout.rate_hz is not None:
        return check_rate_hz(layout.rate_hz, path)
    raise RateUnknown(path)


def _drop_zeros(points: np.ndarray, notes: list[str]) -> None:
    zero = (points == 0).all(axis=2)
    zero &= ~zero.all(axis=0)
    if zero.any():
        points[zero] = np.nan
        notes.append(f"{int(zero.sum())} samples at exactly 0, 0, 0 are taken as missing.")
