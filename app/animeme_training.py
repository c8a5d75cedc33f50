"""`efase train animeme`: captures or an artist's curves in, a file of animemes out."""

from __future__ import annotations

import hashlib
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from app.demo import open_named
from core.animeme.artist_curves import CurveReading, read_artist_examples
from core.animeme.examples import Example
from core.animeme.form import FORMS
from core.animeme.material import component_controls, database_examples, face_controls, key_shape_controls
from core.animeme.training import Trained, train_animemes
from core.errors import UserFacingError
from core.folders import cache_dir
from core.media.swap_in import check_target
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

RIGS = ("arkit", "lips", "components")


@dataclass(frozen=True)
class TrainingJob:
    """Everything that `efase train animeme` was told; see its help.

    reading : of ``curves``
    """

    output: Path
    database: Path | None = None
    corpus: Path | None = None
    curves: tuple[Path, ...] = ()
    reading: CurveReading = field(default_factory=CurveReading)
    rig: str = "arkit"
    form: str = "best"
    n_sentences: int | None = None


def run(job: TrainingJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` for what cannot be learnt from."""
    if job.form not in FORMS:
        raise UserFacingError(f"There is no form '{job.form}' of animemes.", f"Choose one of {', '.join(FORMS)}.")
    if job.rig not in RIGS:
        raise UserFacingError(f"There is no rig '{job.rig}' to learn.", f"Choose one of {', '.join(RIGS)}.")
    if job.curves and (job.corpus or job.database):
        raise UserFacingError("Curves and captures cannot be learnt from at once.", "Train twice.")
    check_target(job.output)
    began = time.perf_counter()
    rest, notes = None, []
    if job.curves:
        examples, notes = read_artist_examples(job.curves, job.reading, progress.part(0.0, 0.5))
        examples = examples[: job.n_sentences]
    elif job.corpus is not None:
        from core.motion.build import build_database
        from core.motion.readers.corpus_folder import read_corpus

        with tempfile.TemporaryDirectory(prefix="efase-train-") as folder:
            corpus = read_corpus(job.corpus, progress.part(0.0, 0.1))
            database = build_database(corpus, Path(folder) / "corpus.h5", progress=progress.part(0.1, 0.3))
            examples, rest = _captured(job, database, progress.part(0.3, 0.5))
    else:
        examples, rest = _captured(job, open_named(job.database, progress.part(0.0, 0.1)), progress.part(0.1, 0.5))
    mapped_s = time.perf_counter() - began
    name = hashlib.sha256(str(job.output.resolve()).encode()).hexdigest()[:16]
    trained = train_animemes(
        examples, FORMS[job.form], rest, journal=cache_dir() / "animemes" / f"{name}.journal.npz",
        progress=progress.part(0.5, 0.98),
    )  # fmt: skip
    trained.model.save(job.output)
    progress.step(1.0, "trained")
    return _answer(job, examples, trained, mapped_s, time.perf_counter() - began) | {"warnings": notes}


def in_words(answer: dict) -> str:
    """Say what was learnt."""
    return (
        f"{answer['output']}: {answer['controls']} controls from {answer['sentences']} sentences, "
        f"{answer['seconds_of_speech']:.0f} s, in {answer['seconds']:.0f} s; residual "
        f"{answer['residual']:.2f} of the controls' own spread, {answer['steps']} steps"
    )


def _captured(
    job: TrainingJob, database: MotionDatabase, progress: Progress
) -> tuple[list[Example], np.ndarray | None]:
    rest = None
    if job.rig == "components":
        names, mapping = component_controls(database)
        rest = database.rest_coefficients
    elif job.rig == "lips":
        names, mapping = key_shape_controls(database)
    else:
        from core.face.default_face import default_face

        names, mapping = face_controls(database, default_face(progress.part(0.0, 0.1)))
    return database_examples(database, names, mapping, job.n_sentences, progress.part(0.1, 1.0)), rest


def _answer(
    job: TrainingJob, examples: Sequence[Example], trained: Trained, mapped_s: float, total_s: float
) -> dict[str, object]:
    model = trained.model
    values = np.concatenate([example.track.values for example in examples]).astype(float)
    moving = values.std(axis=0) > 1e-6
    return {
        "output": str(job.output), "form": job.form, "controls": len(model.names), "names": list(model.names),
        "sentences": len(examples), "frames": len(values), "rate_hz": examples[0].track.rate_hz,
        "seconds_of_speech": float(sum(example.track.duration_s for example in examples)),
        "moving_controls": int(moving.sum()), "steps": trained.n_steps, "residual": trained.residual,
        "seconds_to_map": round(mapped_s, 2), "seconds": round(total_s, 2), "content": model.content,
    }  # fmt: skip
