"""The faces of a database that changes: as they were captured where that was kept, else as its frames show them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from core.motion.captures import GROUP, KeptCapture, read_capture
from core.motion.database import MotionDatabase, damage_told
from core.motion.newcomers import Newcomers
from core.motion.pca import MotionPca


class GrownFaces:
    """Faces by sentence, of the database whose open HDF5 file is ``file``, and of what is added to it."""

    def __init__(self, database: MotionDatabase, file, newcomers: Newcomers | None) -> None:
        self._database, self._file = database, file
        self._new = newcomers.captures if newcomers is not None else {}
        self._newly_captured = newcomers.captured if newcomers is not None else frozenset()
        self._old = {s.name: s for s in database.sentences}

    def of(self, name: str) -> KeptCapture:
        """Return the face of a sentence."""
        if name in self._new:
            return self._new[name]
        capture = self._stored(name)
        if capture is None:
            sentence = self._old[name]
            frames = self._database.frames[sentence.start_frame : sentence.stop_frame]
            face = self._database.pca.positions(frames).astype(np.float32)
            capture = KeptCapture(face, np.zeros(len(face), bool))
        return capture

    def fit(self, names: Iterable[str]) -> MotionPca:
        """Fit components to the sentences ``names``, as many as the database was to have."""
        captures = (self.of(name) for name in names)
        wanted = self._database.report.get("pca_dims")
        n_dims = wanted if type(wanted) is int and wanted > 0 else self._database.pca.n_dims
        return MotionPca.fit((c.face[~c.masked] for c in captures), n_dims)

    def kept(self, names: Iterable[str]) -> Iterator[tuple[str, KeptCapture]]:
        """Yield what is to be stored of the sentences ``names``: nothing, unless the database keeps captures."""
        if not any(f"{GROUP}/{name}" in self._file for name in self._old):
            return
        for name in names:
            capture = self._new[name] if name in self._newly_captured else self._stored(name)
            if capture is not None:
                yield name, capture

    def _stored(self, name: str) -> KeptCapture | None:
        sentence = self._old.get(name)
        if sentence is None:
            return None
        n_frames = sentence.stop_frame - sentence.start_frame
        with damage_told(self._database.path):
            return read_capture(self._file, name, n_frames, len(self._database.markers))
