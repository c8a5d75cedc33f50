"""How far a training has come, kept in a file after each step, so that one that was cut goes on where it was."""

from __future__ import annotations

import contextlib
import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.animeme.damping import START
from core.errors import UserFacingError
from core.face.face_file import UNREADABLE, read_arrays, write_arrays


@dataclass(frozen=True, eq=False)
class WidthState:
    """Widths of one group of controls after some steps.

    log_widths : float64, shape (2, n_phonemes); damping : of the next step; losses : the start's, then each step's
    """

    log_widths: np.ndarray
    damping: float = START
    losses: tuple[float, ...] = ()
    is_done: bool = False


class TrainingJournal:
    """States by group. ``key`` says what is trained and how; a file of another key is not read. None keeps nothing."""

    def __init__(self, path: Path | None, key: str) -> None:
        self.path = path
        self._key = hashlib.sha256(key.encode()).hexdigest()
        self._states: dict[int, WidthState] = {}
        if path is not None and path.is_file():
            with contextlib.suppress(*UNREADABLE):  # a damaged journal only costs the time that it would have saved
                self._read(read_arrays(path))

    def _read(self, arrays: dict[str, np.ndarray]) -> None:
        if str(arrays["key"]) != self._key:
            return
        self._states = {
            int(g): WidthState(
                arrays[f"widths_{g}"], float(arrays[f"damping_{g}"]), tuple(arrays[f"losses_{g}"].tolist()),
                bool(arrays[f"done_{g}"]),
            )
            for g in arrays["groups"]
        }  # fmt: skip

    def state(self, group: int) -> WidthState | None:
        """Return how far ``group`` has come; None when nothing is known of it."""
        return self._states.get(group)

    def keep(self, group: int, state: WidthState) -> None:
        """Keep a state; raises `UserFacingError` when the file cannot be written."""
        self._states[group] = state
        if self.path is None:
            return
        arrays = {"key": np.str_(self._key), "groups": np.array(sorted(self._states))}
        for g, known in self._states.items():
            arrays |= {f"widths_{g}": known.log_widths, f"damping_{g}": np.float64(known.damping),
                       f"losses_{g}": np.array(known.losses), f"done_{g}": np.bool_(known.is_done)}  # fmt: skip
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            write_arrays(self.path, **arrays)
        except OSError as error:
            raise UserFacingError(
                f"The training's journal '{self.path}' cannot be written: {error.strerror}.",
                "Let EFASE_CACHE_DIR name a folder that can be written.",
            ) from error

    def close(self) -> None:
        """Forget the file: the training has ended."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)
