"""Animemes as an engine: a transcript in, marker motion out, through models of the markers' principal components."""

from __future__ import annotations

import contextlib
import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.animeme.animeme import AnimemeModel, load_animemes
from core.animeme.form import BEST, AnimemeForm
from core.animeme.material import component_controls, database_examples
from core.animeme.training import TrainingSettings, train_animemes
from core.errors import UserFacingError
from core.folders import cache_dir
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion

_VERSION = 1  # raise it when training changes, so that cached models are not taken for new ones


@dataclass(frozen=True)
class AnimemeAnswer:
    """Motion, the curves of the components that made it, and the animemes that these are of, if they are.

    holds : whether dragged sounds were kept at their middle
    """

    motion: MarkerMotion
    curves: ControlTrack
    model: AnimemeModel | None = None
    holds: bool = False
    warnings: tuple[str, ...] = ()


class AnimemeEngine:
    """Dominated animemes of a database's principal components.

    All markers, not the lips alone, are synthesised: what phonemes do not move (lids, brows) comes out near its mean.
    The model is learnt on first use and kept in the cache, by the content of the database. Slots that ask for a mix of
    emotions get that mix of their animemes.

    model : a trained model of these components; None learns or reads the default one
    """

    name = "animeme"

    def __init__(self, database: MotionDatabase, form: AnimemeForm = BEST, model: AnimemeModel | None = None) -> None:
        self.database, self.form = database, form
        self._names = component_controls(database)[0]
        if model is not None and model.names != self._names:
            raise UserFacingError(
                f"These animemes drive {', '.join(model.names[:3])} …, not the components of '{database.name}'."
            )
        self._model = model

    @property
    def model(self) -> AnimemeModel:
        """The model, learnt now if it was not yet."""
        self.prepare()
        return self._model

    def prepare(self, progress: Progress = SILENT) -> None:
        """Learn the model, or read it from an earlier time; a cache that cannot be read or written only costs time."""
        if self._model is None:
            self._model = component_animemes(self.database, self.form, progress)

    def synthesise(self, speech: SpeechInput, progress: Progress = SILENT) -> AnimemeAnswer:
        """Evaluate equation 1 at the rate of the database."""
        self.prepare(progress.part(0.0, 0.9))
        database = self.database
        curves = self._model.curves(speech.transcript, database.rate_hz, speech.modifiers, holds=speech.holds)
        positions = database.pca.positions(curves.values).astype(np.float32)
        return AnimemeAnswer(
            MarkerMotion(positions, database.rate_hz, database.markers), curves, self._model, speech.holds
        )


def component_animemes(database: MotionDatabase, form: AnimemeForm = BEST, progress: Progress = SILENT) -> AnimemeModel:
    """Return the animemes of a database's components, from the cache if they were learnt before.

    An error of one component counts as that of another, for all are in mm of marker motion.
    """
    path = _cache_path(database, form)
    names, mapping = component_controls(database)
    with contextlib.suppress(UserFacingError):  # missing or damaged: it is learnt anew
        model = load_animemes(path)
        if model.names == names:
            return model
    examples = database_examples(database, names, mapping, progress=progress.part(0.0, 0.1))
    spread = float(np.sqrt(database.pca.variance.sum()))
    model = train_animemes(
        examples, form, database.rest_coefficients, importance=np.full(len(names), 1.0 / max(spread, 1e-9)),
        progress=progress.part(0.1, 1.0),
    ).model  # fmt: skip
    with contextlib.suppress(OSError, UserFacingError):  # without a cache it is learnt again next time
        path.parent.mkdir(parents=True, exist_ok=True)
        model.save(path)
    return model


def _cache_path(database: MotionDatabase, form: AnimemeForm) -> Path:
    said = f"animemes {_VERSION} {database.content_hash} {form} {TrainingSettings()}"
    return cache_dir() / "animemes" / f"{hashlib.sha256(said.encode()).hexdigest()[:32]}.npz"
