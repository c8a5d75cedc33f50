"""Answers of a perception study as the paper's tables III to VII, with confidence intervals."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from core.evaluation.proportions import CONFIDENCE, share_interval
from core.evaluation.stimuli import AUDIO, BIMODAL, CAPTURED, NOT_SURE, SILENT, SYNTHETIC, Stimulus
from core.evaluation.stimuli_files import Answers

_FIRST = 3  # the paper's tables I and II measure the mapping
_ROMAN = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))
_LETTERS = {SYNTHETIC: "S", CAPTURED: "R"}
_NARROW, _WIDE = 11, 22
CSV_COLUMNS = ("table", "title", "condition", "face", "answer", "count", "of", "share", "low", "high")


@dataclass(frozen=True)
class Cell:
    """How many of those asked gave one answer, and the interval (0..1) of the true share."""

    count: int
    of: int
    low: float
    high: float


@dataclass(frozen=True)
class AnswerTable:
    """One table.

    number : as the paper counts, "III", "IV" …
    columns : (condition, face) each: an expression and `SYNTHETIC` or `CAPTURED`, or an audio and nothing
    answers : the rows, the study's expressions and `NOT_SURE`
    cells : row by row
    """

    number: str
    title: str
    columns: tuple[tuple[str, str | None], ...]
    answers: tuple[str, ...]
    cells: tuple[tuple[Cell, ...], ...]


def answer_tables(answers: Answers, interval: str = "wilson", confidence: float = CONFIDENCE) -> list[AnswerTable]:
    """Return the tables: silent faces (III), audio alone (IV), and one for each audio with faces (V, VI, VII, …).

    interval : see `core.evaluation.proportions.share_interval`; each participant answers a stimulus once, so a cell's
        answers are of different people, and the interval of each cell is that of one share

    A table that nobody was asked for is left out.
    """
    faces = [(e, f) for e in answers.expressions for f in answers.faces]
    asked = [("silent faces", faces, lambda c, s: s.kind == SILENT and (s.expression, s.face) == c)]
    audios = [(track, None) for track in answers.tracks]
    asked.append(("audio alone", audios, lambda c, s: s.kind == AUDIO and s.track == c[0]))
    asked += [(_title(answers, track), faces, _with(track)) for track in answers.tracks]
    tables = []
    for n, (title, columns, belongs) in enumerate(asked):
        table = _table(answers, _roman(_FIRST + n), title, columns, belongs, interval, confidence)
        if any(cell.of for row in table.cells for cell in row):
            tables.append(table)
    return tables


def _with(track: str) -> Callable[[tuple, Stimulus], bool]:
    return lambda c, s: s.kind == BIMODAL and s.track == track and (s.expression, s.face) == c


def _title(answers: Answers, track: str) -> str:
    return f"faces with audio {track}" + (f", “{answers.texts[track]}”" if answers.texts[track] else "")


def _table(answers, number, title, columns, belongs, interval, confidence) -> AnswerTable:
    names = (*answers.expressions, NOT_SURE)
    said = [[a.answer for a in answers.given if belongs(column, a.stimulus)] for column in columns]
    cells = tuple(
        tuple(
            Cell(count := column.count(name), len(column), *share_interval(count, len(column), interval, confidence))
            for column in said
        )
        for name in names
    )
    return AnswerTable(number, title, tuple(columns), names, cells)


def as_text(tables: Sequence[AnswerTable]) -> str:
    """Return the tables to be read: counts, and under each the share's interval in percent."""
    return "\n\n".join(_one_as_text(table) for table in tables)


def _one_as_text(table: AnswerTable) -> str:
    width = _NARROW if any(face for _, face in table.columns) else _WIDE
    lines = [f"TABLE {table.number}: {table.title}"]
    heads = [[condition for condition, _ in table.columns], [_LETTERS.get(face, "") for _, face in table.columns]]
    # the expression stands over the first of its faces
    heads[0] = [name if n == 0 or heads[0][n - 1] != name else "" for n, name in enumerate(heads[0])]
    for head in heads:
        if any(head):
            lines.append(" " * 12 + "".join(f"{name[: width - 1]:>{width}}" for name in head))
    for answer, row in zip(table.answers, table.cells):
        lines.append(f"{answer:<12}" + "".join(f"{cell.count:>{width}}" for cell in row))
        spans = [f"{100 * cell.low:.0f}–{100 * cell.high:.0f} %" if cell.of else "–" for cell in row]
        lines.append(" " * 12 + "".join(f"{span:>{width}}" for span in spans))
    lines.append(f"{'asked':<12}" + "".join(f"{cell.of:>{width}}" for cell in table.cells[0]))
    return "\n".join(lines)


def as_csv(tables: Sequence[AnswerTable]) -> str:
    """Return all cells as CSV, a row each."""
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    writer.writerow(CSV_COLUMNS)
    for row in as_rows(tables):
        writer.writerow(["" if row[column] is None else row[column] for column in CSV_COLUMNS])
    return written.getvalue()


def as_rows(tables: Sequence[AnswerTable]) -> list[dict[str, object]]:
    """Return all cells as objects with the keys `CSV_COLUMNS`; share is None where nobody was asked."""
    return [
        {
            "table": table.number, "title": table.title, "condition": condition, "face": face, "answer": answer,
            "count": cell.count, "of": cell.of, "share": round(cell.count / cell.of, 6) if cell.of else None,
            "low": round(cell.low, 6), "high": round(cell.high, 6),
        }
        for table in tables
        for answer, cells in zip(table.answers, table.cells)
        for (condition, face), cell in zip(table.columns, cells)
    ]  # fmt: skip


def _roman(number: int) -> str:
    written = ""
    for value, letters in _ROMAN:
        while number >= value:
            written, number = written + letters, number - value
    return written
