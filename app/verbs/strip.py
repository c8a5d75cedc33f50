"""The verb that draws film strips: strip."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar, warn
from app.verbs.options import Background, Database, Json
from core.errors import UserFacingError


def strip(
    audio: Annotated[Path, typer.Argument(help="WAV, FLAC or OGG.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Picture to write (.png).")],
    text: Annotated[str | None, typer.Option(help="What is said, or a text file with it.")] = None,
    phones: Annotated[Path | None, typer.Option(help="TextGrid, label or `start end phone` file instead.")] = None,
    db: Database = None,
    emotion: Annotated[
        list[str] | None, typer.Option(help="neutral, happiness, anger, sadness; repeat for a row each.")
    ] = None,
    engine: Annotated[list[str] | None, typer.Option(help="See efase synth; repeat for a row each.")] = None,
    captured: Annotated[bool, typer.Option("--captured", help="One more row: what was captured of these words.")] = (
        False
    ),
    count: Annotated[int | None, typer.Option(help="So many even moments; 8.")] = None,
    times: Annotated[str | None, typer.Option(help="Moments in seconds instead, commas between.")] = None,
    face: Annotated[str, typer.Option(help="default, ben, rosa, otto, pip, or a mesh.")] = "default",
    markers: Annotated[Path | None, typer.Option(help="CSV `marker,vertex` for a face of your own.")] = None,
    style: Annotated[str, typer.Option(help="face, shaded, wireframe or markers.")] = "face",
    size: Annotated[str, typer.Option(help="Picture size of one face.")] = "192x240",
    background: Background = None,
    title: Annotated[str, typer.Option(help="Words over the strip.")] = "",
    json: Json = False,
) -> None:
    """Draw a face at moments of a sentence in one picture, a row for each emotion or engine, phones under it."""
    from app.export import background_colour, video_size
    from app.strip_job import StripJob, run
    from app.strips import StripSettings

    if count is not None and times is not None:
        raise UserFacingError("The moments are told by --count and by --times; choose one of them.")
    settings = StripSettings(
        () if times is None else _seconds(times), StripSettings.count if count is None else count, video_size(size),
        style, background_colour(background), title,
    )  # fmt: skip
    job = StripJob(audio, output, text, phones, db, tuple(emotion or ("neutral",)), tuple(engine or ("search",)),
                   captured, face, markers, settings)  # fmt: skip
    with progress_bar("strip") as progress:
        answer = run(job, progress)
    warn(answer["warnings"])
    if json:
        print_json(answer)
    else:
        print(answer["outputs"][0])


def _seconds(text: str) -> tuple[float, ...]:
    from core.speech.text_file import seconds

    return tuple(seconds(part.strip(), "--times") for part in text.split(","))
