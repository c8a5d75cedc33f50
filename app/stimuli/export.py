"""From a database to the folder of a perception study, as `efase stimuli` asks for it."""

from __future__ import annotations

from dataclasses import replace

from app.demo import open_named
from app.pictures import FaceRig
from app.stimuli.films import write_stimuli
from app.stimuli.job import StimuliJob
from app.stimuli.papers import write_papers
from app.stimuli.real_films import with_real_films
from app.stimuli.tracks import captured_tracks, faces_of, own_tracks
from app.texts import stimuli as texts
from core.errors import UserFacingError
from core.evaluation.stimuli import AUDIO, StudyPlan, stimuli_of, trials_of
from core.face.default_face import FaceUnavailable
from core.media.folder_swap import check_new_folder, swapped_in_folder
from core.media.video import SUFFIXES
from core.progress import SILENT, Progress
from core.speech.emotion import emotion_named
from core.synthesis.registry import engine_kind, make_engine
from gpu.device import open_kernels


def run(job: StimuliJob, progress: Progress = SILENT) -> dict[str, object]:
    """Make the folder and return the object of ``--json``; nothing is left of one that fails or is cancelled.

    Raises `UserFacingError` for what makes no study, before any film is drawn.
    """
    check_new_folder(job.out)
    engine_kind(job.engine)
    if job.film not in SUFFIXES:
        raise UserFacingError(f"Films end in {' or '.join(SUFFIXES)}, not in '{job.film[:10]}'.")
    expressions = tuple(emotion_named(name) for name in job.expressions)
    database = open_named(job.database, progress.part(0.0, 0.05))
    tracks = own_tracks(job.table, database) if job.table else captured_tracks(job.sentences, expressions, database)
    if job.films is not None:
        tracks = with_real_films(job.films, tracks, expressions)
    faces, warnings = faces_of(job.faces, tracks, expressions)
    plan = StudyPlan(tuple(t.name for t in tracks), expressions, faces, job.n_participants, job.seed, job.design)
    engine = make_engine(job.engine, database, open_kernels()[0])
    engine.prepare(progress.part(0.05, 0.1))
    rig, video = None, job.video
    if video.style != "markers":
        try:
            rig = FaceRig.of(job.face, database.markers, progress=progress.part(0.1, 0.12))
        except FaceUnavailable as error:
            warnings.append(str(error))
            video = replace(video, style="markers")
    if plan.n_participants % plan.balanced_by:
        warnings.append(texts.UNBALANCED.format(multiple=plan.balanced_by))
    stimuli = stimuli_of(plan)
    files = {s.code: f"stimuli/{s.code}{'.wav' if s.kind == AUDIO else job.film}" for s in stimuli}
    with swapped_in_folder(job.out) as folder:
        (folder / "stimuli").mkdir()
        warnings += write_stimuli(folder, stimuli, files, tracks, database, engine, rig, video,
                                   progress.part(0.12, 0.98))  # fmt: skip
        write_papers(folder, job, plan, stimuli, files, tracks, database)
    return {
        "out": str(job.out), "stimuli": len(stimuli), "participants": plan.n_participants, "design": plan.design,
        "seed": plan.seed, "audios": {t.name: t.text for t in tracks}, "expressions": list(plan.expressions),
        "faces": list(plan.faces), "trials": len(trials_of(plan)), "warnings": list(dict.fromkeys(warnings)),
    }  # fmt: skip


def in_words(answer: dict) -> str:
    """Return ``answer`` of `run` for a reader."""
    return (
        f"{answer['out']}: {answer['stimuli']} stimuli of {len(answer['audios'])} audios in "
        f"{len(answer['expressions'])} expressions ({', '.join(answer['faces'])}), {answer['trials']} trials of "
        f"{answer['participants']} participants"
    )
