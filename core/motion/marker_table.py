"""The table that says what part each marker plays: ``marker,kept,groups,landmark``."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path

from core.errors import UserFacingError
from core.motion.marker_set import LANDMARKS
from core.speech.text_file import read_text


@dataclass(frozen=True)
class MarkerTable:
    """Kept markers in order, their groups and their anatomical landmarks (see `core.motion.marker_set.MarkerSet`)."""

    kept: tuple[str, ...]
    groups: dict[str, tuple[str, ...]]
    landmarks: dict[str, str]


def read_marker_table(path: Path) -> MarkerTable:
    """Read a marker table; the columns ``kept`` (1 or 0), ``groups`` (split by ;) and ``landmark`` may be absent.

    Raises `UserFacingError` naming the line of a bad row.
    """
    return parse_marker_table(read_text(path, "marker table"), str(path))


def parse_marker_table(text: str, source: str) -> MarkerTable:
    """See `read_marker_table`; ``source`` names the text in messages."""
    try:
        return _table(csv.DictReader(line for line in io.StringIO(text) if not line.startswith("#")), source)
    except csv.Error as error:
        raise UserFacingError(f"The marker table '{source}' cannot be read as a table: {error}.") from error


def _table(rows: csv.DictReader, source: str) -> MarkerTable:
    if "marker" not in (rows.fieldnames or ()):
        raise UserFacingError(f"The marker table '{source}' has no column 'marker' in its header.")
    kept: list[str] = []
    groups: dict[str, list[str]] = {}
    landmarks: dict[str, str] = {}
    for row in rows:
        name = (row["marker"] or "").strip()
        if not name or name in kept:
            raise UserFacingError(f"Line {rows.line_num} of '{source}' has no marker name, or one used before.")
        if (row.get("kept") or "1").strip() != "1":
            continue
        kept.append(name)
        for group in filter(None, (part.strip() for part in (row.get("groups") or "").split(";"))):
            groups.setdefault(group, []).append(name)
        anatomy = (row.get("landmark") or "").strip()
        if anatomy:
            if anatomy not in LANDMARKS:
                raise UserFacingError(f"Line {rows.line_num} of '{source}': '{anatomy}' is no landmark.")
            landmarks[anatomy] = name
    if not kept:
        raise UserFacingError(f"The marker table '{source}' keeps no marker.")
    return MarkerTable(tuple(kept), {g: tuple(m) for g, m in groups.items()}, landmarks)
