"""`efase train`: models that are learnt from captures or from an artist's own curves."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import Database, Json

train = typer.Typer(help="Learn a model of how someone speaks.", rich_markup_mode=None)


@train.callback()
def _models() -> None:
    """Keep the name of the model a word of its own on the command line."""


@train.command("animeme")
def train_animeme(
    output: Annotated[Path, typer.Option("--output", "-o", help="File to write the animemes to (.npz).")],
    db: Database = None,
    corpus: Annotated[Path | None, typer.Option(help="Learn from this corpus folder instead.")] = None,
    curves: Annotated[
        list[Path] | None,
        typer.Option(
            "--controls",
            help="An artist's curves, .csv or .json, each beside a transcript of its name, "
            ".TextGrid or .lab; a folder for all in it; repeat for more.",
        ),
    ] = None,
    rig: Annotated[str, typer.Option(help="Controls that captures become: arkit, lips or components.")] = "arkit",
    form: Annotated[str, typer.Option(help="best, printed, cohen-massaro or cohen-massaro-normalised.")] = "best",
    sentences: Annotated[int | None, typer.Option(min=1, help="Learn from the first so many; all when absent.")] = None,
    json: Json = False,
) -> None:
    """Learn dominated animemes; a run that was cut goes on where it was."""
    from app.animeme_training import TrainingJob, in_words, run

    with progress_bar("train") as progress:
        answer = run(TrainingJob(output, db, corpus, tuple(curves or ()), rig, form, sentences), progress)
    if json:
        print_json(answer)
    else:
        print(in_words(answer))
