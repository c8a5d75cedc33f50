"""What a tuning run has already measured, so that a killed one goes on where it was."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.errors import UserFacingError

_FORMAT = "efase-tuning-journal 1"


class TuningJournal:
    """Errors of sentences at points, kept in memory and appended to a file of JSON lines as they come.

    A run asks for the same points in the same order each time, so a resumed one finds the first of them here. What a
    kill left of the last line is dropped. ``path`` None keeps nothing.
    """

    def __init__(self, path: Path | None) -> None:
        self.path = path
        self._known: dict[tuple[bytes, bool, int], float] = {}
        self._file = None
        if path is None:
            return
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            whole = self._read(path) if path.is_file() else 0
            self._file = path.open("r+b" if path.is_file() else "w+b")
            self._file.truncate(whole)
            self._file.seek(whole)
            if not whole:
                self._write({"format": _FORMAT})
        except OSError as error:
            raise UserFacingError(
                f"The tuning's journal '{path}' cannot be written: {error.strerror}.",
                "Let EFASE_CACHE_DIR name a folder that can be written.",
            ) from error

    def _read(self, path: Path) -> int:
        """Take what is whole and return how many bytes that is."""
        whole = 0
        with path.open("rb") as file:
            for number, line in enumerate(file):
                if not line.endswith(b"\n"):
                    break
                try:
                    entry = json.loads(line)
                    if number == 0 and entry["format"] != _FORMAT:
                        break
                    if number:
                        self._keep(entry["point"], entry["exact"], entry["sentences"], entry["errors"])
                except (ValueError, KeyError, TypeError):
                    break
                whole += len(line)
        return whole

    def __len__(self) -> int:
        return len(self._known)

    def error(self, point: np.ndarray, exact: bool, sentence: int) -> float | None:
        """Return a measured error in mm², or None; exact ones are kept apart from those of the walk."""
        return self._known.get((np.asarray(point, float).tobytes(), exact, sentence))

    def add(self, point: np.ndarray, exact: bool, sentences: Sequence[int], errors: Sequence[float]) -> None:
        """Keep the errors of some sentences at a point."""
        self._keep(point, exact, sentences, errors)
        if self._file is not None:
            self._write({"point": np.asarray(point, float).tolist(), "exact": exact, "sentences": list(sentences),
                         "errors": list(errors)})  # fmt: skip

    def _keep(self, point, exact: bool, sentences: Sequence[int], errors: Sequence[float]) -> None:
        key = np.array(point, float).tobytes()
        for sentence, error in zip(sentences, errors, strict=True):
            self._known[key, bool(exact), int(sentence)] = float(error)

    def _write(self, entry: dict) -> None:
        self._file.write(json.dumps(entry).encode() + b"\n")
        self._file.flush()  # the system has it then, and a kill of this process does not take it away

    def close(self, finished: bool = False) -> None:
        """Close the file; a run that is finished leaves none."""
        if self._file is not None:
            self._file.close()
            self._file = None
            if finished:
                os.unlink(self.path)
