"""`efase compare`: two engines on the same speech, without the window: figures, curves and a film."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

from app.comparison_film import FilmRequest, compose
from app.comparison_words import how_fair, in_figures, title_of
from app.controlled_face import CAST, drawable
from app.demo import open_named
from app.export import VIDEO_SUFFIXES, VideoSettings, check_outputs_are_not_read, rounded_seconds
from app.speech import LoadedSpeech, emotion_modifiers, load_speech
from app.texts import compare as texts
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.evaluation.course_table import write_course_table
from core.evaluation.known_capture import KnownCapture, known_capture
from core.evaluation.side_by_side import CAPTURED, SideBySide
from core.face.default_face import FaceUnavailable
from core.media.swap_in import check_target
from core.motion.capture import captured_names, captured_speech
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.speech.emotion import EmotionModifier
from core.synthesis.engine import MotionEngine, SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.registry import ENGINES, make_engines
from gpu.device import open_kernels

_CURVES_SUFFIX = ".csv"


@dataclass(frozen=True)
class ComparisonJob:
    """Everything that `efase compare` was told; see its help.

    speech : a sound file, or the name of a captured sentence of the database
    engines : two, of `core.synthesis.registry.ENGINES` or `core.evaluation.side_by_side.CAPTURED`
    """

    speech: str
    engines: tuple[str, str]
    outputs: tuple[Path, ...] = ()
    text: str | None = None
    phones: Path | None = None
    database: Path | None = None
    emotion: str | None = None
    emotions: Path | None = None
    lexicon: Path | None = None
    strict: bool = False
    language: str | None = None
    phone_table: str | None = None
    face: str = "default"
    video: VideoSettings = field(default_factory=VideoSettings)


def run(job: ComparisonJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is half-written."""
    _check(job)
    database = open_named(job.database, progress.part(0.0, 0.1))
    speech, modifiers = _speech(job, database, progress.part(0.1, 0.2))
    capture = known_capture(database, speech.text, speech.transcript.duration_s)
    if CAPTURED in job.engines and capture is None:
        raise UserFacingError(
            f"'{job.speech}' was not captured, so nothing can be compared with its capture.",
            f"Name a sentence that is in the database '{database.name}', or two engines.",
        )
    made = [name for name in job.engines if name != CAPTURED]
    engines = make_engines(made, database, lambda: open_kernels()[0])
    question = SpeechInput(speech.transcript, modifiers, audio=speech.audio)
    motions: dict[str, MarkerMotion] = {}
    seconds, warnings = {}, list(speech.transcript.warnings)
    for n, name in enumerate(made):
        stage = progress.part(0.2 + 0.4 * n / len(made), 0.2 + 0.4 * (n + 1) / len(made))
        motions[name], seconds[name], said = _spoken(engines[name], name, question, stage)
        warnings += [sentence for sentence in said if sentence not in warnings]
    beside = SideBySide.of(
        job.engines, tuple(motions.get(name) for name in job.engines), speech.transcript,
        None if capture is None else capture.truth,
    )  # fmt: skip
    for path in job.outputs:
        if path.suffix.lower() == _CURVES_SUFFIX:
            write_course_table(path, beside)
        else:
            warnings += _write_film(job, path, beside, speech, progress.part(0.6, 1.0))
    return {
        "engines": list(job.engines),
        "text": speech.text,
        "captured": None if capture is None else _about(capture),
        "fairness": how_fair(capture),
        "rate_hz": beside.rate_hz,
        "frames": beside.n_frames,
        "figures": [asdict(found) for found in beside.agreements],
        "seconds": {name: rounded_seconds(value) for name, value in seconds.items()},
        "warnings": warnings,
        "outputs": [str(path) for path in job.outputs],
    }


