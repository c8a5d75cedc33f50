"""`efase live`: a face that speaks with whoever speaks."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar, tell
from app.verbs.options import Database, Json


def live(
    file: Annotated[Path | None, typer.Option(help="A sound file at real-time pace, instead of a microphone.")] = None,
    device: Annotated[str | None, typer.Option(help="Microphone, by its name or part of it; else the default.")] = None,
    db: Database = None,
    emotion: Annotated[str, typer.Option(help="neutral, happiness, anger or sadness, to begin with.")] = "neutral",
    intensity: Annotated[float, typer.Option(min=0.0, max=1.0, help="How strongly.")] = 1.0,
    stream: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS", help="Send frames to udp://HOST:PORT (Live Link Face) or osc://HOST:PORT (VMC)."
        ),
    ] = None,
    seconds: Annotated[float | None, typer.Option(min=0.1, help="End after so long.")] = None,
    record: Annotated[Path | None, typer.Option(metavar="PROJECT", help="Keep the session as a project.")] = None,
    window: Annotated[bool, typer.Option("--window", help="Show the face in the live window.")] = False,
    devices: Annotated[bool, typer.Option("--devices", help="List the microphones and end.")] = False,
    json: Json = False,
) -> None:
    """Let a face speak with a microphone or a file, a tenth of a second later; Ctrl-C ends it."""
    from app.live.command import LiveJob, in_words, made_ready, run

    if devices:
        _list_devices(json)
        return
    job = LiveJob(file, device, db, emotion, intensity, stream, seconds, record)
    if window:
        from app.live.window_command import run_in_window

        with progress_bar("live") as progress:
            answer = run_in_window(job, progress)
    else:
        with progress_bar("live") as progress:
            ready = made_ready(job, progress)
        answer = run(job, ready)
    tell(answer, in_words, json)


def _list_devices(json: bool) -> None:
    from dataclasses import asdict

    from app.live.microphone import input_devices

    known = [asdict(device) for device in input_devices()]
    if json:
        print_json({"devices": known})
    else:
        for device in known:
            print(f"{device['name']}  ({device['host']}{', default' if device['is_default'] else ''})")
