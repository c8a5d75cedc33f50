"""`efase export`: the motion of a project to files, without the window, and the same motion as in it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from app.export import VideoSettings, check_outputs, rounded_seconds, write_outputs
from app.loading import open_motion_database
from app.project_jobs import database_differences, find_database
from app.synthesis import phoneme_rows
from core.document.document import Document
from core.document.parts import DEFAULT_FACE
from core.document.project_file import read_project
from core.errors import UserFacingError
from core.media.video import FRAME_RATES
from core.progress import SILENT, Progress
from core.rig.control_layer import laid_over
from core.synthesis.registry import make_engine


@dataclass(frozen=True)
class ExportJob:
    """Everything that `efase export` was told.

    database : instead of the one that the project names
    size, style, background, span_s : as in `app.export.VideoSettings`; without a style it is ``face``, or ``markers``
        for a project without a face
    """

    project: Path
    outputs: tuple[Path, ...]
    database: Path | None = None
    size: tuple[int, int] = (800, 600)
    style: str | None = None
    background: tuple[float, float, float] | None = None
    span_s: tuple[float, float] | None = None


def run(job: ExportJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is half-written."""
    check_outputs(list(job.outputs))
    content, audio = read_project(job.project)
    if audio is None:
        raise UserFacingError(f"'{job.project}' has no speech yet.", "Choose speech in the window first.")
    if job.database is not None:
        opened = open_motion_database(job.database, progress.part(0.0, 0.2))
    elif content.database is None:
        raise UserFacingError(f"'{job.project}' names no motion database.", "Name one with --db.")
    else:
        try:
            opened = find_database((content.database, job.project), progress.part(0.0, 0.2))
        except UserFacingError as error:
            raise UserFacingError(error.message, "Name it with --db.") from error
    document = Document()
    document.load(content.state(audio, None))
    document.take_database(opened.database, opened.removals)
    engine = make_engine(content.engine, opened.database, opened.engine.kernels, content.weights)
    answer = engine.synthesise(document.speech_input(), progress.part(0.2, 0.5))
    path, search_s = getattr(answer, "path", None), getattr(answer, "search_s", 0.0)
    motion = laid_over(answer.motion, opened.database, content.controls, content.polish)

    began = time.perf_counter()
    warnings = [sentence for sentence in (database_differences(content, opened), *opened.trouble[:1]) if sentence]
    warnings += answer.warnings
    output = content.output
    style = job.style or ("markers" if content.face is None else "face")
    video = VideoSettings(FRAME_RATES[output.frame_rate], *job.size, style, output.start_frame,
                          output.head_moves, output.head_moves, None, job.background, job.span_s)  # fmt: skip
    face, stage = document.face or DEFAULT_FACE, progress.part(0.5, 1.0)
    warnings += write_outputs(job.outputs, motion, audio, content.transcript, video, face, stage)
    return {
        "phonemes": phoneme_rows(content.transcript, path, opened.database.nodes),
        "cost": None if path is None else path.cost, "optimal": None if path is None else path.is_optimal,
        "engine": content.engine, "text": content.text,
        "seconds": {"search": rounded_seconds(search_s), "render": rounded_seconds(time.perf_counter() - began)},
        "warnings": warnings, "outputs": [str(path) for path in job.outputs],
    }  # fmt: skip
