"""`efase bench`: figures, each beside a reference run in the same process."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import AudioDir, Lexicon, Rate, ShapeNames, ShapeSheet
from core.progress import Progress

if TYPE_CHECKING:
    from core.motion.database import MotionDatabase

bench = typer.Typer(help="Measure, each figure beside a reference run in the same process.", rich_markup_mode=None)

Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Database = Annotated[Path | None, typer.Option("--db", help="Motion database; the demo's when absent.")]


@bench.command("search")
def bench_search(
    more: Annotated[list[str] | None, typer.Argument(hidden=True)] = None,
    db: Database = None,
    nodes: Annotated[int | None, typer.Option(min=1, help="Repeat or cut the database to this many nodes.")] = None,
    phonemes: Annotated[list[int] | None, typer.Option(min=1, help="Lengths; the paper's four when absent.")] = None,
    backends: Annotated[list[str] | None, typer.Option(help="Which to measure; all when absent.")] = None,
    repeats: Annotated[int, typer.Option(min=1, help="Times are medians of this many runs.")] = 20,
    json: Json = False,
) -> None:
    """Measure the search: cold, after edits, with prices; beside a reference and the memory's speed."""
    from app import bench

    # several values may follow one option, as in "--phonemes 14 24 --backends opencl glsl"
    lengths = [word for word in more or [] if word.isdecimal() and int(word)]
    phonemes = [*(phonemes or []), *map(int, lengths)]
    backends = [*(backends or []), *(word for word in more or [] if word not in lengths)]
    with progress_bar("bench") as progress:
        database = _open(db, progress)
        answer = bench.bench_search(
            database,
            nodes,
            phonemes or bench.PAPER_LENGTHS,
            backends or bench.BACKENDS,
            repeats,
            progress.part(0.1, 1.0),
        )
    _tell(answer, bench.as_table, json)


@bench.command("growth")
def bench_growth(
    db: Database = None,
    nodes: Annotated[list[int] | None, typer.Option(min=1, help="Sizes; up to 100,000 when absent.")] = None,
    phonemes: Annotated[list[int] | None, typer.Option(min=1, help="Lengths; the paper's four when absent.")] = None,
    limit_s: Annotated[float, typer.Option(min=0.0, help="Longest search; its gap is certified.")] = 60.0,
    pictures: Annotated[Path | None, typer.Option(help="Folder for search-growth.png and search-gap.png.")] = None,
    json: Json = False,
) -> None:
    """Measure how the search grows with database and sentence, and how its certified gap falls with time."""
    from app import growth_bench

    with progress_bar("bench") as progress:
        database = _open(db, progress)
        answer = growth_bench.bench_growth(
            database,
            nodes or growth_bench.SIZES,
            phonemes or growth_bench.PAPER_LENGTHS,
            limit_s,
            progress.part(0.1, 1.0),
        )
    if pictures is not None:
        growth_bench.draw(answer, pictures)
    _tell(answer, growth_bench.as_table, json)


@bench.command("align")
def bench_align(
    corpus: Annotated[Path | None, typer.Argument(help="Folder laid out like GRID; the demo's when absent.")] = None,
    part: Annotated[str, typer.Option(help="train, tune or test.")] = "test",
    json: Json = False,
) -> None:
    """Measure forced alignment against a corpus's own times."""
    from app import alignment_bench

    with progress_bar("bench") as progress:
        answer = alignment_bench.bench_alignment(corpus, part, progress)
    _tell(answer, alignment_bench.as_table, json)


@bench.command("maps")
def bench_maps(
    db: Database = None,
    agreement: Annotated[
        int | None, typer.Option(min=100, help="Compare landmarks and placed frames with the full way on so many.")
    ] = None,
    large: Annotated[int | None, typer.Option(min=1000, help="Make one map of so many frames.")] = None,
    json: Json = False,
) -> None:
    """Measure how well the Isomap and the PCA map of each phoneme keep neighbours; how large maps are made."""
    from app import map_bench

    with progress_bar("bench") as progress:
        database, stage = _open(db, progress), progress.part(0.1, 1.0)
        if agreement is not None:
            answer, table = map_bench.bench_agreement(database, agreement, stage), map_bench.agreement_as_table
        elif large is not None:
            answer, table = map_bench.bench_large(database, large, stage), map_bench.large_in_words
        else:
            answer, table = map_bench.bench_maps(database, stage), map_bench.as_table
    _tell(answer, table, json)


@bench.command("size")
def bench_size(
    database: Annotated[Path, typer.Argument(metavar="DB", help="Where the large database is, or is to be built.")],
    db: Database = None,
    frames: Annotated[int, typer.Option(min=1000, help="Frames; the paper's 135 minutes when absent.")] = 972_000,
    keep: Annotated[bool, typer.Option("--use", help="Only open and use it; it was built before.")] = False,
    json: Json = False,
) -> None:
    """Measure a large database, made of a small one by repetition with variation: building, opening, browsing."""
    from app import size_bench

    with progress_bar("bench") as progress:
        source = None if keep else _open(db, progress)
        answer = size_bench.bench_size(source, frames, database, progress.part(0.1, 1.0))
    _tell(answer, size_bench.as_table, json)


@bench.command("animeme")
def bench_animeme(
    db: Database = None,
    pictures: Annotated[Path | None, typer.Option(help="Folder for plots like the paper's figure 2, SVG.")] = None,
    json: Json = False,
) -> None:
    """Measure animemes beside MMM and Cohen and Massaro's model on sentences held out, and how long training takes."""
    from app import animeme_bench

    with progress_bar("bench") as progress:
        database = _open(db, progress)
        answer = animeme_bench.bench_animemes(database, pictures, progress=progress.part(0.1, 1.0))
    _tell(answer, animeme_bench.as_table, json)


