"""iFACE as an engine: it goes by the sound alone, and needs to know neither words nor phones."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.iface.default_model import default_model
from core.iface.expression_ease import eased_strengths
from core.iface.model_file import MODERN, load_model
from core.iface.motion_unit import NEUTRAL
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ, speech_features
from core.motion.database import MotionDatabase
from core.motion.resample import resample
from core.progress import SILENT, Progress
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion


@dataclass(frozen=True)
class IfaceAnswer:
    """Motion, and which expressions could not be shown."""

    motion: MarkerMotion
    warnings: tuple[str, ...] = ()


class IfaceEngine:
    """A face that speaks what it hears (Hong, Wen and Huang 2002), with the expressions that are painted.

    Painted spans come and go smoothly, as they do live. An expression that the database has no captures of is left out,
    and told.

    variant : ``modern`` or ``paper``; face : a trained one, None for the database's own, trained on first use
    """

    def __init__(self, database: MotionDatabase, variant: str = MODERN, face: SpeakingFace | None = None) -> None:
        self.name = "iface" if variant == MODERN else f"iface-{variant}"
        self.database, self.variant = database, variant
        self._face = face

    @classmethod
    def of_file(cls, database: MotionDatabase, path: Path) -> IfaceEngine:
        """Make the engine of a face that `efase train iface` wrote; raises `UserFacingError` when it does not fit."""
        model = load_model(path)
        if model.markers != database.markers.names:
            raise UserFacingError(
                f"The face in '{path}' moves other markers than those of the database '{database.name}'.",
                "Train one on this database.",
            )
        return cls(database, model.variant, model.face)

    def prepare(self, progress: Progress = SILENT) -> None:
        """Read the face of the database, or train it."""
        if self._face is None:
            self._face = default_model(self.database, progress, self.variant)

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> IfaceAnswer:
        """Listen to ``speech.audio``; raises `UserFacingError` when there is none."""
        if speech.audio is None:
            raise UserFacingError("There is no sound, and this engine goes by the sound alone.", "Load the sound too.")
        self.prepare(progress.part(0.0, 0.9))
        database, face = self.database, self._face
        duration_s = speech.transcript.duration_s
        n_heard = math.ceil(duration_s * RATE_HZ) + 1
        features = speech_features(speech.audio, n_heard)
        strengths = eased_strengths(face.expressions, speech.modifiers, n_heard)
        shown = face.motion(features, strengths)
        n_frames = max(1, round(duration_s * database.rate_hz))
        positions = resample(shown, RATE_HZ, database.rate_hz, n_frames).astype(np.float32)
        painted = dict.fromkeys(m.emotion for m in speech.modifiers if m.intensity > 0 and m.emotion != NEUTRAL)
        warnings = tuple(
            f"The database '{database.name}' has no captures of {emotion}, so it is not shown."
            for emotion in painted if emotion not in face.expressions
        )  # fmt: skip
        return IfaceAnswer(MarkerMotion(positions, database.rate_hz, database.markers), warnings)
