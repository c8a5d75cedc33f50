"""Files of JSON lines that grow as work is finished, and tell a later run what it need not do again."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from core.errors import UserFacingError


class LineJournal:
    """A file whose first line names its kind, and whose others were each written whole or are dropped.

    path : the file; kind : a file of another kind is begun anew
    take : gets every entry that is there; what raises ValueError, KeyError or TypeError in it ends the reading, and
        the rest is dropped as what a kill left
    title, remedy : begin and end the sentence of the `UserFacingError` for what cannot be written
    """

    def __init__(
        self, path: Path, kind: str, take: Callable[[dict], None], title: str = "The journal", remedy: str = ""
    ) -> None:
        self.path = path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            whole = self._read(kind, take) if path.is_file() else 0
            self._file = path.open("r+b" if path.is_file() else "w+b")
            self._file.truncate(whole)
            self._file.seek(whole)
            if not whole:
                self.write({"format": kind})
        except OSError as error:
            raise UserFacingError(f"{title} '{path}' cannot be written: {error.strerror}.", remedy) from error

    def _read(self, kind: str, take: Callable[[dict], None]) -> int:
        """Take what is whole and return how many bytes that is."""
        whole = 0
        with self.path.open("rb") as file:
            for number, line in enumerate(file):
                if not line.endswith(b"\n"):
                    break
                try:
                    entry = json.loads(line)
                    if number == 0 and entry["format"] != kind:
                        break
                    if number:
                        take(entry)
                except (ValueError, KeyError, TypeError):
                    break
                whole += len(line)
        return whole

    def write(self, entry: dict) -> None:
        """Append ``entry``; the system has it when this returns, and a kill of this process does not take it away."""
        self._file.write(json.dumps(entry).encode() + b"\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


class Journal:
    """Entries by key, the newest of a key; path and kind as of `LineJournal`."""

    def __init__(self, path: Path, kind: str) -> None:
        self.entries: dict[str, dict] = {}
        self._lines = LineJournal(path, kind, self._take)

    def _take(self, entry: dict) -> None:
        self.entries[entry["key"]] = entry

    def add(self, key: str, **entry: object) -> None:
        """Keep an entry; the system has it when this returns."""
        self.entries[key] = {"key": key, **entry}
        self._lines.write(self.entries[key])

    def close(self) -> None:
        """Close the file."""
        self._lines.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
