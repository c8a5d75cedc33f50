"""Many lines of dialogue in one go, as `efase synth --batch` asks for them: one row of a table a line."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import time
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from app.export import check_outputs
from app.synthesis import Ready, SynthesisJob, made_ready, run
from core.batch.failures import write_failures
from core.batch.journal import Journal
from core.batch.stamps import stamp
from core.batch.workers import workers_at
from core.errors import UserFacingError
from core.progress import SILENT, Progress
from core.speech.text_file import read_text

COLUMNS = ("audio", "output", "text", "phones", "emotion", "emotions", "engine")
_JOURNAL = "efase-batch-journal 1"
_PATHS = ("audio", "phones", "emotions")


@dataclass(frozen=True)
class BatchJob:
    """Everything that `efase synth --batch` was told.

    table : CSV with a header; columns `COLUMNS`, of which audio and output are needed; several outputs are split by ;
    template : what the options say of all lines; a cell that is filled wins
    journal : what is finished; beside the table when None
    failures : a table of what failed, or None
    """

    table: Path
    template: SynthesisJob
    journal: Path | None = None
    failures: Path | None = None
    jobs: int = -1
    cluster: str | None = None


def run_batch(job: BatchJob, progress: Progress = SILENT) -> dict[str, object]:
    """Synthesise every row and return the object of ``--json``.

    A row that fails is told at the end and stops no other. What the journal knows as finished, from the same request
    and the same files, and what is still there as it was written, is not made again; so a killed run goes on.
    Raises `UserFacingError` for a table that cannot be used, before anything is made.
    """
    rows = read_rows(job.table, job.template)
    began = time.perf_counter()
    failures: dict[int, str] = {}
    with Journal(job.journal or job.table.with_name(f"{job.table.name}.journal"), _JOURNAL) as journal:
        keys = {line: _key(row) for line, row in rows}
        todo = [(line, row) for line, row in rows if not _is_finished(journal.entries.get(keys[line]))]
        calls = ((_synthesise, (line, row)) for line, row in todo)
        with workers_at(job.cluster, job.jobs, "A batch") as workers:
            for n, (line, failure, warnings) in enumerate(workers(calls)):
                if failure:
                    failures[line] = failure
                else:
                    outputs = dict(todo)[line].outputs
                    journal.add(keys[line], outputs=[[str(path), *stamp(path)] for path in outputs], warnings=warnings)
                progress.step((n + 1) / len(todo), f"line {line} of {job.table.name}")
    in_order = sorted(failures.items())
    if job.failures is not None:
        write_failures(job.failures, ((f"line {line}", failure) for line, failure in in_order))
    return {
        "lines": len(rows),
        "made": len(todo) - len(failures),
        "resumed": len(rows) - len(todo),
        "failed": {str(line): failure for line, failure in in_order},
        "seconds": round(time.perf_counter() - began, 2),
        "outputs": [str(path) for line, row in rows if line not in failures for path in row.outputs],
    }


def read_rows(table: Path, template: SynthesisJob) -> list[tuple[int, SynthesisJob]]:
    """Return (line, request) of each row; files are looked for beside the table.

    Raises `UserFacingError` naming the line that is wrong, or that writes what another one writes.
    """
    try:
        reader = csv.DictReader(io.StringIO(read_text(table, "table of jobs")))
        rows = [(reader.line_num, {k: (v or "").strip() for k, v in row.items() if k}) for row in reader]
    except csv.Error as error:
        raise UserFacingError(f"'{table}' cannot be read as a table.") from error
    columns = reader.fieldnames or ()
    for column in ("audio", "output"):
        if column not in columns:
            raise UserFacingError(f"'{table}' has no column '{column}' in its header.")
    unknown = [column for column in columns if column and column not in COLUMNS]
    if unknown:
        raise UserFacingError(f"'{table}' has a column '{unknown[0]}', which means nothing here.",
                              f"Known are {', '.join(COLUMNS)}.")  # fmt: skip
    if not rows:
        raise UserFacingError(f"'{table}' lists no line of dialogue.")
    written: dict[str, int] = {}
    jobs = []
    for line, cells in rows:
        try:
            jobs.append((line, _request(table.parent, cells, template)))
            check_outputs(list(jobs[-1][1].outputs))
        except UserFacingError as error:
            raise UserFacingError(f"Line {line} of '{table}': {error.message}", error.remedy) from error
        for path in jobs[-1][1].outputs:
            first = written.setdefault(os.path.realpath(path), line)
            if first != line:
                raise UserFacingError(f"Line {line} of '{table}' writes '{path}', as does line {first}.")
    return jobs


def _request(folder: Path, cells: dict[str, str], template: SynthesisJob) -> SynthesisJob:
    for column in ("audio", "output"):
        if not cells[column]:
            raise UserFacingError(f"its {column} is empty.")
    filled = {name: cells[name] for name in COLUMNS if name != "output" and cells.get(name)}
    filled |= {name: folder / filled[name] for name in _PATHS if name in filled}
    if "phones" in filled and "text" in filled:
        raise UserFacingError("a text and a phone file are given; one of them says what is spoken.")
    outputs = tuple(folder / name.strip() for name in cells["output"].split(";") if name.strip())
    return replace(template, **filled, outputs=outputs)


# A process keeps what it opened for the line before, which is mostly what the next one needs.
_ready: dict[tuple, Ready] = {}


def _synthesise(line: int, job: SynthesisJob) -> tuple[int, str, list[str]]:
    """Make one line; returns its number, why it failed or "", and its warnings."""
    from threadpoolctl import threadpool_limits

    try:
        with threadpool_limits(1):  # as many processes as cores are at work
            key = (job.database, job.engine, job.weights, job.backend, job.model)
            if key not in _ready:
                _ready.clear()
                _ready[key] = made_ready(job)
            return line, "", run(job, ready=_ready[key])["warnings"]
    except UserFacingError as error:
        return line, str(error), []
    except MemoryError:
        return line, "There is not enough memory for it.", []
    except OSError as error:
        return line, f"{error.strerror or error}.", []
    except Exception as error:  # one line's trouble, also by our own fault, shall not stop the other 499
        return line, f"This should not have happened ({type(error).__name__}: {error}).", []


def _key(job: SynthesisJob) -> str:
    """What a line asks for, files by size and time of change: equal keys give equal outputs."""
    stamps = [[path, *stamp(Path(path))] for path in job.files_read]
    return hashlib.sha256(json.dumps([asdict(job), stamps], sort_keys=True, default=str).encode()).hexdigest()


def _is_finished(entry: dict | None) -> bool:
    return entry is not None and all([*stamp(Path(path))] == written for path, *written in entry["outputs"])


def in_words(answer: dict[str, object], most: int = 20) -> str:
    """Say in a few lines what a batch did."""
    failed = answer["failed"]
    lines = [f"{answer['made']} of {answer['lines']} lines made in {answer['seconds']:.0f} s, "
             f"{answer['resumed']} were there, {len(failed)} failed"]  # fmt: skip
    lines += [f"line {line}: {failure}" for line, failure in list(failed.items())[:most]]
    if len(failed) > most:
        lines.append(f"... and {len(failed) - most} more")
    return "\n".join(lines)
