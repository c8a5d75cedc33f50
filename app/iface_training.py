"""`efase train iface`: a motion database in, a face that speaks what it hears out."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from app.demo import open_named
from core.errors import UserFacingError
from core.iface.default_model import keep_default_model
from core.iface.model_file import MODEL_SUFFIX, save_model
from core.iface.paper_face import PaperFace
from core.iface.training import check_variant, train_face
from core.media.swap_in import check_target
from core.progress import SILENT, Progress


@dataclass(frozen=True)
class TrainingJob:
    """Everything that `efase train iface` was told; see its help."""

    output: Path | None = None
    database: Path | None = None
    variant: str = "modern"
    seed: int = 0


def run(job: TrainingJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` for what cannot be learnt from."""
    check_variant(job.variant)
    if job.output is not None:
        if job.output.suffix.lower() != MODEL_SUFFIX:  # a slip of the pen must not cost the database
            raise UserFacingError(
                f"'{job.output}' is not a name for a speaking face.", f"Let it end in {MODEL_SUFFIX}."
            )
        check_target(job.output)
    database = open_named(job.database, progress.part(0.0, 0.1))
    began = time.perf_counter()
    model = train_face(database, job.variant, job.seed, progress.part(0.1, 1.0))
    seconds = time.perf_counter() - began
    if job.output is None:
        path = keep_default_model(model, database)
    else:
        path = job.output
        save_model(model, path)
    face = model.face
    return {
        "output": str(path), "variant": model.variant, "seed": model.seed, "database": model.database,
        "content_hash": model.content_hash, "sentences": len(database.sentences),
        "seconds_of_speech": float(sum(s.transcript.duration_s for s in database.sentences)),
        "expressions": list(face.expressions),
        "units": {state: face.units.n_parameters(state) for state in ("neutral", *face.expressions)},
        "classes": list(face.classes.phones) if isinstance(face, PaperFace) else None,
        "look_ahead_ms": round(1000 * face.n_ahead / 30, 1), "seconds": round(seconds, 2),
    }  # fmt: skip


def in_words(answer: dict) -> str:
    """Say what was learnt."""
    shown = ", ".join(f"{n} for {state}" for state, n in answer["units"].items())
    classes = f"; {len(answer['classes'])} classes of sound" if answer["classes"] else ""
    return (
        f"{answer['output']}: the {answer['variant']} face of '{answer['database']}', from {answer['sentences']} "
        f"sentences, {answer['seconds_of_speech']:.0f} s, in {answer['seconds']:.0f} s; motion units: {shown}{classes}"
    )
