"""What a tuning run has already measured, so that a killed one goes on where it was."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.batch.journal import LineJournal

_FORMAT = "efase-tuning-journal 1"


class TuningJournal:
    """Errors of sentences at points, kept in memory and appended to a file of JSON lines as they come.

    A run asks for the same points in the same order each time, so a resumed one finds the first of them here. What a
    kill left of the last line is dropped. ``path`` None keeps nothing.
    """

    def __init__(self, path: Path | None) -> None:
        self._known: dict[tuple[bytes, bool, int], float] = {}
        self._lines = None if path is None else LineJournal(
            path, _FORMAT, self._take, "The tuning's journal", "Let EFASE_CACHE_DIR name a folder that can be written."
        )  # fmt: skip

    def _take(self, entry: dict) -> None:
        self._keep(entry["point"], entry["exact"], entry["sentences"], entry["errors"])

    def __len__(self) -> int:
        return len(self._known)

    def error(self, point: np.ndarray, exact: bool, sentence: int) -> float | None:
        """Return a measured error in mm², or None; exact ones are kept apart from those of the walk."""
        return self._known.get((np.asarray(point, float).tobytes(), exact, sentence))

    def add(self, point: np.ndarray, exact: bool, sentences: Sequence[int], errors: Sequence[float]) -> None:
        """Keep the errors of some sentences at a point."""
        self._keep(point, exact, sentences, errors)
        if self._lines is not None:
            self._lines.write({"point": np.asarray(point, float).tolist(), "exact": exact,
                               "sentences": list(sentences), "errors": list(errors)})  # fmt: skip

    def _keep(self, point, exact: bool, sentences: Sequence[int], errors: Sequence[float]) -> None:
        key = np.array(point, float).tobytes()
        for sentence, error in zip(sentences, errors, strict=True):
            self._known[key, bool(exact), int(sentence)] = float(error)

    def close(self, finished: bool = False) -> None:
        """Close the file; a run that is finished leaves none."""
        if self._lines is not None:
            self._lines.close()
            if finished:
                self._lines.path.unlink()
            self._lines = None