def _check(job: ComparisonJob) -> None:
    if job.engines[0] == job.engines[1]:
        raise UserFacingError(f"'{job.engines[0]}' cannot be compared with itself.", "Name two different engines.")
    for name in job.engines:
        if name != CAPTURED and name not in ENGINES:
            raise UserFacingError(f"There is no engine '{name}'.", f"Choose among {CAPTURED}, {', '.join(ENGINES)}.")
    if job.face == CAST:
        raise UserFacingError(f"A comparison shows one face twice, and '{CAST}' is many.", "Name one of them.")
    for path in job.outputs:
        if path.suffix.lower() not in (_CURVES_SUFFIX, *VIDEO_SUFFIXES):
            raise UserFacingError(f"'{path}' is no kind of comparison that can be written.",
                                  "End its name in .csv for curves, or .avi or .mp4 for a film.")  # fmt: skip
        check_target(path)
    given = (job.speech, job.text, job.phones, job.database, job.emotions, job.lexicon)
    check_outputs_are_not_read(job.outputs, [str(path) for path in given if path is not None])


def _speech(
    job: ComparisonJob, database: MotionDatabase, progress: Progress
) -> tuple[LoadedSpeech, list[EmotionModifier]]:
    """Load a sound file with its words; or a captured sentence, said in its own emotion unless another is asked for."""
    if not Path(job.speech).is_file() and job.speech in captured_names(database):
        if job.text is not None or job.phones is not None:
            raise UserFacingError(f"What is said in the captured sentence '{job.speech}' is known already.")
        audio, transcript, text, emotion = captured_speech(database, job.speech)
        asked = job.emotion or (emotion if job.emotions is None else None)
        return LoadedSpeech(audio, transcript, text, False), emotion_modifiers(asked, job.emotions, audio.duration_s)
    speech = load_speech(Path(job.speech), job.text, job.phones, job.lexicon, job.strict, progress, job.language,
                         job.phone_table)  # fmt: skip
    return speech, emotion_modifiers(job.emotion, job.emotions, speech.audio.duration_s)


def _spoken(
    engine: MotionEngine, name: str, question: SpeechInput, progress: Progress
) -> tuple[MarkerMotion, float, tuple[str, ...]]:
    """Return the motion, the seconds that it took once the engine was prepared, and its warnings."""
    try:
        engine.prepare(progress.part(0.0, 0.7))
        began = time.perf_counter()
        answer = engine.synthesise(question, progress.part(0.7, 1.0))
    except UserFacingError as error:
        why = texts.FAILED.format(engine=title_of(name), why=error.message)
        raise UserFacingError(why, error.remedy) from error
    return answer.motion, time.perf_counter() - began, answer.warnings


def _write_film(
    job: ComparisonJob, path: Path, beside: SideBySide, speech: LoadedSpeech, progress: Progress
) -> list[str]:
    rig, warnings = None, []
    if job.video.style != "markers":
        try:
            rig = drawable(FaceChoice(job.face), beside.motions[0].markers, progress=progress.part(0.0, 0.1))
        except FaceUnavailable as error:
            warnings.append(str(error))
    titles = tuple(title_of(name) for name in beside.names)
    compose(
        FilmRequest(beside.motions, titles, speech.audio, beside.transcript, rig, job.video, path),
        progress.part(0.1, 1.0),
    )
    return warnings


def _about(capture: KnownCapture) -> dict[str, object]:
    return {"sentence": capture.truth.recording.sentence, "held_out": capture.is_held_out}


def in_words(answer: Mapping) -> str:
    """Return the figures as lines for a terminal."""
    pairs = [f"{found['of']} – {found['standard']}" for found in answer["figures"]]
    width = max(16, *(len(pair) + 2 for pair in pairs))
    lines = ["".join(("".ljust(18), *(pair.rjust(width) for pair in pairs)))]
    for measure, (name, unit, _) in texts.FIGURE_ROWS.items():
        cells = (in_figures(found[measure], unit) for found in answer["figures"])
        lines.append("".join((name.ljust(18), *(cell.rjust(width) for cell in cells))))
    return "\n".join((*lines, answer["fairness"], *answer["outputs"]))
