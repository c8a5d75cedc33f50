"""The verb that takes captures in: import."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

import typer

from app.terminal import progress_bar, tell
from app.verbs.options import AudioDir, Json, Lexicon, Rate, ShapeNames, ShapeSheet
from core.errors import UserFacingError

_PICTURE = re.compile("([0-9]{1,5})x([0-9]{1,5})")


def import_captures(
    files: Annotated[list[Path] | None, typer.Argument(help="Files and folders of captures; docs/captures.md.")] = None,
    output: Annotated[
        list[Path] | None,
        typer.Option("--output", "-o", help="Database (.h5), film or markers of each take; repeat for more."),
    ] = None,
    plan: Annotated[Path | None, typer.Option(help="Carry out this plan instead of choosing files.")] = None,
    save_plan: Annotated[Path | None, typer.Option(help="Write the plan that was made, to read and change.")] = None,
    name: Annotated[str | None, typer.Option(help="Of the database.")] = None,
    markers_like: Annotated[
        str | None, typer.Option(metavar="DB", help="Match markers to this database's ('demo' for the demo's).")
    ] = None,
    poses_like: Annotated[
        Path | None, typer.Option(metavar="DB", help="Fill gaps of short takes by this database of the same actor.")
    ] = None,
    emotion: Annotated[str | None, typer.Option(help="Of all sentences; read from file names when absent.")] = None,
    audio_dir: AudioDir = None,
    offsets: Annotated[str | None, typer.Option(help="Take measured lateness out: keep, session or each.")] = None,
    longest_gap: Annotated[float | None, typer.Option(metavar="S", help="Longer gaps stay open; 0.5 s.")] = None,
    faults: Annotated[bool | None, typer.Option("--faults/--no-faults", help="Mend spikes and swaps.")] = None,
    rate: Rate = None,
    unit: Annotated[str | None, typer.Option(help="mm, cm, m or in, for files that do not tell.")] = None,
    picture: Annotated[str | None, typer.Option(help="WIDTHxHEIGHT in pixels, for landmarks in fractions.")] = None,
    shape_names: ShapeNames = None,
    shape_sheet: ShapeSheet = None,
    lexicon: Lexicon = None,
    dims: Annotated[int | None, typer.Option(min=2, max=300, help="PCA dimensions.")] = None,
    hold_out: Annotated[str | None, typer.Option(help="Hold out by sentences, letters or digits.")] = None,
    face: Annotated[str, typer.Option(help="Of films: default, ben, rosa, otto, pip, or a mesh.")] = "default",
    failures: Annotated[Path | None, typer.Option(help="Write what failed and why (.csv).")] = None,
    jobs: Annotated[int, typer.Option(min=-1, help="Processes; -1 is one a core.")] = -1,
    cluster: Annotated[str | None, typer.Option(metavar="tcp://HOST:PORT", help="A Dask scheduler.")] = None,
    json: Json = False,
) -> None:
    """Take captures in: match markers, mend, align, and build a motion database; a killed import goes on."""
    from app.importing import ImportJob, in_words, run
    from core.importing.plan import Reading

    reading = Reading(rate, unit, _size(picture), shape_names=None if shape_names is None else str(shape_names),
                      shape_sheet=None if shape_sheet is None else str(shape_sheet))  # fmt: skip
    job = ImportJob(
        tuple(files or ()), tuple(output or ()), plan, save_plan, name, markers_like, poses_like, emotion, audio_dir,
        offsets, longest_gap, faults, reading, lexicon, dims, hold_out, face, failures, jobs or -1, cluster,
    )  # fmt: skip
    with progress_bar("import") as progress:
        answer = run(job, progress)
    tell(answer, in_words, json)


def _size(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    found = _PICTURE.fullmatch(text)
    if found is None:
        raise UserFacingError(f"'{text}' is not a picture size.", "Write it as 1920x1080.")
    return int(found[1]), int(found[2])
