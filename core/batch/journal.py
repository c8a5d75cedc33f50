"""A file of JSON lines that grows as work is finished, and tells a later run what it need not do again."""

from __future__ import annotations

import json
from pathlib import Path

from core.errors import UserFacingError


class Journal:
    """Entries by key; what a kill left of the last line is dropped.

    path : the file; kind : of the journal, its first line; a file of another kind is begun anew
    """

    def __init__(self, path: Path, kind: str) -> None:
        self.path = path
        self.entries: dict[str, dict] = {}
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            whole = self._read(kind) if path.is_file() else 0
            self._file = path.open("r+b" if path.is_file() else "w+b")
            self._file.truncate(whole)
            self._file.seek(whole)
            if not whole:
                self._write({"format": kind})
        except OSError as error:
            raise UserFacingError(f"The journal '{path}' cannot be written: {error.strerror}.") from error

    def _read(self, kind: str) -> int:
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
                        self.entries[entry["key"]] = entry
                except (ValueError, KeyError, TypeError):
                    break
                whole += len(line)
        return whole

    def add(self, key: str, **entry: object) -> None:
        """Keep an entry; the system has it when this returns."""
        self.entries[key] = {"key": key, **entry}
        self._write(self.entries[key])

    def _write(self, entry: dict) -> None:
        self._file.write(json.dumps(entry).encode() + b"\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def __enter__(self) -> Journal:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
