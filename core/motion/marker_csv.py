"""Markers as a table: ``frame,time_s,<marker>_x,<marker>_y,<marker>_z,...``, millimetres."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.media.swap_in import swapped_in

# how far, in frames, a time may lie from where even steps put it
_UNEVEN_FRAMES = 0.25
_LONGEST_BYTES = 2 << 30


def write_markers_csv(path: str | Path, positions: np.ndarray, names: Sequence[str], rate_hz: float) -> None:
    """Write markers, one row a frame; ``frame`` counts from 0 and a missing marker leaves its cells empty.

    positions : shape (F, K, 3), mm, NaN where missing; names : K; rate_hz : frames a second

    Raises `UserFacingError` when the file cannot be written.
    """
    positions = np.asarray(positions, float)
    if positions.ndim != 3 or positions.shape[1:] != (len(names), 3):
        raise ValueError(f"positions have shape {positions.shape}; {len(names)} markers need (F, {len(names)}, 3)")
    header = ["frame", "time_s", *(f"{name}_{axis}" for name in names for axis in "xyz")]
    with swapped_in(path) as beside, beside.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(header)
        for f, frame in enumerate(positions.reshape(len(positions), -1)):
            cells = ["" if value != value else f"{value:.5f}" for value in frame.tolist()]
            rows.writerow([f, f"{f / rate_hz:.9f}", *cells])


def read_markers_csv(path: str | Path) -> tuple[np.ndarray, tuple[str, ...], float]:
    """Return positions (float32, shape (F, K, 3), mm, NaN where missing), marker names and frames a second.

    The cells of a missing marker are empty or ``nan``. A name that ends in .tsv is split at tabs. The rate comes
    from ``time_s``, which must advance evenly.

    Raises `UserFacingError` with the line of what cannot be used.
    """
    path = Path(path)
    header, lines, tab = _lines(path)
    names = _marker_names(header, path)
    table = _numbers(lines, len(header), "\t" if tab else ",", path)
    if len(table) < 2:
        raise UserFacingError(f"'{path}' has {len(table)} frames; at least 2 are needed to know its rate.")
    rate_hz = _rate_hz(table[:, 1], path)
    with np.errstate(over="ignore"):
        positions = table[:, 2:].astype(np.float32).reshape(len(table), len(names), 3)
    infinite = np.isinf(positions).any(axis=(1, 2))
    if infinite.any():
        raise UserFacingError(f"'{path}', line {infinite.argmax() + 2}: a coordinate is infinite.")
    positions[np.isnan(positions).any(axis=2)] = np.nan
    return positions, names, rate_hz


def _lines(path: Path) -> tuple[list[str], list[str], bool]:
    tab = path.suffix.lower() == ".tsv"
    try:
        if path.stat().st_size > _LONGEST_BYTES:
            raise UserFacingError(f"'{path}' is larger than 2 GB.", "Cut it into takes.")
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except UnicodeDecodeError as error:
        raise UserFacingError(f"'{path}' is not a text file of markers.") from error
    head, _, body = text.partition("\n")
    if not head.strip():
        raise UserFacingError(f"'{path}' is empty, or has no header.")
    try:
        header = next(csv.reader(io.StringIO(head), delimiter="\t" if tab else ","))
    except csv.Error as error:
        raise UserFacingError(f"'{path}', line 1: the header cannot be read.") from error
    lines = body.split("\n")
    while lines and not lines[-1].strip():
        lines.pop()
    return [cell.strip() for cell in header], lines, tab


def _marker_names(header: list[str], path: Path) -> tuple[str, ...]:
    example = "frame,time_s,<marker>_x,<marker>_y,<marker>_z"
    if header[:2] != ["frame", "time_s"] or len(header) < 5 or len(header) % 3 != 2:
        raise UserFacingError(f"'{path}', line 1: the header is not {example} and so on.")
    names = []
    for at in range(2, len(header), 3):
        name = header[at].removesuffix("_x")
        if not name or header[at : at + 3] != [f"{name}_{axis}" for axis in "xyz"]:
            raise UserFacingError(
                f"'{path}', line 1: column {at + 1} '{header[at]}' does not begin a marker's x, y, z."
            )
        if name in names:
            raise UserFacingError(f"'{path}', line 1: the marker '{name}' comes twice.")
        names.append(name)
    return tuple(names)


def _numbers(lines: list[str], n_columns: int, delimiter: str, path: Path) -> np.ndarray:
    rows = np.empty((len(lines), n_columns))
    for f, line in enumerate(lines):
        cells = line.split(delimiter)
        if len(cells) != n_columns:
            raise UserFacingError(f"'{path}', line {f + 2}: {len(cells)} cells; the header has {n_columns}.")
        try:
            rows[f] = [_number(cell) for cell in cells]
        except ValueError as error:
            wrong = next(cell for cell in cells if not _is_number(cell))
            raise UserFacingError(f"'{path}', line {f + 2}: '{wrong.strip()[:40]}' is not a number.") from error
    return rows


def _number(cell: str) -> float:
    return float(cell) if cell and not cell.isspace() else math.nan


def _is_number(cell: str) -> bool:
    try:
        _number(cell)
    except ValueError:
        return False
    return True


def _rate_hz(times_s: np.ndarray, path: Path) -> float:
    if not np.isfinite(times_s).all():
        raise UserFacingError(f"'{path}', line {(~np.isfinite(times_s)).argmax() + 2}: time_s is not a number.")
    duration_s = times_s[-1] - times_s[0]
    if duration_s <= 0:
        raise UserFacingError(f"'{path}': time_s does not advance.")
    rate_hz = (len(times_s) - 1) / duration_s
    off = np.abs((times_s - times_s[0]) * rate_hz - np.arange(len(times_s)))
    if off.max() > _UNEVEN_FRAMES:
        line = (off > _UNEVEN_FRAMES).argmax() + 2
        raise UserFacingError(f"'{path}', line {line}: time_s does not advance evenly.", "Give every frame its row.")
    # times are rounded to a microsecond at best; the rate that was meant is a whole number or a television rate
    for meant in (round(rate_hz), round(rate_hz * 1.001) / 1.001):
        if abs(rate_hz - meant) <= rate_hz * max(1e-6, 1.5e-6 / duration_s):
            return float(meant)
    return float(rate_hz)
