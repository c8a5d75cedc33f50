"""A film strip from a sound file to a picture, as `efase strip` asks for it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from app.demo import open_named
from app.export import check_outputs_are_not_read
from app.pictures import STYLES, FaceRig
from app.speech import LoadedSpeech, load_speech
from app.strips import StripRow, StripSettings, film_strip, moments
from app.texts import strips as texts
from core.errors import UserFacingError
from core.face.default_face import FaceUnavailable
from core.media.image_sequence import write_png
from core.media.swap_in import check_target
from core.motion.capture import capture_of
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.speech.emotion import EmotionModifier, emotion_named
from core.synthesis.engine import SpeechInput
from core.synthesis.registry import DEFAULT_ENGINE, engine_kind, make_engine
from gpu.device import open_kernels


@dataclass(frozen=True)
class StripJob:
    """Everything that `efase strip` was told.

    emotions, engines : a row for each of both; with_capture : one more, of what was captured of these words
    """

    audio: Path
    output: Path
    text: str | None = None
    phones: Path | None = None
    database: Path | None = None
    emotions: tuple[str, ...] = ("neutral",)
    engines: tuple[str, ...] = (DEFAULT_ENGINE,)
    with_capture: bool = False
    face: str = "default"
    marker_file: Path | None = None
    settings: StripSettings = field(default_factory=StripSettings)


def run(job: StripJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is written."""
    emotions = tuple(emotion_named(name) for name in job.emotions)
    for name in job.engines:
        engine_kind(name)
    if job.settings.style not in STYLES:
        raise UserFacingError(f"There is no style '{job.settings.style}'.", f"Choose one of {', '.join(STYLES)}.")
    check_strip_path(job.output)
    check_outputs_are_not_read([job.output], [str(job.audio)])
    speech = load_speech(job.audio, job.text, job.phones, progress=progress.part(0.0, 0.2))
    times_s = moments(speech.transcript, job.settings)
    database = open_named(job.database, progress.part(0.2, 0.3))
    rows, warnings = _rows(job, emotions, database, speech, progress.part(0.3, 0.6))
    rig = None
    if job.settings.style != "markers":
        try:
            rig = FaceRig.of(job.face, database.markers, job.marker_file, progress.part(0.6, 0.65))
        except FaceUnavailable as error:
            warnings.append(str(error))
    picture = film_strip(rows, rig, speech.transcript, job.settings, progress.part(0.65, 1.0))
    write_png(job.output, picture)
    return {
        "outputs": [str(job.output)], "rows": [row.label for row in rows], "times_s": list(times_s),
        "text": speech.text, "size": [picture.shape[1], picture.shape[0]],
        "warnings": list(dict.fromkeys([*speech.transcript.warnings, *warnings])),
    }  # fmt: skip


def check_strip_path(path: Path) -> None:
    """Raise `UserFacingError` unless a picture can be written to ``path``."""
    if path.suffix.lower() != ".png":
        raise UserFacingError(f"'{path}' is no .png, as which strips are written.")
    check_target(path)


def _rows(
    job: StripJob, emotions: tuple[str, ...], database: MotionDatabase, speech: LoadedSpeech, progress: Progress
) -> tuple[list[StripRow], list[str]]:
    question = SpeechInput(speech.transcript, audio=speech.audio)
    rows, warnings = [], []
    asked = [(engine, emotion) for engine in job.engines for emotion in emotions]
    made = {name: make_engine(name, database, open_kernels()[0]) for name in job.engines}
    for n, (engine, emotion) in enumerate(asked):
        stage = progress.part(n / len(asked), (n + 1) / len(asked))
        whole = EmotionModifier(0.0, speech.transcript.duration_s, emotion)
        answer = made[engine].synthesise(replace(question, modifiers=(whole,)), stage)
        rows.append(StripRow(row_label(engine, emotion, len(job.engines), len(emotions)), answer.motion))
        warnings += answer.warnings
    if job.with_capture:
        captured = capture_of(database, speech.text, speech.transcript.duration_s)
        if captured is None:
            raise UserFacingError(texts.NOT_CAPTURED.format(database=database.name))
        rows.append(StripRow(texts.CAPTURED, captured))
        if len(rows) == 2 and not rows[0].label:
            rows[0] = replace(rows[0], label=engine_kind(job.engines[0]).title)
    return rows, warnings


def row_label(engine: str, emotion: str, n_engines: int, n_emotions: int) -> str:
    """Return what tells a row from the others: its engine, its emotion, both, or nothing."""
    parts = [engine_kind(engine).title] * (n_engines > 1) + [emotion] * (n_emotions > 1)
    return ", ".join(parts)
