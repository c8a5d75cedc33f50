"""Verbs that speak to other programs: lipsync, curves, poses."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import progress_bar, tell_written
from app.verbs.options import Background, Database, Hold, Json, KeyPoses, Language, Lexicon, PhoneTable, Span, Strict
from core.errors import UserFacingError

_OUTPUTS = (
    ".csv (Live Link Face), .curves.csv, .json, .glb, .usd (.points.usd: a point cache), .avi, .mp4, .png or .c3d; "
    "repeat for more."
)
_FACE = "default, ben, rosa, otto, pip, cast (all five, in films), a glTF with morph targets, or a folder of OBJ files."


def lipsync(
    audio: Annotated[Path, typer.Argument(help="WAV, FLAC or OGG.")],
    output: Annotated[list[Path], typer.Option("--output", "-o", help=_OUTPUTS)],
    text: Annotated[str | None, typer.Option(help="What is said, or a text file; recognised when absent.")] = None,
    phones: Annotated[Path | None, typer.Option(help="TextGrid, label or `start end phone` file instead.")] = None,
    db: Database = None,
    model: Annotated[
        Path | None, typer.Option(help="Animemes of controls, as `efase train animeme` writes them.")
    ] = None,
    emotion: Annotated[str | None, typer.Option(help="neutral, happiness, anger or sadness.")] = None,
    emotions: Annotated[Path | None, typer.Option(help="Text lines `start end emotion [intensity]`.")] = None,
    hold: Hold = False,
    face: Annotated[str, typer.Option(help=_FACE)] = "default",
    poses: KeyPoses = None,
    fps: Annotated[str, typer.Option(help="24, 25, 29.97, 30 or 60.")] = "30",
    start_frame: Annotated[int, typer.Option(min=0, help="Number of the first frame (timecode).")] = 0,
    size: Annotated[str, typer.Option(help="Picture size.")] = "640x480",
    head: Annotated[bool, typer.Option("--head/--no-head", help="Let the head move in films, subtly.")] = True,
    gaze: Annotated[bool, typer.Option("--gaze/--no-gaze", help="Let the eyes wander in films.")] = True,
    background: Background = None,
    span: Span = None,
    lexicon: Lexicon = None,
    language: Language = None,
    phone_table: PhoneTable = None,
    strict: Strict = False,
    json: Json = False,
) -> None:
    """Speech to the controls of a character: `efase synth --engine animeme`, for rigs."""
    from app import lipsync as by_model
    from app import synthesis
    from app.export import VideoSettings, background_colour, frame_rate, span_of_time, video_size

    if model is not None and db is not None:
        raise UserFacingError("A model and a database were given; a model of controls needs no database.")
    video = VideoSettings(
        frame_rate(fps), *video_size(size), start_frame=start_frame, head=head, gaze=gaze,
        background=background_colour(background), span_s=span_of_time(span),
    )  # fmt: skip
    common = dict(
        audio=audio, outputs=tuple(output), text=text, phones=phones, emotion=emotion, emotions=emotions, face=face,
        key_poses=poses, video=video, lexicon=lexicon, strict=strict, language=language, phone_table=phone_table,
        holds=hold,
    )  # fmt: skip
    with progress_bar("lipsync") as progress:
        if model is None:
            job = synthesis.SynthesisJob(database=db, engine="animeme", csv_is_live_link=True, **common)
            answer = synthesis.run(job, progress)
        else:
            answer = by_model.run(by_model.LipsyncJob(model=model, **common), progress)
    tell_written(answer, json)


def curves(
    track: Annotated[Path, typer.Argument(help="Curves: Live Link Face or other .csv, .json of ours, .npy, .npz.")],
    output: Annotated[list[Path], typer.Option("--output", "-o", help=_OUTPUTS)],
    names: Annotated[Path | None, typer.Option(help="Names of the columns of an .npy: a text, .json or .npy.")] = None,
    rate: Annotated[float | None, typer.Option(help="Frames a second, where the file does not tell.")] = None,
    mapping: Annotated[Path | None, typer.Option(help="Table of a studio's names and ARKit's: .xlsx or .csv.")] = None,
    audio: Annotated[Path | None, typer.Option(help="Sound for films.")] = None,
    face: Annotated[str, typer.Option(help=_FACE)] = "default",
    fps: Annotated[str, typer.Option(help="24, 25, 29.97, 30 or 60.")] = "30",
    size: Annotated[str, typer.Option(help="Picture size.")] = "640x480",
    background: Background = None,
    span: Span = None,
    json: Json = False,
) -> None:
    """Bring curves of one program to another, or play them on a face."""
    from app.curve_export import CurveJob, run
    from app.export import VideoSettings, background_colour, frame_rate, span_of_time, video_size

    video = VideoSettings(
        frame_rate(fps), *video_size(size), background=background_colour(background), span_s=span_of_time(span),
    )  # fmt: skip
    with progress_bar("curves") as progress:
        answer = run(CurveJob(track, tuple(output), names, rate, mapping, audio, face, video), progress)
    tell_written(answer, json)


def poses(
    output: Annotated[Path, typer.Option("--output", "-o", help="File of poses to write (.json).")],
    db: Database = None,
    face: Annotated[
        str, typer.Option(help="The rig: a glTF with morph targets, a folder of OBJ files ...")
    ] = "default",
    keys: Annotated[int, typer.Option(min=2, max=40, help="How many key lip shapes.")] = 7,
    json: Json = False,
) -> None:
    """Choose key lip shapes of a database and pose a rig for them, for an artist to go on from."""
    from app.first_poses import run

    with progress_bar("poses") as progress:
        answer = run(output, db, face, keys, progress)
    tell_written(answer, json)
