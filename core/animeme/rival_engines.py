"""MMM as an engine, on the same components and sentences as the animemes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from core.animeme.engine import AnimemeAnswer
from core.animeme.material import component_controls, database_examples
from core.animeme.mmm import MmmModel, train_mmm
from core.animeme.utterances import Nearby, Utterances
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.speech.emotion import EMOTIONS
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion


class MmmEngine:
    """Gaussians of the principal components by phoneme (see `core.animeme.mmm`), emotion by emotion.

    Where a mix of emotions is asked for, their curves are mixed. An emotion that was not captured is spoken like the
    first that was.
    """

    name = "mmm"

    def __init__(self, database: MotionDatabase) -> None:
        self._database = database
        self._models: dict[str, MmmModel] = {}

    def prepare(self, progress: Progress = SILENT) -> None:
        """Learn the Gaussians."""
        if self._models:
            return
        names, mapping = component_controls(self._database)
        examples = database_examples(self._database, names, mapping)
        felt = [emotion for emotion in EMOTIONS if any(e.emotion == emotion for e in examples)]
        for i, emotion in enumerate(felt):
            stage = progress.part(i / len(felt), (i + 1) / len(felt))
            self._models[emotion] = train_mmm([e for e in examples if e.emotion == emotion], progress=stage)

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> AnimemeAnswer:
        """Solve for the smoothest path of each emotion that is asked for."""
        self.prepare(progress)
        database, rate_hz = self._database, self._database.rate_hz
        utterances = Utterances.of([speech.transcript], [speech.modifiers])
        n_frames = max(1, round(speech.transcript.duration_s * rate_hz))
        said = Nearby.of(utterances, [np.arange(n_frames) / rate_hz], 0).utterance
        values = 0.0
        for e, emotion in enumerate(EMOTIONS):
            share = utterances.emotions[said, e]
            if share.any():
                model = self._models.get(emotion) or next(iter(self._models.values()))
                curves = model.curves(speech.transcript, rate_hz)
                values = values + share[:, None] * curves.values
        positions = database.pca.positions(values).astype(np.float32)
        return AnimemeAnswer(MarkerMotion(positions, rate_hz, database.markers), replace(curves, values=values))
