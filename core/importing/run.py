"""An import carried out: every sentence by itself, then one database of those that succeeded."""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.batch.workers import Workers, here
from core.errors import UserFacingError
from core.folders import cache_dir
from core.importing.plan import ImportPlan, SentencePlan, check_plan
from core.importing.report import KEY, ImportReport, SentenceReport
from core.importing.sentence_work import failed, work_on
from core.importing.shifting import shifted
from core.importing.sound_offset import OffsetEstimate, pooled_offset
from core.importing.work_cache import KeptSentence, cache_path, keep, kept
from core.media.swap_in import check_target
from core.motion.build import BuildSettings, build_database, marker_set_of
from core.motion.corpus import Corpus
from core.motion.database import MotionDatabase
from core.motion.head_space import LONGEST_GAP_S, in_head_space
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.speech.placing import SILENCE
from core.synthesis.marker_motion import MarkerMotion

# A measured offset that is less sure than this is told, and not taken out.
SURE = 0.5


@dataclass(frozen=True)
class ImportResult:
    """What an import made."""

    database: MotionDatabase
    report: ImportReport


def run_import(
    plan: ImportPlan,
    target: Path,
    progress: Progress = SILENT,
    workers: Workers = here,
    folder: Path | None = None,
) -> ImportResult:
    """Carry ``plan`` out and write the database to ``target``.

    Each sentence is read, mended and aligned by itself and kept until the database is written; a killed import that is
    started again takes up what was finished. A sentence that fails is left out and told in the report, which lies in
    the database's ``report["import"]``.

    workers : who works on the sentences; see `core.batch.workers`
    folder : where finished sentences are kept; in the cache when absent
    Raises `UserFacingError` when no sentence succeeds or the target cannot be written.
    """
    check_target(Path(target), folders_are_made=True)
    folder = cache_dir() / "import" if folder is None else folder
    corpus, report = imported_corpus(plan, progress.part(0.0, 0.6), workers, folder)
    if all(row.alignment == SILENCE for row in report.taken):
        raise UserFacingError(
            "None of the takes holds speech, so a database of them would have nothing to search.",
            "Write their motion as film or markers instead, or give their sound.",
        )
    settings = BuildSettings(plan.rate_hz, plan.n_dims, _longest_gap_s(plan))
    database = build_database(corpus, Path(target), settings, progress.part(0.6, 1.0))
    forget(plan, folder)
    return ImportResult(database, report)


@dataclass(frozen=True)
class ImportedMotion:
    """The takes of an import as motion of their own markers, in head space, ready to drive a face.

    recordings, motions : one a sentence, in the same order
    """

    recordings: tuple[Recording, ...]
    motions: tuple[MarkerMotion, ...]
    report: ImportReport


def import_motion(
    plan: ImportPlan, progress: Progress = SILENT, workers: Workers = here, folder: Path | None = None
) -> ImportedMotion:
    """Carry ``plan`` out without a database: for takes that are shown or handed on, with speech or without.

    Raises `UserFacingError` when no sentence succeeds. Parameters as in `run_import`.
    """
    folder = cache_dir() / "import" if folder is None else folder
    corpus, report = imported_corpus(plan, progress, workers, folder)
    markers = marker_set_of(corpus)
    motions = []
    for recording in corpus.recordings:
        face = in_head_space(recording, markers, plan.with_scale, _longest_gap_s(plan)).face
        motions.append(MarkerMotion(face.astype(np.float32), recording.rate_hz, markers))
    forget(plan, folder)
    return ImportedMotion(tuple(corpus.recordings), tuple(motions), report)


def imported_corpus(
    plan: ImportPlan, progress: Progress, workers: Workers, folder: Path
) -> tuple[Corpus, ImportReport]:
    """Work on all sentences and put those that succeeded together; raises `UserFacingError` when none did."""
    check_plan(plan)
    finished, n_resumed = prepare(plan, folder, progress, workers)
    sentences, report = offsets_taken_out(plan, finished)
    if not sentences:
        first = report.failures[0]
        raise UserFacingError(f"No sentence could be imported; '{first.sentence}': {first.failure}")
    return corpus_of(plan, sentences, report), replace(report, n_resumed=n_resumed)


def forget(plan: ImportPlan, folder: Path) -> None:
    """Remove the finished sentences of ``plan`` from ``folder``."""
    for sentence in plan.sentences:
        cache_path(folder, plan, sentence).unlink(missing_ok=True)


def _longest_gap_s(plan: ImportPlan) -> float:
    """What mending left open is masked; so is nothing that it filled."""
    return min(LONGEST_GAP_S, plan.mending.longest_gap_s)


