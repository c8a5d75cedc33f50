"""A film strip drawn in a process of its own, rows made anew included, so that the window never waits for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from app.child_process import run_apart
from app.demo import open_named
from app.pictures import FaceRig
from app.strip_job import row_label
from app.strips import StripRow, StripSettings, film_strip
from app.texts import strips as texts
from core.errors import UserFacingError
from core.media.image_sequence import write_png
from core.motion.capture import capture_of
from core.progress import Progress
from core.search.weights import SearchWeights
from core.speech.emotion import EmotionModifier
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.registry import make_engine


@dataclass(frozen=True)
class StripRequest:
    """All that a strip needs.

    on_show : the motion on show, to be a row, or None
    emotions : rows to be made anew by ``engine`` from the database at ``database``
    captured_text : the words whose capture is a row, or None
    rig : None draws markers
    """

    path: Path
    speech: SpeechInput
    settings: StripSettings
    rig: FaceRig | None
    database: Path
    engine: str
    weights: SearchWeights | None
    on_show: MarkerMotion | None = None
    emotions: tuple[str, ...] = ()
    captured_text: str | None = None


def draw_apart(request: StripRequest, progress: Progress) -> Path:
    """Draw the strip and return its path; a cancel kills the process. Raises what `_draw` raises."""
    return run_apart(_draw, (request,), progress, texts.DIED)


def _draw(request: StripRequest, progress: Progress) -> Path:
    transcript = request.speech.transcript
    n_rows = (request.on_show is not None) + len(request.emotions) + (request.captured_text is not None)
    rows = []
    if request.on_show is not None:
        rows.append(StripRow(texts.ON_SHOW if n_rows > 1 else "", request.on_show))
    if request.emotions or request.captured_text is not None:
        rows += _made(request, n_rows, progress.part(0.0, 0.6))
    picture = film_strip(rows, request.rig, transcript, request.settings, progress.part(0.6, 1.0))
    write_png(request.path, picture)
    return request.path


def _made(request: StripRequest, n_rows: int, progress: Progress) -> list[StripRow]:
    transcript, rows = request.speech.transcript, []
    database = open_named(request.database, progress.part(0.0, 0.2))
    if request.emotions:
        from gpu.device import open_kernels

        engine = make_engine(request.engine, database, open_kernels()[0], request.weights)
        for n, emotion in enumerate(request.emotions):
            stage = progress.part(0.2 + 0.8 * n / len(request.emotions), 0.2 + 0.8 * (n + 1) / len(request.emotions))
            whole = EmotionModifier(0.0, transcript.duration_s, emotion)
            answer = engine.synthesise(replace(request.speech, modifiers=(whole,)), stage)
            rows.append(StripRow(row_label(request.engine, emotion, 1, n_rows), answer.motion))
    if request.captured_text is not None:
        captured = capture_of(database, request.captured_text, transcript.duration_s)
        if captured is None:
            raise UserFacingError(texts.NOT_CAPTURED.format(database=database.name))
        rows.append(StripRow(texts.CAPTURED, captured))
    return rows
