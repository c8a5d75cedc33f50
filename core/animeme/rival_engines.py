"""MMM as an engine, on the same components and sentences as the animemes."""

from __future__ import annotations

import numpy as np

from core.animeme.engine import AnimemeAnswer
from core.animeme.material import component_controls, database_examples
from core.animeme.mmm import MmmModel, train_mmm
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion


class MmmEngine:
    """Gaussians of the principal components by phoneme (see `core.animeme.mmm`); emotions are not told apart.

    is_refined : move means and variances by the training error
    """

    name = "mmm"

    def __init__(self, database: MotionDatabase, is_refined: bool = True) -> None:
        self._database, self._is_refined = database, is_refined
        self._model: MmmModel | None = None

    def prepare(self, progress: Progress = SILENT) -> None:
        """Learn the Gaussians."""
        if self._model is None:
            names, mapping = component_controls(self._database)
            examples = database_examples(self._database, names, mapping)
            self._model = train_mmm(examples, is_refined=self._is_refined, progress=progress)

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> AnimemeAnswer:
        """Solve for the smoothest path."""
        self.prepare(progress)
        database = self._database
        curves = self._model.curves(speech.transcript, database.rate_hz)
        positions = database.pca.positions(curves.values).astype(np.float32)
        return AnimemeAnswer(MarkerMotion(positions, database.rate_hz, database.markers), curves)
