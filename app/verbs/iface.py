"""`efase train iface`: a face that speaks what it hears, learnt from a motion database."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import Database, Json


def train_iface(
    output: Annotated[
        Path | None, typer.Option("--output", "-o", "--out", help="File for the face (.npz); the cache when absent.")
    ] = None,
    db: Database = None,
    variant: Annotated[str, typer.Option(help="modern, or paper (as printed in 2002).")] = "modern",
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same face.")] = 0,
    json: Json = False,
) -> None:
    """Learn a face that speaks what it hears, from the sentences of a database that are kept with their sound."""
    from app.iface_training import TrainingJob, in_words, run

    with progress_bar("train") as progress:
        answer = run(TrainingJob(output, db, variant, seed), progress)
    if json:
        print_json(answer)
    else:
        print(in_words(answer))
