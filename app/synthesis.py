"""One synthesis from files to files, as the command line asks for it."""

from __future__ import annotations

import re
import time
from dataclasses import dataclass, field
from pathlib import Path

from app.control_export import check_rigs
from app.demo import open_named
from app.export import VideoSettings, check_outputs, check_outputs_are_not_read, rounded_seconds, write_outputs
from app.speech import emotion_modifiers, load_speech, unheeded_speech
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.iface.engine import IfaceEngine
from core.motion.database import MotionDatabase
from core.motion.stored_weights import named_weights
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath
from core.synthesis.engine import MotionEngine, SpeechInput
from core.synthesis.registry import DEFAULT_ENGINE, ENGINES, engine_kind, make_engine
from gpu.device import open_kernels

_SLOT = re.compile("[0-9]{1,9}")


@dataclass(frozen=True)
class SynthesisJob:
    """Everything that `efase synth` was told; see its help."""

    audio: Path
    outputs: tuple[Path, ...]
    text: str | None = None
    phones: Path | None = None
    database: Path | None = None
    emotion: str | None = None
    emotions: Path | None = None
    engine: str = DEFAULT_ENGINE
    holds: bool = False
    face: str = "default"
    marker_file: Path | None = None
    key_poses: Path | None = None
    csv_is_live_link: bool = False
    backend: str = "auto"
    pins: tuple[str, ...] = ()
    weights: str = "tuned"
    video: VideoSettings = field(default_factory=VideoSettings)
    lexicon: Path | None = None
    strict: bool = False
    language: str | None = None
    phone_table: str | None = None
    model: Path | None = None

    @property
    def files_read(self) -> tuple[str, ...]:
        """Every file that is read for it; a few of the names are words (a text, a face of ours), and no files."""
        given = (self.audio, self.text, self.phones, self.database, self.emotions, self.face, self.marker_file,
                 self.key_poses, self.weights, self.video.texture, self.lexicon, self.phone_table,
                 self.model)  # fmt: skip
        return tuple(str(name) for name in given if name is not None)


@dataclass(frozen=True)
class Ready:
    """What a job needs opened, and many jobs can share: the database, a backend and the engine on both."""

    database: MotionDatabase
    engine: MotionEngine
    backend_sentence: str
    on_numpy: bool


def made_ready(job: SynthesisJob, progress: Progress = SILENT) -> Ready:
    """Open what ``job`` needs besides its files; raises `UserFacingError`."""
    database = open_named(job.database, progress)
    weights = None if job.weights == "tuned" else named_weights(job.weights, database)
    kernels, backend_sentence = open_kernels(job.backend)
    if job.model is not None:
        engine = IfaceEngine.of_file(database, job.model)
    else:
        # a backend that was asked for by name shall do the work; all ways give the same path
        engine = make_engine(job.engine, database, kernels, weights, exhaustive=job.backend != "auto")
    return Ready(database, engine, backend_sentence, kernels.report.backend == "numpy" and not kernels.report.lost)


