"""`efase evaluate`: engines beside captures that they have not seen, as one object and as a page."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

from app.demo import open_named
from app.report.evaluation import Measured, evaluation_figures, evaluation_page
from app.report.page import number
from core.errors import UserFacingError
from core.evaluation.emotion_check import EmotionClassifier, Recognition, tells_emotions
from core.evaluation.evaluate import Evaluation, evaluate
from core.evaluation.phrase_times import phrase_times_s
from core.evaluation.split import SPLITS, hold_out
from core.media.swap_in import check_target, swapped_in
from core.motion.database import MotionDatabase
from core.motion.readers.corpus_folder import read_corpus
from core.motion.recording import Recording
from core.progress import SILENT, Progress
from core.synthesis.registry import make_engines
from gpu.device import open_kernels

PAGE, ANSWER = "report.html", "report.json"


@dataclass(frozen=True)
class EvaluationJob:
    """Everything that `efase evaluate` was told; see its help."""

    database: Path | None = None
    corpus: Path | None = None
    split: str = "test"
    engines: tuple[str, ...] = ()
    report: Path | None = None


def run(job: EvaluationJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job, write the report if one is wanted, and return the object of ``--json``.

    Nothing is written before all is measured. Raises `UserFacingError` for what cannot be opened, split, or written.
    """
    if job.split not in (*SPLITS, "all"):
        raise UserFacingError(f"There is no split '{job.split}'.", f"Choose one of {', '.join(SPLITS)}, all.")
    if job.report is not None:
        check_target(job.report / PAGE, folders_are_made=True)
    database = open_named(job.database, progress.part(0.0, 0.1))
    database, name, recordings = _material(job, database, progress.part(0.1, 0.15))
    engines = make_engines(job.engines, database, lambda: open_kernels()[0])
    found = evaluate(database, recordings, engines, progress.part(0.15, 0.9))
    transcripts = [recording.transcript for recording in recordings]
    times = {}
    for i, (label, engine) in enumerate(engines.items()):
        progress.step(0.9 + 0.08 * i / len(engines), f"timing {label}")
        times[label] = phrase_times_s(engine, transcripts)
    recognised = _recognised(database, found)
    measured = Measured(name, job.split, database, found, times, recognised)
    answer = _answer(measured)
    if job.report is not None:
        progress.step(0.98, "writing the report")
        _write(job.report, measured, answer)
    progress.step(1.0, "measured")
    return answer


def as_table(answer: dict) -> str:
    """Write the figures of ``answer`` as a table that reads as text and as Markdown."""
    columns = {
        "error_mm2": ("mm²", 2), "lip_error_mm": ("lip mm", 2), "lip_gap_r": ("gap r", 2),
        "closure_rate": ("closed", 2),
        "gap_variance_ratio": ("gap var", 2), "velocity_variance_ratio": ("vel var", 2),
        "acceleration_variance_ratio": ("acc var", 2), "seconds_per_sentence": ("seconds", 3),
    }  # fmt: skip
    rows = [("", *(title for title, _ in columns.values()))]
    for name, figures in {**answer["engines"], "noise of the capture": answer["floor"]}.items():
        rows.append((name, *(number(figures.get(key), digits) for key, (_, digits) in columns.items())))
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = [
        "| " + " | ".join((cells[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(cells[1:], widths[1:])))) + " |"
        for cells in rows
    ]
    rule = "|" + "|".join("-" * (w + 1) + ("-" if i == 0 else ":") for i, w in enumerate(widths)) + "|"
    said = f"{answer['corpus']}, split {answer['split']}, {answer['sentences']} sentences"
    return "\n".join(
        (f"{said}{' (synthetic)' if answer['database']['synthetic'] else ''}", "", lines[0], rule, *lines[1:])
    )


def _material(
    job: EvaluationJob, database: MotionDatabase, progress: Progress
) -> tuple[MotionDatabase, str, list[Recording]]:
    """Return the database, the name of the corpus, and the recordings to measure on."""
    if job.corpus is None:
        splits = [split for split in SPLITS if database.held_out.get(split)] if job.split == "all" else [job.split]
        recordings = [r for split in splits or SPLITS for r in database.held_out_recordings(split)]
        return database, database.name, recordings
    corpus = read_corpus(job.corpus, progress)
    if job.split == "all":
        built_of = {(s.name, s.transcript.phones) for s in database.sentences}
        recordings = [r for r in corpus.recordings if (r.sentence, r.transcript.phones) not in built_of]
        if not recordings:
            raise UserFacingError(
                f"The database is built of all sentences of '{corpus.name}', so nothing can be measured on them.",
                "Build it with `efase build --hold-out`.",
            )
    else:
        names = set(hold_out(corpus).held_out[job.split])
        recordings = [r for r in corpus.recordings if r.sentence in names]
    return replace(database, with_scale=corpus.with_scale), corpus.name, recordings


def _recognised(database: MotionDatabase, found: Evaluation) -> dict[str, Recognition]:
    if not tells_emotions(database):
        return {}
    classifier = EmotionClassifier(database)
    comparisons = next(iter(found.engines.values())).comparisons
    answer = {"capture": classifier.recognition([(c.truth, c.truth.positions) for c in comparisons])}
    for name, result in found.engines.items():
        answer[name] = classifier.recognition([(c.truth, c.synthesised) for c in result.comparisons])
    return answer


def _answer(measured: Measured) -> dict[str, object]:
    database = measured.database
    answer = {"corpus": measured.corpus, "split": measured.split, **measured.found.as_dict()}
    for name, figures in answer["engines"].items():
        figures["seconds_by_phonemes"] = {str(n): seconds for n, seconds in measured.times[name].items()}
    answer["emotion_recognised"] = {name: found._asdict() for name, found in measured.recognised.items()}
    answer["database"] = {
        "name": database.name, "synthetic": database.synthetic, "nodes": len(database.nodes),
        "content_hash": database.content_hash, "weights": database.weights.as_dict(),
    }  # fmt: skip
    return answer


def _write(folder: Path, measured: Measured, answer: dict[str, object]) -> None:
    files = {
        PAGE: evaluation_page(measured),
        ANSWER: json.dumps(answer, indent=1, ensure_ascii=False, allow_nan=False) + "\n",
        **{f"{figure.name}.svg": figure.svg for figure in evaluation_figures(measured)},
    }
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserFacingError(f"The folder '{folder}' cannot be made: {error.strerror}.") from error
    for name, text in files.items():
        with swapped_in(folder / name) as beside:
            beside.write_text(text, encoding="utf-8")
