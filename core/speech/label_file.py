"""Label files: one phone a line, in the three ways that speech tools write them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from core.errors import UserFacingError
from core.speech.text_file import seconds
from core.speech.timed_label import TimedLabel

_HTK_UNIT_S = 1e-7
# Whole numbers as large as this are HTK's 100 ns: as seconds they would be hours.
_SMALLEST_HTK_END = 10_000
_COLUMNS = re.compile(r"[\s,;]+")
_WHOLE = re.compile("[0-9]+")


def parse_labels(text: str, name: str) -> list[TimedLabel]:
    """Return the labels of Festival/xwaves (``end colour phone`` below a line ``#``), HTK (``start end phone`` in
    100 ns) or plain seconds (``start end phone``; lines that begin with ``#`` are comments).

    name : what messages call the file
    Raises `UserFacingError` naming the line that is none of these.
    """
    lines = text.split("\n")
    bare = [line.strip() for line in lines]
    if "#" in bare:
        return _xwaves(bare, bare.index("#") + 1, name)
    rows = list(_rows(bare, 0, name, "start end phone"))
    rows = [(place, columns) for place, columns in rows if columns[:2] != ["start", "end"]]
    is_htk = all(_WHOLE.fullmatch(column) for _, columns in rows for column in columns[:2]) and any(
        float(columns[1]) >= _SMALLEST_HTK_END for _, columns in rows
    )
    unit_s = _HTK_UNIT_S if is_htk else 1.0
    return [
        TimedLabel(columns[2], seconds(columns[0], place) * unit_s, seconds(columns[1], place) * unit_s, place)
        for place, columns in rows
    ]


def _xwaves(lines: list[str], first: int, name: str) -> list[TimedLabel]:
    labels = []
    start_s = 0.0
    for place, columns in _rows(lines, first, name, "end colour phone"):
        end_s = seconds(columns[0], place)
        labels.append(TimedLabel(columns[2], start_s, end_s, place))
        start_s = end_s
    return labels


def _rows(lines: list[str], first: int, name: str, expected: str) -> Iterator[tuple[str, list[str]]]:
    for number, line in enumerate(lines[first:], start=first + 1):
        if not line or line.startswith("#"):
            continue
        columns = _COLUMNS.split(line)
        if len(columns) < 3:
            raise UserFacingError(f"{name}, line {number}: '{line[:40]}' is not '{expected}'.")
        yield f"{name}, line {number}", columns
