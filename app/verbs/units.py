"""The verb that learns motion units: units."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import Database, Json
from core.errors import UserFacingError


def units(
    db: Database = None,
    count: Annotated[int | None, typer.Option(min=1, max=300, help="Units of speech, by hand.")] = None,
    covered: Annotated[float | None, typer.Option(help="Share of neutral speech they cover; 0.9756.")] = None,
    expression_count: Annotated[
        int | None, typer.Option(min=1, max=300, help="Units of each expression; 2 as in the paper.")
    ] = None,
    expression_covered: Annotated[
        float | None, typer.Option(help="Share of what speech leaves of an expression that its units cover.")
    ] = None,
    keyframes: Annotated[str, typer.Option(help="captured (in the database) or drawn (by the face's shapes).")] = (
        "captured"
    ),
    face: Annotated[str, typer.Option(help="default, ben, rosa, otto or pip.")] = "default",
    picture: Annotated[Path | None, typer.Option(help="Draw the eight keyframes, as figure 4 (.png).")] = None,
    units_picture: Annotated[
        Path | None, typer.Option("--units-picture", help="Draw each unit to either side of its mean (.png).")
    ] = None,
    json: Json = False,
) -> None:
    """Learn motion units from a database: how many cover how much, and the keyframes they convert to."""
    from app.unit_report import UnitsJob, in_words, run

    job = UnitsJob(db, _how_many(count, covered, "--count", "--covered", UnitsJob.utterance),
                   _how_many(expression_count, expression_covered, "--expression-count", "--expression-covered",
                             UnitsJob.expression),
                   keyframes, face, picture, units_picture)  # fmt: skip
    with progress_bar("units") as progress:
        answer = run(job, progress)
    if json:
        print_json(answer)
    else:
        print(in_words(answer))


def _how_many(
    count: int | None, covered: float | None, by_count: str, by_share: str, otherwise: int | float
) -> int | float:
    if count is not None and covered is not None:
        raise UserFacingError(f"The units are told by {by_count} and by {by_share}; choose one of them.")
    if covered is not None and not 0.0 < covered < 1.0:
        raise UserFacingError(f"The share {covered:g} of {by_share} does not lie between 0 and 1.")
    if count is not None:
        return count
    return otherwise if covered is None else covered
