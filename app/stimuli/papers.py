"""What an experimenter needs beside the films: key, answer sheet, playlists, and a page that tells how to ask."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from app.stimuli.job import StimuliJob
from app.stimuli.tracks import Track
from app.texts import stimuli as texts
from core.evaluation.stimuli import CAPTURED, NOT_SURE, Stimulus, StudyPlan, trials_of
from core.evaluation.stimuli_files import KEY_FILE, SHEET_FILE, key_text, playlist_text, sheet_text
from core.motion.database import MotionDatabase
from core.synthesis.registry import engine_kind

_README = Path(__file__).resolve().parents[2] / "resources" / "stimuli" / "README.txt"


def write_papers(
    folder: Path, job: StimuliJob, plan: StudyPlan, stimuli: Sequence[Stimulus], files: Mapping[str, str],
    tracks: Sequence[Track], database: MotionDatabase,
) -> None:  # fmt: skip
    """Write the key, the answer sheet, a playlist for each participant, ``study.json`` and ``README.txt``."""
    spoken = {track.name: track.text for track in tracks}
    trials = trials_of(plan)
    (folder / KEY_FILE).write_text(key_text(stimuli, files, spoken), encoding="utf-8")
    (folder / SHEET_FILE).write_text(sheet_text(trials), encoding="utf-8")
    (folder / "playlists").mkdir()
    digits = max(2, len(str(plan.n_participants)))
    for p in range(1, plan.n_participants + 1):
        played = playlist_text((t for t in trials if t.participant == p), files)
        (folder / "playlists" / f"participant-{p:0{digits}d}.m3u").write_text(played, encoding="utf-8")
    study = {
        "format": "efase-perception-study", "version": 1, "workstation": _version(), "plan": asdict(plan),
        "audios": spoken, "database": database.name, "database_content": database.content_hash,
        "engine": job.engine, "face": job.face, "fps": str(job.video.fps),
        "size": [job.video.width, job.video.height],
    }  # fmt: skip
    (folder / "study.json").write_text(json.dumps(study, indent=1) + "\n", encoding="utf-8")
    (folder / "README.txt").write_text(_readme(job, plan, len(stimuli), tracks, database), encoding="utf-8")


def _readme(job: StimuliJob, plan: StudyPlan, n_stimuli: int, tracks: Sequence[Track], database: MotionDatabase) -> str:
    has_captured = CAPTURED in plan.faces
    return _README.read_text(encoding="utf-8").format(
        version=_version(), database=database.name,
        synthetic=texts.SYNTHETIC_DATABASE if database.synthetic else "", engine=job.engine, face=job.face,
        seed=plan.seed, n_stimuli=n_stimuli, n_participants=plan.n_participants,
        tracks="\n".join(f"  {track.name:<20} {track.text}" for track in tracks),
        spoken_in=texts.SPOKEN_OWN if job.table else texts.SPOKEN_CAPTURED,
        apart=texts.APART if engine_kind(job.engine).searches else texts.LEARNED_FROM,
        captured=_captured_faces(job, has_captured), alike=texts.ALIKE_FILMED if job.films else texts.ALIKE,
        parts=texts.PARTS[plan.design][has_captured],
        groups=texts.GROUPS if len(plan.faces) > 1 else texts.MIRRORED,
        balance="" if plan.n_participants % plan.balanced_by == 0 else
        " " + texts.UNBALANCED.format(multiple=plan.balanced_by),
        answers=", ".join([*plan.expressions, NOT_SURE]),
    )  # fmt: skip


def _captured_faces(job: StimuliJob, has_captured: bool) -> str:
    if not has_captured:
        return texts.NO_CAPTURED_FACES
    return texts.CAPTURED_FACES if job.films is None else texts.FILMED_FACES


def _version() -> str:
    try:
        return version("efase-workstation")
    except PackageNotFoundError:  # run from a folder
        return "of no version"
