"""The first sheet of an .xlsx workbook as rows of texts.

Written out here, on zipfile and the standard XML parser, rather than left to openpyxl: two small members are all that
is wanted, and of a file from elsewhere no more than 4 MiB each is unpacked, no document type is obeyed, and no row or
column is made because a cell's address names it. Format: ECMA-376, part 1, sections 18.3 and 18.4.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from pathlib import Path
from xml.etree import ElementTree

from core.errors import UserFacingError
from core.motion.readers.archive import TooLarge, read_member

_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_STRINGS = "xl/sharedStrings.xml"
_LARGEST_FILE = 16 << 20
_LARGEST_MEMBER = 4 << 20
_MOST_ROWS, _MOST_COLUMNS = 20_000, 256
_ADDRESS = re.compile(r"([A-Z]{1,3})(\d{1,7})")
_UNREADABLE = (
    OSError, ValueError, EOFError, KeyError, IndexError, NotImplementedError, RuntimeError, zipfile.BadZipFile,
    zlib.error, ElementTree.ParseError,
)  # fmt: skip


def read_sheet(path: Path) -> list[list[str]]:
    """Return the rows of the first sheet up to their last filled cell, "" for empty cells.

    Raises `UserFacingError` for what is missing, damaged, or larger than a table of names should be.
    """
    try:
        size = path.stat().st_size
        if size > _LARGEST_FILE:
            raise UserFacingError(f"'{path}' is too large for a table of names.")
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            members = set(archive.namelist())
            sheets = sorted(name for name in members if re.fullmatch(r"xl/worksheets/sheet\d{1,4}\.xml", name))
            if not sheets:
                raise UserFacingError(f"'{path}' has no sheet.")
            first = min(sheets, key=lambda name: int(re.findall(r"\d+", name)[0]))
            strings = _strings(_member(archive, _STRINGS, size)) if _STRINGS in members else []
            return _rows(_member(archive, first, size), strings, path)
    except TooLarge as error:
        raise UserFacingError(f"'{path}' is too large for a table of names.") from error
    except _UNREADABLE as error:
        raise UserFacingError(f"'{path}' is no readable workbook.") from error


def _member(archive: zipfile.ZipFile, name: str, archive_bytes: int) -> ElementTree.Element:
    raw = read_member(archive, archive.getinfo(name), archive_bytes, _LARGEST_MEMBER)
    # entities that unfold into gigabytes are declared in one
    if b"<!DOCTYPE" in raw or b"<!ENTITY" in raw:
        raise ValueError("it declares entities")
    return ElementTree.fromstring(raw)


def _strings(root: ElementTree.Element) -> list[str]:
    return ["".join(text.text or "" for text in item.iter(f"{_MAIN}t")) for item in root.iter(f"{_MAIN}si")]


def _rows(root: ElementTree.Element, strings: list[str], path: Path) -> list[list[str]]:
    rows: dict[int, dict[int, str]] = {}
    for cell in root.iter(f"{_MAIN}c"):
        match = _ADDRESS.fullmatch(cell.get("r", ""))
        text = _text(cell, strings)
        if match is None or not text:
            continue
        column = 0
        for letter in match[1]:
            column = 26 * column + ord(letter) - ord("A") + 1
        row = int(match[2])
        if row > _MOST_ROWS or column > _MOST_COLUMNS:
            raise UserFacingError(f"'{path}' is too large for a table of names.")
        rows.setdefault(row, {})[column] = text
    return [[rows[row].get(c, "") for c in range(1, max(rows[row]) + 1)] for row in sorted(rows)]


def _text(cell: ElementTree.Element, strings: list[str]) -> str:
    if cell.get("t") == "inlineStr":
        return "".join(text.text or "" for text in cell.iter(f"{_MAIN}t")).strip()
    value = cell.find(f"{_MAIN}v")
    if value is None or not value.text:
        return ""
    if cell.get("t") != "s":
        return value.text.strip()
    index = int(value.text)
    if index < 0:
        raise IndexError(index)
    return strings[index].strip()