@bench.command("iface")
def bench_iface(
    db: Database = None,
    curves: Annotated[
        list[Path] | None,
        typer.Option("--controls", help="Measure on a studio's curves instead; a file, or a folder of .csv or .npy."),
    ] = None,
    shape_names: ShapeNames = None,
    shape_sheet: ShapeSheet = None,
    rate: Rate = None,
    audio_dir: AudioDir = None,
    lexicon: Lexicon = None,
    variant: Annotated[list[str] | None, typer.Option(help="paper or modern; both when absent.")] = None,
    json: Json = False,
) -> None:
    """Measure faces that hear, trained anew: tables like the paper's, by sentence and by frame; curves by time."""
    from app import iface_bench
    from app.iface_tables import as_table
    from core.animeme.artist_curves import CurveReading
    from core.iface.model_file import VARIANTS

    trainers = iface_bench.trainers(variant or VARIANTS)
    with progress_bar("bench") as progress:
        if curves:
            reading = CurveReading(shape_names, shape_sheet, rate, audio_dir, lexicon)
            answer = iface_bench.bench_curves(curves, reading, trainers, progress)
        else:
            answer = iface_bench.bench_database(_open(db, progress), trainers, progress.part(0.1, 1.0))
    _tell(answer, as_table, json)


@bench.command("suspicion")
def bench_suspicion(db: Database = None, json: Json = False) -> None:
    """Measure how well suspicion finds the demo corpus's planted faults, beside chance and plain distance."""
    from app import suspicion_bench

    with progress_bar("bench") as progress:
        database = _open(db, progress)
        answer = suspicion_bench.bench_suspicion(database, progress.part(0.1, 1.0))
    _tell(answer, suspicion_bench.as_table, json)


@bench.command("mending")
def bench_mending(
    folder: Annotated[Path, typer.Argument(help="Folder laid out like animface-mocap.")], json: Json = False
) -> None:
    """Measure how well gaps, spikes and swaps put into real takes are mended, beside lines and splines."""
    from app import mending_bench

    with progress_bar("bench") as progress:
        answer = mending_bench.bench_mending(folder, progress)
    _tell(answer, mending_bench.as_table, json)


@bench.command("offsets")
def bench_offsets(
    corpus: Annotated[Path | None, typer.Argument(help="Corpus folder; the demo's when absent.")] = None,
    json: Json = False,
) -> None:
    """Measure how well a shift between motion and sound is told."""
    from app import offset_bench
    from app.demo import demo_corpus
    from core.motion.readers.corpus_folder import read_corpus

    with progress_bar("bench") as progress:
        part = progress.part(0.0, 0.2)
        read = demo_corpus(part) if corpus is None else read_corpus(corpus, part)
        answer = offset_bench.bench_offsets(read, progress=progress.part(0.2, 1.0))
    _tell(answer, offset_bench.as_table, json)


@bench.command("track")
def bench_track(
    db: Database = None,
    part: Annotated[str, typer.Option(help="test or tune.")] = "test",
    per_emotion: Annotated[int, typer.Option(min=1, help="Sentences of each emotion.")] = 3,
    condition: Annotated[list[str] | None, typer.Option(help="Which to measure; all when absent.")] = None,
    json: Json = False,
) -> None:
    """Measure the tracker on rendered videos of known motion, beside points that are followed alone."""
    from app import tracking_bench

    with progress_bar("bench") as progress:
        database, stage = _open(db, progress), progress.part(0.1, 1.0)
        conditions = condition or tuple(tracking_bench.CONDITIONS)
        answer = tracking_bench.bench_tracking(database, part, per_emotion, conditions, stage)
    _tell(answer, tracking_bench.as_table, json)


@bench.command("window")
def bench_window(
    db: Database = None,
    actions: Annotated[int, typer.Option(min=1, max=200, help="How many actions of the script.")] = 200,
    json: Json = False,
) -> None:
    """Measure how long the window keeps an animator waiting, in a session of 200 actions, and how soon it starts."""
    from app import window_bench

    with progress_bar("bench") as progress:
        answer = window_bench.bench_window(db, actions, progress)
    _tell(answer, window_bench.as_table, json)


@bench.command("live")
def bench_live(
    db: Database = None,
    seconds: Annotated[float, typer.Option(min=20.0, help="How long to play.")] = 600.0,
    json: Json = False,
) -> None:
    """Measure how late the live face is: a file played through PulseAudio, recorded again and animated; drop-outs."""
    from app import live_bench
    from app.live.opening import open_speaking_face
    from core.actress.corpus import demo_sentences
    from core.media.audio import load_audio

    with progress_bar("bench") as progress:
        _, face = open_speaking_face(db, progress.part(0.0, 0.2))
        spoken = load_audio(demo_sentences()[0].audio)
        answer = live_bench.bench_live(face, spoken, seconds, progress.part(0.2, 1.0))
    _tell(answer, live_bench.as_table, json)


def _open(path: Path | None, progress: Progress) -> MotionDatabase:
    from app.demo import open_named

    return open_named(path, progress.part(0.0, 0.1))


def _tell(answer: dict[str, object], as_table: Callable[[dict[str, object]], str], json: bool) -> None:
    if json:
        print_json(answer)
    else:
        print(as_table(answer))
