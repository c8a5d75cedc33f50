"""Small text files as users have them: any Unicode encoding, any line ends."""

from __future__ import annotations

import codecs
import math
from pathlib import Path

from core.errors import UserFacingError

LARGEST_BYTES = 32_000_000


def read_text(path: str | Path, kind: str) -> str:
    """Return the text of a file: UTF-8, UTF-16 (with or without byte order mark), else Latin-1.

    kind : what the file should be, for messages ("transcript")
    Raises `UserFacingError` when it is missing, not a file, empty, or far too large to be a ``kind``.
    """
    path = Path(path)
    try:
        if not path.exists():
            raise UserFacingError(f"There is no {kind} '{path}'.")
        if not path.is_file():
            raise UserFacingError(f"The {kind} '{path}' is not a file.")
        if path.stat().st_size > LARGEST_BYTES:
            raise UserFacingError(f"'{path}' is too large for a {kind}.")
        raw = path.read_bytes()
    except OSError as error:
        raise UserFacingError(f"The {kind} '{path}' cannot be read: {error.strerror or error}.") from error
    text = _decoded(raw).replace("\r\n", "\n").replace("\r", "\n")
    if not text.strip():
        raise UserFacingError(f"The {kind} '{path}' is empty.")
    return text


def seconds(text: str, place: str) -> float:
    """Return a time in seconds; raises `UserFacingError` naming ``place`` when it is no finite number >= 0."""
    try:
        time_s = float(text)
    except ValueError:
        time_s = math.nan
    if not math.isfinite(time_s) or time_s < 0:
        raise UserFacingError(f"{place}: '{text[:20]}' is not a time.")
    return time_s


def _decoded(raw: bytes) -> str:
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return raw.decode("utf-16", errors="replace")
    if raw[1:2] == b"\0" or raw[:1] == b"\0":
        return raw.decode("utf-16-le" if raw[1:2] == b"\0" else "utf-16-be", errors="replace")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")
