"""`efase train`: models that are learnt from captures or from an artist's own curves."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import progress_bar, tell
from app.verbs.options import AudioDir, Database, Json, Lexicon, Rate, ShapeNames, ShapeSheet

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
            help="An artist's curves, .csv, .json, .npy or .npz; beside each, of its name, a transcript (.TextGrid, "
            ".lab) or a sound, with its text (.txt) or to be recognised; a folder for all in it; repeat for more.",
        ),
    ] = None,
    shape_names: ShapeNames = None,
    shape_sheet: ShapeSheet = None,
    rate: Rate = None,
    audio_dir: AudioDir = None,
    lexicon: Lexicon = None,
    rig: Annotated[str, typer.Option(help="Controls that captures become: arkit, lips or components.")] = "arkit",
    form: Annotated[str, typer.Option(help="best, printed, cohen-massaro or cohen-massaro-normalised.")] = "best",
    sentences: Annotated[int | None, typer.Option(min=1, help="Learn from the first so many; all when absent.")] = None,
    json: Json = False,
) -> None:
    """Learn dominated animemes; a run that was cut goes on where it was."""
    from app.animeme_training import TrainingJob, in_words, run
    from core.animeme.artist_curves import CurveReading

    with progress_bar("train") as progress:
        reading = CurveReading(shape_names, shape_sheet, rate, audio_dir, lexicon)
        answer = run(TrainingJob(output, db, corpus, tuple(curves or ()), reading, rig, form, sentences), progress)
    tell(answer, in_words, json)
