"""Verbs of a perception study: stimuli, stimuli-table."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from app.terminal import note, print_json, progress_bar, tell
from app.verbs.options import Database, Json
from core.errors import UserFacingError

_MOST_SURE = 0.999999  # beyond it the interval is everything


def stimuli(
    out: Annotated[Path, typer.Option("--out", help="A new folder for the films, the orders and the answer sheet.")],
    db: Database = None,
    sentence: Annotated[
        list[str] | None, typer.Option(help="Captured sentence to take the sound of; repeat for more. Else three.")
    ] = None,
    table: Annotated[Path | None, typer.Option(help="CSV `audio,text[,phones]` of sounds of your own instead.")] = None,
    films: Annotated[
        Path | None, typer.Option(help="Folder of films of a real speaker, AUDIO-EXPRESSION.mp4, as captured faces.")
    ] = None,
    expressions: Annotated[
        str, typer.Option(help="Comma between; also the answers on offer, besides not sure.")
    ] = "neutral,happiness,sadness",
    faces: Annotated[
        str | None, typer.Option(help="synthetic,captured; one of them; both where there are captures.")
    ] = None,
    engine: Annotated[str, typer.Option(help="Makes the synthetic faces; see efase synth.")] = "search",
    face: Annotated[str, typer.Option(help="default, ben, rosa, otto, pip, or a mesh.")] = "default",
    participants: Annotated[int, typer.Option(help="An even number: two groups.")] = 20,
    seed: Annotated[int, typer.Option(min=0, help="The same one makes the same codes and orders.")] = 2002,
    design: Annotated[
        str, typer.Option(help="paper (all meet everything, audio alone once) or once (each audio once in all).")
    ] = "paper",
    film: Annotated[str, typer.Option(help="mp4 or avi.")] = "mp4",
    size: Annotated[str, typer.Option(help="Picture size.")] = "640x480",
    style: Annotated[str, typer.Option(help="face, shaded, wireframe or markers.")] = "face",
    fps: Annotated[str, typer.Option(help="24, 25, 29.97, 30 or 60.")] = "30",
    head: Annotated[bool, typer.Option("--head/--no-head", help="Let head and eyes move, alike in all films.")] = True,
    json: Json = False,
) -> None:
    """Make the stimuli of a perception study: the same audio in each expression, with and without sound."""
    from app.export import VideoSettings, frame_rate, video_size
    from app.stimuli.export import in_words, run
    from app.stimuli.job import StimuliJob

    if sentence and table is not None:
        raise UserFacingError("The audio is told by --sentence and by --table; choose one of them.")
    job = StimuliJob(
        out, db, tuple(sentence or ()), table, films, _listed(expressions), _listed(faces or ""), engine, face,
        participants, seed, design, VideoSettings(frame_rate(fps), *video_size(size), style, head=head, gaze=head),
        f".{film.lower().removeprefix('.')}",
    )  # fmt: skip
    with progress_bar("stimuli") as progress:
        answer = run(job, progress)
    tell(answer, in_words, json)


def stimuli_table(
    answers: Annotated[Path, typer.Argument(help="The filled answer sheet (CSV).")],
    key: Annotated[Path | None, typer.Option(help="The study's key.csv, if it does not lie beside the sheet.")] = None,
    interval: Annotated[str, typer.Option(help="wilson, or exact (Clopper and Pearson), which is wider.")] = "wilson",
    confidence: Annotated[float, typer.Option(help="How sure the intervals are.")] = 0.95,
    csv: Annotated[Path | None, typer.Option("--csv", help="Write all cells to a table too.")] = None,
    json: Json = False,
) -> None:
    """Print the paper's tables III to VII from the answers of a perception study, with confidence intervals."""
    from core.evaluation.stimuli_files import KEY_FILE, read_answers
    from core.evaluation.stimuli_tables import answer_tables, as_csv, as_rows, as_text
    from core.media.swap_in import check_target, swapped_in

    if not 0.0 < confidence <= _MOST_SURE:
        raise UserFacingError(f"The confidence {confidence:g} does not lie between 0 and {_MOST_SURE}.")
    if csv is not None:
        check_target(csv)
        read = (answers, answers.with_name(KEY_FILE) if key is None else key)
        if csv.exists() and any(path.exists() and csv.samefile(path) for path in read):
            raise UserFacingError(f"'{csv}' is read and cannot be written at the same time.")
    given = read_answers(answers, key)
    tables = answer_tables(given, interval, confidence)
    if csv is not None:
        with swapped_in(csv) as beside:
            beside.write_text(as_csv(tables), encoding="utf-8")
    people = len({answer.participant for answer in given.given})
    if json:
        print_json({"participants": people, "answers": len(given.given), "unanswered": given.unanswered,
                    "interval": interval, "confidence": confidence, "cells": as_rows(tables)})  # fmt: skip
        return
    if given.unanswered:
        note(f"efase: {given.unanswered} trials have no answer; they do not count.")
    print(as_text(tables))
    print(f"\n{people} participants; under each count the {confidence:.0%} interval of the share ({interval}).")


def _listed(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())
