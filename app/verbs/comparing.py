"""The verb that holds two engines against each other: compare."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import progress_bar, tell
from app.verbs.options import Background, Database, Json, Language, Lexicon, PhoneTable, Strict


def compare(
    speech: Annotated[str, typer.Argument(help="WAV, FLAC or OGG, or the name of a captured sentence.")],
    engines: Annotated[
        tuple[str, str], typer.Option(metavar="A B", help="Two engines; `captured` is the capture of the sentence.")
    ] = ("search", "animeme"),
    output: Annotated[
        list[Path] | None,
        typer.Option("--output", "--out", "-o", help=".csv (curves), .avi or .mp4 (side by side); repeat for more."),
    ] = None,
    text: Annotated[str | None, typer.Option(help="What is said, or a text file with it.")] = None,
    phones: Annotated[Path | None, typer.Option(help="TextGrid, label or `start end phone` file instead.")] = None,
    db: Database = None,
    emotion: Annotated[str | None, typer.Option(help="neutral, happiness, anger or sadness.")] = None,
    emotions: Annotated[Path | None, typer.Option(help="Text lines `start end emotion [intensity]`.")] = None,
    face: Annotated[str, typer.Option(help="default, ben, rosa, otto, pip, or a face of your own.")] = "default",
    fps: Annotated[str, typer.Option(help="24, 25, 29.97, 30 or 60.")] = "30",
    size: Annotated[str, typer.Option(help="Picture size.")] = "1280x720",
    style: Annotated[str, typer.Option(help="face, shaded, wireframe or markers.")] = "face",
    background: Background = None,
    lexicon: Lexicon = None,
    language: Language = None,
    phone_table: PhoneTable = None,
    strict: Strict = False,
    json: Json = False,
) -> None:
    """Let two engines say the same: how far they are apart, and how far from the capture if there is one."""
    from app.comparing import ComparisonJob, in_words, run
    from app.export import VideoSettings, background_colour, frame_rate, video_size

    video = VideoSettings(
        frame_rate(fps), *video_size(size), style,
        background=background_colour(background),
    )  # fmt: skip
    job = ComparisonJob(
        speech=speech, engines=tuple(engines), outputs=tuple(output or ()), text=text, phones=phones, database=db,
        emotion=emotion, emotions=emotions, lexicon=lexicon, strict=strict, language=language,
        phone_table=phone_table, face=face, video=video,
    )  # fmt: skip
    with progress_bar("compare") as progress:
        answer = run(job, progress)
    tell(answer, in_words, json)
