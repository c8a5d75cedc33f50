"""One import as the command line asks for it."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from app.export import SUFFIXES, VideoSettings, check_outputs, write_outputs
from core.actress.corpus import actress_marker_set
from core.batch.failures import write_failures
from core.batch.workers import workers_at
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.importing.plan import ImportPlan, MendLimits, Reading, read_plan, write_plan
from core.importing.proposals import with_proposals
from core.importing.report import ImportReport
from core.importing.run import import_motion, run_import
from core.importing.survey import survey
from core.media.audio import Audio, load_audio
from core.media.swap_in import check_target
from core.motion.database import MotionDatabase, open_database
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.speech.emotion import emotion_named
from core.synthesis.marker_motion import MarkerMotion

DEMO = "demo"
_SILENCE_HZ = 16_000


@dataclass(frozen=True)
class ImportJob:
    """Everything that `efase import` was told; see its help. What is None leaves the plan as it is."""

    files: tuple[Path, ...] = ()
    outputs: tuple[Path, ...] = ()
    plan: Path | None = None
    save_plan: Path | None = None
    name: str | None = None
    markers_like: str | None = None
    poses_like: Path | None = None
    emotion: str | None = None
    audio_dir: Path | None = None
    offsets: str | None = None
    longest_gap_s: float | None = None
    faults: bool | None = None
    reading: Reading = field(default_factory=Reading)
    lexicon: Path | None = None
    dims: int | None = None
    hold_out: str | None = None
    face: str = "default"
    failures: Path | None = None
    jobs: int = -1
    cluster: str | None = None


def run(job: ImportJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError`."""
    database_path, shown = _targets(job)
    began = time.perf_counter()
    plan = plan_of(job, progress.part(0.0, 0.1))
    if job.save_plan is not None:
        write_plan(plan, job.save_plan)
    if not job.outputs:
        return {"plan": str(job.save_plan), "sentences": len(plan.sentences), "outputs": [str(job.save_plan)]}
    with workers_at(job.cluster, job.jobs, "Importing") as workers:
        if database_path is None:
            imported = import_motion(plan, progress.part(0.1, 0.6), workers)
            takes, report, made = list(zip(imported.recordings, imported.motions)), imported.report, {}
        else:
            result = run_import(plan, database_path, progress.part(0.1, 0.9 if shown else 1.0), workers)
            takes, report = _takes_of(result.database, plan) if shown else [], result.report
            made = {"nodes": len(result.database.nodes), "content_hash": result.database.content_hash}
    warnings = write_takes(shown, takes, job.face, progress.part(0.9 if made else 0.6, 1.0))
    if job.failures is not None:
        write_failures(job.failures, ((row.sentence, row.failure) for row in report.failures))
    return {
        "database": None if database_path is None else str(database_path),
        "sentences": len(report.taken),
        "failed": {row.sentence: row.failure for row in report.failures},
        "resumed": report.n_resumed,
        "report": report.as_dict(),
        **made,
        "seconds": round(time.perf_counter() - began, 2),
        "warnings": warnings,
        "outputs": [str(path) for path in job.outputs],
    }


def plan_of(job: ImportJob, progress: Progress = SILENT) -> ImportPlan:
    """Return the plan that the job means: the file's, or one made from the chosen files, with the options on top."""
    if (job.plan is None) == (not job.files):
        raise UserFacingError("Name the files to import, or a plan with --plan, and not both.")
    if job.plan is not None:
        plan = _with_options(read_plan(job.plan), job)
    else:
        places = [*job.files] if job.audio_dir is None else [*job.files, job.audio_dir]
        found = survey(places, progress)
        if not found.sentences:
            raise UserFacingError("The chosen files hold no motion.")
        plan = _with_options(found.plan(job.name or job.files[0].resolve().stem), job)
    like = job.markers_like
    known = actress_marker_set() if like in (None, DEMO) else open_database(Path(like)).markers
    if like is not None:
        plan = replace(plan, markers={}, landmarks={}, groups={}, rigid=(), origin=None)
    return with_proposals(plan, known, like is not None) if not plan.rigid or not plan.landmarks else plan


