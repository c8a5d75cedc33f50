"""TRC, the text file of markers of Motion Analysis, read and written also by OpenSim, MotionBuilder and Maya.

Reading is written out here: the format is a table of text for which `core.motion.readers.delimited` does the work, and
the libraries that read it (kineticstoolkit, opensim) bring pandas or a simulator along. Format: five lines of head
(kind; names of the settings; settings; names of the markers, each over three columns; X1 Y1 Z1 ...), then one row a
frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.frame_rate import check_rate_hz
from core.motion.length_units import mm_per, unit_by_span
from core.motion.motion_track import MotionTrack, RateUnknown, ReadOptions
from core.motion.readers.delimited import DelimitedText, check_places, first_repeated, is_number, read_delimited

_SETTINGS = ("DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units", "OrigDataRate", "OrigDataStartFrame",
             "OrigNumFrames")  # fmt: skip
_HEAD_LINES = 12


def write_trc(path: str | Path, positions: np.ndarray, names: Sequence[str], rate_hz: float) -> None:
    """Write markers in millimetres, frames counted from 1; the cells of a missing marker are empty.

    positions : shape (F, K, 3), mm, NaN where missing; names : K; rate_hz : frames a second

    Raises `UserFacingError` when the file cannot be written.
    """
    positions = np.asarray(positions, float)
    if positions.ndim != 3 or positions.shape[1:] != (len(names), 3):
        raise ValueError(f"positions have shape {positions.shape}; {len(names)} markers need (F, {len(names)}, 3)")
    n_frames, n_markers = positions.shape[:2]
    rate = f"{rate_hz:.10g}"
    settings = (rate, rate, str(n_frames), str(n_markers), "mm", rate, "1", str(n_frames))
    axes = (f"{axis}{k}" for k in range(1, n_markers + 1) for axis in "XYZ")
    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        file.write(f"PathFileType\t4\t(X/Y/Z)\t{Path(path).name}\n")
        file.write("\t".join(_SETTINGS) + "\n" + "\t".join(settings) + "\n")
        clean = [name.replace("\t", " ").replace("\n", " ") for name in names]
        file.write("Frame#\tTime\t" + "\t\t\t".join(clean) + "\t\t\n")
        file.write("\t\t" + "\t".join(axes) + "\n\n")
        for f, frame in enumerate(positions.reshape(n_frames, -1)):
            cells = ["" if value != value else f"{value:.5f}" for value in frame.tolist()]
            file.write("\t".join([str(f + 1), f"{f / rate_hz:.9f}", *cells]) + "\n")


def read_trc(path: str | Path, options: ReadOptions | None = None) -> MotionTrack:
    """Read a TRC file; axes are those of the capture, usually y up.

    A marker without cells in a row is missing in that frame. The frames that are there are read, however many the head
    promises, and a difference is noted. Raises `UserFacingError` naming the line of what cannot be used.
    """
    path, options = Path(path), options or ReadOptions()
    text = read_delimited(path)
    text = DelimitedText(path, text.lines, "\t" if any("\t" in line for line in text.lines[:_HEAD_LINES]) else ",")
    if not text.cells(0)[0].lower().startswith("pathfiletype"):
        raise UserFacingError(f"'{path}', line 1: a TRC file begins with PathFileType.")
    settings = _settings(text)
    row, names = _names(text)
    # OpenSim leaves out the last cells of a row where they are empty
    n_columns = 2 + 3 * len(names)
    table, lines = text.numbers(row, n_columns, range(2, n_columns), ends_early=3)
    if not len(table):
        raise UserFacingError(f"'{path}' has 0 frames.")
    points = table.reshape(len(table), len(names), 3)
    check_places(points, lines, path)
    notes = []
    promised = settings.get("numframes", "")
    if promised.isdecimal() and len(promised) < 12 and int(promised) != len(points):
        notes.append(f"The head promises {int(promised)} frames, {len(points)} are there.")
    rate = settings.get("datarate", "")
    if options.rate_hz is None and not is_number(rate):
        raise RateUnknown(path)
    rate_hz = check_rate_hz(float(rate) if options.rate_hz is None else options.rate_hz, path)
    unit = options.unit or settings.get("units", "")
    if not unit:
        unit, note = unit_by_span(points, path)
        notes.append(note)
    return MotionTrack((points * mm_per(unit, path)).astype(np.float32), names, rate_hz, notes=tuple(notes))


def _settings(text: DelimitedText) -> dict[str, str]:
    """Settings by lower-case name; TRC files differ in which they have."""
    if len(text.lines) < 3:
        raise UserFacingError(f"'{text.path}' is truncated.")
    return {key.lower(): value.replace(",", ".") for key, value in zip(text.cells(1), text.cells(2))}


def _names(text: DelimitedText) -> tuple[int, tuple[str, ...]]:
    """The first line of data and the names of the markers; every third column has one, or they stand side by side."""
    for row in range(3, min(len(text.lines), _HEAD_LINES)):
        cells = text.cells(row)
        if not cells[0].lower().startswith("frame"):
            continue
        names = [cell for cell in cells[2:] if cell]
        if not names:
            break
        twice = first_repeated(names)
        if twice is not None:
            raise UserFacingError(f"'{text.path}', line {row + 1}: the marker '{twice[:60]}' comes twice.")
        first = row + 1
        while first < len(text.lines) and not is_number(text.cells(first)[0].replace(",", ".")):
            first += 1
        return first, tuple(names)
    raise UserFacingError(f"'{text.path}' has no line of marker names, which begins with Frame#.")
