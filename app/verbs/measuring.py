"""The verb that measures engines: evaluate."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import Database, Json


def evaluate(
    db: Database = None,
    corpus: Annotated[Path | None, typer.Option(help="Measure on this corpus folder instead.")] = None,
    split: Annotated[str, typer.Option(help="test, tune or all.")] = "test",
    engine: Annotated[list[str] | None, typer.Option(help="Repeat for more; all when absent.")] = None,
    report: Annotated[Path | None, typer.Option(help="Folder for the page, its figures and the JSON.")] = None,
    json: Json = False,
) -> None:
    """Measure engines on captured sentences that the database does not hold."""
    from app.evaluate import PAGE, EvaluationJob, as_table, run

    with progress_bar("evaluate") as progress:
        answer = run(EvaluationJob(db, corpus, split, tuple(engine or ()), report), progress)
    if json:
        print_json(answer)
    else:
        print(as_table(answer))
        if report is not None:
            print(report / PAGE)