def _with_options(plan: ImportPlan, job: ImportJob) -> ImportPlan:
    mending = plan.mending
    changed = {"longest_gap_s": job.longest_gap_s, "faults": job.faults}
    mending = MendLimits(**{**vars(mending), **{k: v for k, v in changed.items() if v is not None}})
    said = {k: v for k, v in vars(job.reading).items() if v != getattr(Reading(), k)}
    plan = replace(plan, mending=mending, reading=replace(plan.reading, **said))
    wanted = {"name": job.name, "offsets": job.offsets, "n_dims": job.dims, "hold_out": job.hold_out,
              "lexicon": None if job.lexicon is None else str(job.lexicon),
              "like": None if job.poses_like is None else str(job.poses_like)}  # fmt: skip
    plan = replace(plan, **{k: v for k, v in wanted.items() if v is not None})
    if job.emotion is not None:
        emotion = emotion_named(job.emotion)
        plan = replace(plan, sentences=tuple(replace(s, emotion=emotion) for s in plan.sentences))
    return plan


def _targets(job: ImportJob) -> tuple[Path | None, list[Path]]:
    """The database to write, if any, and what is shown beside it."""
    databases = [path for path in job.outputs if path.suffix.lower() in (".h5", ".hdf5")]
    shown = [path for path in job.outputs if path not in databases]
    if len(databases) > 1:
        raise UserFacingError("An import writes one database.")
    if not job.outputs and job.save_plan is None:
        raise UserFacingError("Nothing is to be written.",
                              f"Name a database (.h5), {', '.join(SUFFIXES)}, or --save-plan.")  # fmt: skip
    check_outputs(shown)
    for path in (*databases, *filter(None, (job.failures, job.save_plan))):
        check_target(path, folders_are_made=path in databases)
    return (databases[0] if databases else None), shown


def _takes_of(database: MotionDatabase, plan: ImportPlan) -> list[tuple[Recording, MarkerMotion]]:
    """The sentences of a database as it plays them."""
    sounds = {sentence.name: sentence.audio for sentence in plan.sentences}
    takes = []
    for s in database.sentences:
        positions = database.pca.positions(database.frames[s.start_frame : s.stop_frame].astype(float))
        motion = MarkerMotion(positions.astype(np.float32), database.rate_hz, database.markers)
        audio = None if sounds[s.name] is None else Path(sounds[s.name])
        takes.append((Recording(s.name, s.emotion, motion.positions, database.markers.names, database.rate_hz,
                                s.transcript, s.text, audio), motion))  # fmt: skip
    return takes


def write_takes(
    shown: Sequence[Path], takes: Sequence[tuple[Recording, MarkerMotion]], face: str, progress: Progress = SILENT
) -> list[str]:
    """Write the mended motion of every take, with its sound, to films and marker files; return sentences to warn with.

    shown : one a kind; where there are several takes, each file gets the take's name at its end
    """
    warnings: list[str] = []
    for i, (recording, motion) in enumerate(takes):
        paths = shown
        if len(takes) > 1:
            paths = [path.with_name(f"{path.stem}-{recording.sentence}{path.suffix}") for path in shown]
        audio = _sound(recording.audio, len(motion.positions) / motion.rate_hz)
        part = progress.part(i / len(takes), (i + 1) / len(takes))
        # a capture has no gaze of its own, and its head is still: nothing is made up
        settings = VideoSettings(head=False, gaze=False)
        warnings += write_outputs(paths, motion, audio, recording.transcript, settings, FaceChoice(face), part)
    return list(dict.fromkeys(warnings))


def _sound(path: Path | None, duration_s: float) -> Audio:
    if path is not None:
        return load_audio(path)
    return Audio(np.zeros(round(duration_s * _SILENCE_HZ), np.float32), _SILENCE_HZ)


def in_words(answer: dict[str, object]) -> str:
    """Say in a few lines what an import did."""
    if "report" not in answer:
        return f"{answer['plan']}: a plan of {answer['sentences']} sentences"
    resumed = f" ({answer['resumed']} taken up from a run that was cut)" if answer["resumed"] else ""
    nodes = f"{answer['nodes']} motion nodes, " if "nodes" in answer else ""
    return (f"{ImportReport.from_dict(answer['report']).in_words()}\n"
            f"{', '.join(answer['outputs'])}: {nodes}{answer['seconds']:.0f} s{resumed}")  # fmt: skip
