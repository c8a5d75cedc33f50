"""Verbs that make motion: demo, synth, export."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import note, print_json, progress_bar, tell_written
from app.verbs.options import (
    OUTPUTS,
    Background,
    Database,
    Hold,
    Json,
    KeyPoses,
    Language,
    Lexicon,
    PhoneTable,
    Span,
    Strict,
)
from core.errors import UserFacingError

# of core.synthesis.registry, which takes too long to import for a help text; a test compares them
_ENGINES = (
    "search, search-single (one path), search-paper (printed), animeme, iface (by ear) or iface-paper (printed); to "
    "compare with: animeme-printed, mmm, cohen-massaro, phone-means, random, static."
)


def demo(
    out: Annotated[Path, typer.Option(help="Folder for the pictures and films.")] = Path("out"),
    json: Json = False,
) -> None:
    """Synthesise the demo sentences in four emotions and draw the window, without a display."""
    from app.headless import write_demo

    with progress_bar("demo") as progress:
        written = write_demo(out, progress)
    if json:
        print_json(written)
    else:
        for path in written["outputs"]:
            print(path)
        for sentence in written["notes"]:
            note(sentence)


def synth(
    audio: Annotated[Path | None, typer.Argument(help="WAV, FLAC or OGG.")] = None,
    output: Annotated[list[Path] | None, typer.Option("--output", "-o", help=OUTPUTS)] = None,
    batch: Annotated[Path | None, typer.Option(help="CSV `audio,text,emotion,output`, a line each.")] = None,
    failures: Annotated[Path | None, typer.Option(help="With --batch: write what failed and why (.csv).")] = None,
    jobs: Annotated[int, typer.Option(min=-1, help="With --batch: processes; -1 is one a core.")] = -1,
    cluster: Annotated[str | None, typer.Option(metavar="tcp://HOST:PORT", help="A Dask scheduler.")] = None,
    text: Annotated[str | None, typer.Option(help="What is said, or a text file with it.")] = None,
    phones: Annotated[Path | None, typer.Option(help="TextGrid, label or `start end phone` file instead.")] = None,
    db: Database = None,
    emotion: Annotated[str | None, typer.Option(help="neutral, happiness, anger or sadness.")] = None,
    emotions: Annotated[Path | None, typer.Option(help="Text lines `start end emotion [intensity]`.")] = None,
    engine: Annotated[str, typer.Option(help=_ENGINES)] = "search",
    model: Annotated[Path | None, typer.Option(help="Engine iface: a face that `efase train iface` wrote.")] = None,
    hold: Hold = False,
    face: Annotated[
        str, typer.Option(help="default, ben, rosa, otto, pip, cast (all), a face file (.npz) or a mesh.")
    ] = "default",
    markers: Annotated[Path | None, typer.Option(help="CSV `marker,vertex` for a face of your own.")] = None,
    poses: KeyPoses = None,
    backend: Annotated[str, typer.Option(help="auto, numpy, opencl or glsl.")] = "auto",
    pin: Annotated[list[str] | None, typer.Option(metavar="SLOT=NODE", help="Tie a motion node to a slot.")] = None,
    weights: Annotated[str, typer.Option(help="tuned (the database's), default (untuned), or a JSON file.")] = "tuned",
    fps: Annotated[str, typer.Option(help="24, 25, 29.97, 30 or 60.")] = "30",
    start_frame: Annotated[int, typer.Option(min=0, help="Number of the first frame (timecode).")] = 0,
    size: Annotated[str, typer.Option(help="Picture size.")] = "640x480",
    style: Annotated[str, typer.Option(help="face, shaded (without texture), wireframe or markers.")] = "face",
    texture: Annotated[Path | None, typer.Option(help="PNG or JPEG for a mesh with texture coordinates.")] = None,
    head: Annotated[bool, typer.Option("--head/--no-head", help="Let the head move, subtly.")] = True,
    gaze: Annotated[bool, typer.Option("--gaze/--no-gaze", help="Let the eyes wander.")] = True,
    background: Background = None,
    span: Span = None,
    lexicon: Lexicon = None,
    language: Language = None,
    phone_table: PhoneTable = None,
    strict: Strict = False,
    json: Json = False,
) -> None:
    """Animate speech: find the best path through the database and write films or markers."""
    from app.batch import BatchJob, in_words, run_batch
    from app.export import VideoSettings, background_colour, frame_rate, span_of_time, video_size
    from app.synthesis import SynthesisJob, run

    if (audio is None) == (batch is None) or (output is None) != (batch is not None):
        raise UserFacingError("Name a sound and its outputs, or a table of them with --batch.")
    job = SynthesisJob(
        audio=audio or batch, outputs=tuple(output or ()), text=text, phones=phones, database=db, emotion=emotion,
        emotions=emotions, engine=engine, holds=hold, face=face, marker_file=markers, key_poses=poses,
        csv_is_live_link=engine == "animeme", backend=backend, pins=tuple(pin or ()),
        weights=weights,
        video=VideoSettings(frame_rate(fps), *video_size(size), style, start_frame, head, gaze, texture,
                            background_colour(background), span_of_time(span)),
        lexicon=lexicon, strict=strict, language=language, phone_table=phone_table, model=model,
    )  # fmt: skip
    with progress_bar("synth") as progress:
        if batch is None:
            answer = run(job, progress)
        else:
            answer = run_batch(BatchJob(batch, job, None, failures, jobs or -1, cluster), progress)
    if batch is None:
        tell_written(answer, json)
    elif json:
        print_json(answer)
    else:
        print(in_words(answer))


def export_project(
    project: Annotated[Path, typer.Argument(help="A project (.efase).")],
    output: Annotated[list[Path], typer.Option("--output", "-o", help=OUTPUTS)],
    db: Annotated[Path | None, typer.Option("--db", help="Motion database, instead of the project's own.")] = None,
    size: Annotated[str, typer.Option(help="Picture size.")] = "800x600",
    style: Annotated[str | None, typer.Option(help="face, shaded, wireframe or markers.")] = None,
    background: Background = None,
    span: Span = None,
    json: Json = False,
) -> None:
    """Write films or markers of a project, with the same motion as in the window."""
    from app.export import background_colour, span_of_time, video_size
    from app.project_export import ExportJob, run

    job = ExportJob(
        project, tuple(output), db, video_size(size), style, background_colour(background), span_of_time(span)
    )
    with progress_bar("export") as progress:
        answer = run(job, progress)
    tell_written(answer, json)