def run(job: SynthesisJob, progress: Progress = SILENT, ready: Ready | None = None) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is half-written.

    ready : what was made ready for this job, or one with the same database, engine, weights and backend
    """
    kind = engine_kind(job.engine)
    check_outputs(list(job.outputs))
    _check_inputs(job)
    face = FaceChoice(job.face, None if job.marker_file is None else str(job.marker_file))
    check_rigs(job.outputs, face, job.key_poses, job.csv_is_live_link)
    pins = _pins(job.pins)
    if pins and not kind.searches:
        raise UserFacingError(f"The engine '{job.engine}' takes no motion nodes, so none can be pinned.")
    if job.holds and not kind.can_hold:
        holding = ", ".join(name for name, known in ENGINES.items() if known.can_hold)
        raise UserFacingError(f"The engine '{job.engine}' cannot hold long sounds.", f"These can: {holding}.")
    if job.model is not None and not kind.listens:
        raise UserFacingError(f"The engine '{job.engine}' takes no trained face.", "The engine iface does.")
    ready = ready or made_ready(job, progress.part(0.0, 0.1))
    database, engine = ready.database, ready.engine

    began = time.perf_counter()
    if kind.listens and not _needs_words(job):
        speech = unheeded_speech(job.audio)
    else:
        speech = load_speech(job.audio, job.text, job.phones, job.lexicon, job.strict, progress.part(0.1, 0.25),
                             job.language, job.phone_table)  # fmt: skip
    modifiers = emotion_modifiers(job.emotion, job.emotions, speech.audio.duration_s)
    aligned_s = time.perf_counter() - began
    asked = time.perf_counter()
    question = SpeechInput(speech.transcript, modifiers, pins, audio=speech.audio, holds=job.holds)
    answer = engine.synthesise(question, progress.part(0.25, 0.5))
    path, search_s = getattr(answer, "path", None), getattr(answer, "search_s", 0.0)
    synthesis_s = getattr(answer, "synthesis_s", time.perf_counter() - asked)

    began = time.perf_counter()
    warnings = list(speech.transcript.warnings)
    if kind.searches and job.backend == "auto" and ready.on_numpy:
        warnings.append(ready.backend_sentence)
    warnings += answer.warnings
    stage = progress.part(0.5, 1.0)
    warnings += write_outputs(job.outputs, answer.motion, speech.audio, speech.transcript, job.video, face, stage,
                              job.key_poses, job.csv_is_live_link)  # fmt: skip
    seconds = {
        "align": aligned_s, "search": search_s, "synthesis": synthesis_s, "render": time.perf_counter() - began,
    }  # fmt: skip
    return {
        "phonemes": phoneme_rows(speech.transcript, path, database.nodes),
        "cost": None if path is None else path.cost,
        "lower_bound": None if path is None else path.lower_bound,
        "optimal": None if path is None else path.is_optimal,
        "backend": ready.backend_sentence,
        "device": None if path is None else {**answer.device.as_dict(), "method": answer.method},
        "engine": job.engine,
        "text": speech.text,
        "seconds": {name: rounded_seconds(value) for name, value in seconds.items()},
        "warnings": warnings,
        "outputs": [str(path) for path in job.outputs],
    }


def _needs_words(job: SynthesisJob) -> bool:
    """Whether what is said was given, or is to be written; else an engine that listens does without."""
    given = (job.text, job.phones, job.language, job.phone_table)
    return any(g is not None for g in given) or any(path.suffix.lower() == ".textgrid" for path in job.outputs)


def _check_inputs(job: SynthesisJob) -> None:
    if job.marker_file is not None and not job.marker_file.is_file():
        raise UserFacingError(f"There is no marker file '{job.marker_file}'.")
    check_outputs_are_not_read(job.outputs, job.files_read)


def phoneme_rows(transcript, path: MotionPath | None, nodes) -> list[dict[str, object]]:
    """Return one object a slot: what is said, and where there is a path, which node says it and what that costs."""
    if path is None:
        return [{"phone": u.phone, "start_s": u.start_s, "end_s": u.end_s} for u in transcript.phonemes]
    return [
        {
            "phone": u.phone, "start_s": u.start_s, "end_s": u.end_s, "node": nodes.name(path.nodes[p]),
            "costs": {"observation": float(path.observation[p]), "transition": float(path.transition[p]),
                      "emotion": float(path.emotion[p])},
        }
        for p, u in enumerate(transcript.phonemes)
    ]  # fmt: skip


def _pins(texts: tuple[str, ...]) -> dict[int, str]:
    pins: dict[int, str] = {}
    for text in texts:
        slot, equals, node = text.partition("=")
        if not equals or not _SLOT.fullmatch(slot.strip()) or not node.strip():
            raise UserFacingError(f"'{text}' is not a pin.", "Write it as SLOT=NODE, for instance 3=n04:12.")
        if int(slot) in pins:
            raise UserFacingError(f"Slot {int(slot)} is pinned twice.")
        pins[int(slot)] = node.strip()
    return pins
