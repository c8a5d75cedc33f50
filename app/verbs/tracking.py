"""The verb that makes a capture of a video: track."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar, warn
from app.verbs.options import Database, Json
from core.errors import UserFacingError


def track(
    video: Annotated[Path, typer.Argument(help="A face that looks into the camera, neutral in the first picture.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="Capture that efase import takes: .c3d, .trc or .csv.")],
    points: Annotated[
        str | None,
        typer.Option(help='"x,y;x,y;x,y;x,y" in the first picture: left and right mouth corner as seen in it, then '
                     "left and right outer eye corner; the mouth alone will do."),
    ] = None,
    start: Annotated[Path | None, typer.Option(help="Clicks and corrections as the window saves them (JSON).")] = None,
    db: Database = None,
    expression: Annotated[
        str | None, typer.Option(help="Whose motion units may be used: any (as when absent), neutral, happiness, ...")
    ] = None,
    json: Json = False,
) -> None:  # fmt: skip
    """Track a face in a video and write what it does as a capture, with the video's sound beside it."""
    from app.tracking import tracked
    from core.tracking.start import named_clicks
    from core.tracking.start_file import TrackingStart, read_start

    if (points is None) == (start is None):
        raise UserFacingError("Say where the face is in the first picture, with --points or --start, and not both.")
    said = TrackingStart(named_clicks(_pairs(points))) if start is None else read_start(start)
    began = time.perf_counter()
    with progress_bar("track") as progress:
        answer = tracked(video, said, out, db, expression, progress)
    answer["seconds"] = round(time.perf_counter() - began, 2)
    if json:
        print_json(answer)
        return
    warn(answer["notes"])
    print(
        f"{answer['outputs'][0]}: {answer['frames']} frames of {answer['points']} points, {answer['rate_hz']:g} Hz; "
        f"trust {answer['trust']:.2f}, {answer['lost']} frames lost; {answer['frames_per_s']:.0f} frames a second"
    )


def _pairs(text: str) -> list[tuple[float, float]]:
    try:
        pairs = [tuple(float(number) for number in pair.split(",")) for pair in text.strip().strip(";").split(";")]
    except ValueError:
        pairs = []
    if not pairs or any(len(pair) != 2 or not all(abs(n) < 1e6 for n in pair) for pair in pairs):
        raise UserFacingError(f"'{text[:60]}' are no points.", "Write them as x,y;x,y;x,y;x,y in pixels.")
    return pairs
