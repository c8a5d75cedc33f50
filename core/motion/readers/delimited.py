"""Tables of text as motion tools write them: cells between tabs, semicolons or commas, decimal points or commas."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError

LARGEST_BYTES = 1 << 30
# headers end long before this line
HEAD_LINES = 64
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_SAMPLED_ROWS = 50
_SPARSEST = 16
# far beyond any place, in any unit
_LARGEST = float(np.finfo(np.float32).max) / 1e4


@dataclass(frozen=True)
class DelimitedText:
    """The lines of a table; cells are made of them on demand.

    lines : without line ends; delimiter : one character
    """

    path: Path
    lines: list[str]
    delimiter: str

    def cells(self, row: int) -> list[str]:
        """Return the stripped cells of line ``row``, counted from 0."""
        line = self.lines[row]
        if '"' in line:
            try:
                cells = next(csv.reader([line], delimiter=self.delimiter), None)
                return [cell.strip() for cell in cells or [""]]
            except csv.Error as error:
                raise UserFacingError(f"'{self.path}', line {row + 1}: not a line of a table.") from error
        return [cell.strip() for cell in line.split(self.delimiter)]

    def is_blank(self, row: int) -> bool:
        """Tell whether line ``row`` has nothing but empty cells."""
        return not self.lines[row].strip(" \t,;\"'")

    def numbers(
        self, first_row: int, n_columns: int, columns: Sequence[int], ends_early: int = 0
    ) -> tuple[np.ndarray, np.ndarray]:
        """Read the rows from ``first_row`` to the end, or to a blank line with text behind it (another section).

        n_columns : cells that a row must have; more are allowed where they are empty
        columns : which cells to read
        ends_early : the last cells of a row may be left out in groups of this many; 0: none may
        returns : float64, shape (F, len(columns)), NaN where a cell is empty, and the line of each frame, from 1.
            Raises `UserFacingError` naming the line of what is no number.
        """
        rows = self._data_rows(first_row)
        self._check_size(rows, n_columns, ends_early)
        comma = self._has_decimal_commas(rows[:_SAMPLED_ROWS], columns)
        table = np.empty((len(rows), len(columns)))
        for f, row in enumerate(rows):
            cells = self.cells(row) if '"' in self.lines[row] else self.lines[row].split(self.delimiter)
            lacking = n_columns - len(cells)
            if lacking > 0 and ends_early and lacking % ends_early == 0:
                cells = [*cells, *[""] * lacking]
            if len(cells) < n_columns or any(cell.strip() for cell in cells[n_columns:]):
                raise UserFacingError(f"'{self.path}', line {row + 1}: {len(cells)} cells; the header has {n_columns}.")
            chosen = [cells[c] for c in columns]
            try:
                if comma:
                    chosen = [cell.replace(",", ".") for cell in chosen]
                table[f] = [float(cell) if cell and not cell.isspace() else np.nan for cell in chosen]
            except ValueError as error:
                wrong = next(cell for cell in chosen if cell.strip() and not is_number(cell))
                message = f"'{self.path}', line {row + 1}: '{wrong.strip()[:40]}' is not a number."
                raise UserFacingError(message) from error
        return table, np.array(rows, int) + 1

    def _data_rows(self, first_row: int) -> range:
        stop = len(self.lines)
        while stop > first_row and self.is_blank(stop - 1):
            stop -= 1
        for row in range(first_row, stop):
            if not self.lines[row].strip():
                follows = next(r for r in range(row, stop) if self.lines[r].strip())
                if is_number(self.cells(follows)[0].replace(",", ".")):
                    raise UserFacingError(f"'{self.path}', line {row + 1} is empty, and more rows follow.")
                return range(first_row, row)
        return range(first_row, stop)

    def _check_size(self, rows: range, n_columns: int, ends_early: int) -> None:
        """Refuse, before memory is asked for, a table that is mostly what its rows leave out."""
        length = sum(len(self.lines[row]) + 1 for row in rows)
        if len(rows) * n_columns <= length * (_SPARSEST if ends_early else 1):
            return
        row = next(row for row in rows if len(self.lines[row]) + 1 < n_columns)
        raise UserFacingError(f"'{self.path}', line {row + 1}: the header has {n_columns} cells, the line has fewer.")

    def _has_decimal_commas(self, rows: range, columns: Sequence[int]) -> bool:
        sample = [cells[c] for row in rows for cells in [self.cells(row)] for c in columns if c < len(cells)]
        return any(map(_DECIMAL_COMMA.fullmatch, sample)) and not any("." in cell for cell in sample)


def read_delimited(path: Path) -> DelimitedText:
    """Read a table of text; .tsv is split at tabs, anything else at what its first lines have most of.

    Raises `UserFacingError` when the file cannot be read, is empty, too large, or no text.
    """
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise UserFacingError(f"'{path}' is larger than 1 GiB.", "Cut it into takes.")
        raw = path.read_bytes()
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    try:
        text = _decoded(raw)
    except UnicodeDecodeError as error:
        raise UserFacingError(f"'{path}' is not a text file of markers.") from error
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if not text.strip() or "\0" in text[:4096]:
        raise UserFacingError(f"'{path}' is empty, or no text.")
    return DelimitedText(path, lines, "\t" if path.suffix.lower() == ".tsv" else _delimiter(lines[:HEAD_LINES]))


def _decoded(raw: bytes) -> str:
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return raw.decode("utf-16")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        # names with accents from an old Windows; a binary file would hold control characters
        if any(byte < 9 for byte in raw[:4096]):
            raise
        return raw.decode("cp1252")


def _delimiter(head: list[str]) -> str:
    """Tab or semicolon where there are about as many of them as of commas, which then are decimal ones."""
    counts = {d: sum(line.count(d) for line in head) for d in "\t;,"}
    return next((d for d in "\t;" if counts[d] and 2 * counts[d] >= counts[","]), ",")


def check_places(points: np.ndarray, lines: np.ndarray, path: Path) -> None:
    """Raise `UserFacingError` for an infinite coordinate and make a point NaN, in place, that lacks an axis.

    points : shape (F, K, 2 or 3); lines : shape (F,), where in the file each frame was
    """
    beyond = np.abs(points) > _LARGEST
    if beyond.any():
        raise UserFacingError(f"'{path}', line {lines[beyond.any(axis=(1, 2)).argmax()]}: a coordinate is infinite.")
    points[np.isnan(points).any(axis=2)] = np.nan


def first_repeated(names: Sequence[str]) -> str | None:
    """Return the first name that comes a second time, or None."""
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None


def is_number(cell: str) -> bool:
    """Tell whether a cell is a number with a decimal point."""
    try:
        float(cell)
    except ValueError:
        return False
    return True