def prepare(
    plan: ImportPlan, folder: Path, progress: Progress = SILENT, workers: Workers = here
) -> tuple[list[KeptSentence | SentenceReport], int]:
    """Work on all sentences that ``folder`` does not hold yet.

    returns : in the plan's order the finished sentence, or the report of one that failed; and how many were there
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserFacingError(
            f"The import's finished sentences cannot be kept in '{folder}': {error.strerror}.",
            "Let EFASE_CACHE_DIR name a folder that can be written.",
        ) from error
    paths = [cache_path(folder, plan, sentence) for sentence in plan.sentences]
    todo = [i for i, (path, sentence) in enumerate(zip(paths, plan.sentences)) if kept(path, sentence) is None]
    failures: dict[int, str] = {}
    bare = replace(plan, sentences=())
    calls = ((_work, (bare, plan.sentences[i], str(paths[i]), i)) for i in todo)
    for n, (i, failure) in enumerate(workers(calls)):
        if failure:
            failures[i] = failure
        progress.step((n + 1) / len(todo), f"{plan.sentences[i].name} read and mended")
    finished = []
    for i, (path, sentence) in enumerate(zip(paths, plan.sentences)):
        found = None if i in failures else kept(path, sentence)
        finished.append(failed(sentence, failures.get(i, "Its finished work was lost.")) if found is None else found)
    return finished, len(plan.sentences) - len(todo)


def _work(plan: ImportPlan, sentence: SentencePlan, path: str, number: int) -> tuple[int, str]:
    """Do one sentence and keep it; returns its number and why it failed, or ""."""
    try:
        keep(Path(path), work_on(plan, sentence))
    except UserFacingError as error:
        return number, str(error)
    except OSError as error:
        if shutil.disk_usage(Path(path).parent).free == 0:
            raise
        return number, f"{error.strerror or error}."
    except MemoryError:
        return number, "There is not enough memory for it."
    except Exception as error:  # one sentence's trouble, also by our own fault, shall not stop the other 499
        return number, f"This should not have happened ({type(error).__name__}: {error})."
    return number, ""


def offsets_taken_out(
    plan: ImportPlan, finished: Iterable[KeptSentence | SentenceReport]
) -> tuple[list[KeptSentence], ImportReport]:
    """Shift each sentence by its own offset and, as the plan asks, by a measured one."""
    finished = list(finished)
    estimates = [f.offset for f in finished if isinstance(f, KeptSentence) and f.offset is not None]
    session = pooled_offset(estimates)
    own = {sentence.name: sentence.offset_s for sentence in plan.sentences}
    ready, rows = [], []
    for each in finished:
        if isinstance(each, SentenceReport):
            rows.append(each)
            continue
        out_s = own[each.recording.sentence] + _measured(plan.offsets, each.offset, session)
        recording = each.recording
        if out_s:
            recording = replace(recording, positions=shifted(recording.positions, recording.rate_hz, out_s))
        report = replace(each.report, offset_taken_out_s=round(out_s, 4))
        ready.append(KeptSentence(recording, report, each.offset))
        rows.append(report)
    told = (None, None) if session is None else (round(session.offset_s, 4), round(session.confidence, 3))
    return ready, ImportReport(tuple(rows), *told)


def _measured(how: str, own: OffsetEstimate | None, session: OffsetEstimate | None) -> float:
    chosen = {"keep": None, "session": session, "each": own}[how]
    return chosen.offset_s if chosen is not None and chosen.confidence >= SURE else 0.0


def corpus_of(plan: ImportPlan, sentences: list[KeptSentence], report: ImportReport) -> Corpus:
    """Return the corpus that the finished sentences make."""
    from core.evaluation.split import hold_out

    recordings = [sentence.recording for sentence in sentences]
    names = tuple(plan.markers.values()) or recordings[0].marker_names
    groups = {part: tuple(members) for part, members in plan.groups.items() if members}
    steady = {"origin": () if plan.origin is None else (plan.origin,), "rigid": tuple(plan.rigid)}
    groups |= {part: members for part, members in steady.items() if members}
    groups = {part: members for part, members in groups.items() if steady.get(part, members)}
    corpus = Corpus(plan.name, recordings, names, groups, dict(plan.landmarks), with_scale=plan.with_scale,
                    outer_eye_mm=plan.outer_eye_mm, report={KEY: report.as_dict()})  # fmt: skip
    return hold_out(corpus, plan.hold_out) if plan.hold_out else corpus
