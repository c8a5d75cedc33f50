"""The verb that fits a face to a scan."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar, warn
from app.verbs.options import Json


def fit_face(
    scan: Annotated[Path, typer.Argument(help="OBJ, PLY, STL, glTF or GLB, in any unit and turned in any way.")],
    points: Annotated[Path, typer.Option(help="Feature points (JSON), as the window of own faces writes them.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="Face file (.npz); --face takes it.")],
    generic: Annotated[str, typer.Option(help="Who is fitted: default, ben, rosa, otto or pip.")] = "default",
    texture: Annotated[Path | None, typer.Option(help="Picture for the scan's texture coordinates.")] = None,
    photo: Annotated[Path | None, typer.Option(help="Photo to paint the face with; its points in --points.")] = None,
    json: Json = False,
) -> None:
    """Fit a face with eyes, teeth, shapes and markers to a scan of a head, by points clicked on both."""
    from app.own_face import FitJob, in_words, run

    with progress_bar("fit-face") as progress:
        answer = run(FitJob(scan, points, out, generic, texture, photo), progress)
    warn(answer["warnings"])
    if json:
        print_json(answer)
    else:
        print(in_words(answer))
        print(out)
