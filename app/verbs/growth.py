"""`efase db`: a motion database that grows and shrinks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import Json

if TYPE_CHECKING:
    from core.motion.growth import GrowthReport

db = typer.Typer(
    help="Add, remove and merge sentences of a motion database; names of motion nodes, pins and removals survive.",
    rich_markup_mode=None,
)
Target = Annotated[Path, typer.Argument(metavar="DB", help="Motion database (.h5).")]
Refit = Annotated[bool, typer.Option("--refit", help="Fit the principal components anew to all sentences.")]
Remake = Annotated[
    bool, typer.Option("--remake-maps", help="Make changed maps anew; otherwise no frame on them moves.")
]
Prefix = Annotated[str, typer.Option(help="Put before the sentence names of a database that is added.")]
_SUFFIXES = (".h5", ".hdf5")


@db.command("add")
def add(
    database: Target,
    source: Annotated[Path, typer.Argument(help="Corpus folder, or another database of the same actor.")],
    refit: Refit = False,
    remake_maps: Remake = False,
    prefix: Prefix = "",
    json: Json = False,
) -> None:
    """Add the sentences of a corpus folder or of another database."""
    from core.motion.growth import GrowthSettings, add_corpus, add_database
    from core.motion.readers.corpus_folder import read_corpus

    settings = GrowthSettings(refit, remake_maps)
    with progress_bar("add") as progress:
        if source.suffix.lower() in _SUFFIXES:
            report = add_database(database, source, settings, prefix, progress)
        else:
            corpus = read_corpus(source, progress.part(0.0, 0.2))
            report = add_corpus(database, corpus, settings, progress.part(0.2, 1.0))
    _tell(report, json)


@db.command("remove")
def remove(
    database: Target,
    sentences: Annotated[list[str], typer.Argument(help="Names of sentences, as `efase db list` shows them.")],
    refit: Refit = False,
    remake_maps: Remake = False,
    json: Json = False,
) -> None:
    """Take sentences out."""
    from core.motion.growth import GrowthSettings, remove_sentences

    with progress_bar("remove") as progress:
        report = remove_sentences(database, sentences, GrowthSettings(refit, remake_maps), progress)
    _tell(report, json)


@db.command("merge")
def merge(
    first: Annotated[Path, typer.Argument(metavar="A", help="Motion database; its components and maps are kept.")],
    second: Annotated[Path, typer.Argument(metavar="B", help="Another one of the same actor.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Motion database to write (.h5).")],
    refit: Refit = False,
    remake_maps: Remake = False,
    prefix: Prefix = "",
    json: Json = False,
) -> None:
    """Write one database with the sentences of two, and their curation lists joined."""
    from core.media.swap_in import check_target
    from core.motion import growth

    check_target(output)
    with progress_bar("merge") as progress:
        settings = growth.GrowthSettings(refit, remake_maps)
        report = growth.merge(first, second, output, settings, prefix, progress)
    _tell(report, json)


@db.command("compact")
def compact(
    database: Target,
    drop_removed: Annotated[
        bool, typer.Option("--drop-removed", help="Take motion nodes that were removed in the window out for good.")
    ] = False,
    drop_captures: Annotated[
        bool, typer.Option("--drop-captures", help="Forget what `efase build --keep-captures` kept.")
    ] = False,
    json: Json = False,
) -> None:
    """Write a database anew without what is not used."""
    from core.motion import growth

    with progress_bar("compact") as progress:
        report = growth.compact(database, drop_removed, drop_captures, progress)
    _tell(report, json)


@db.command("list")
def list_sentences(database: Target, json: Json = False) -> None:
    """List the sentences of a database, a line each."""
    from core.motion.database import open_database

    opened = open_database(database)
    held_out = {name: split for split, names in opened.held_out.items() for name in names}
    rows = [{"name": s.name, "emotion": s.emotion, "seconds": round(s.transcript.duration_s, 3), "text": s.text}
            for s in opened.sentences]  # fmt: skip
    if json:
        print_json({"sentences": rows, "held_out": held_out})
        return
    for row in rows:
        print(f"{row['name']}  {row['seconds']:.2f} s  {row['emotion']}  {row['text']}")
    for name, split in held_out.items():
        print(f"{name}  held out ({split})")


def _tell(report: GrowthReport, json: bool) -> None:
    answer = report.as_dict()
    if json:
        print_json(answer)
        return
    done = [f"{len(names)} {what}" for what, names in (("added", report.added), ("removed", report.removed)) if names]
    if report.nodes_dropped:
        done.append(f"{len(report.nodes_dropped)} motion nodes dropped")
    print(f"{answer['path']}: {', '.join(done) or 'nothing changed'}; {answer['nodes']} motion nodes in "
          f"{answer['sentences']} sentences now, {answer['frames']} frames, in {answer['seconds']:.1f} s")  # fmt: skip
    if report.coverage is not None:
        print(f"the database's components cover {report.coverage:.2%} of the new frames' variance "
              f"and miss {report.residual_mm:.3f} mm of them")  # fmt: skip
    print(f"maps: {len(report.maps_kept)} kept, {len(report.maps_grown)} with frames placed on them, "
          f"{len(report.maps_made)} made")  # fmt: skip
