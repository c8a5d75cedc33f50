"""Verbs on motion databases: build, info, tune."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from app.terminal import print_json, progress_bar
from app.verbs.options import Database, Json


def build(
    corpus: Annotated[Path, typer.Argument(help="Corpus folder; its layout is described in docs/corpus.md.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Motion database to write (.h5).")],
    dims: Annotated[int, typer.Option(min=2, max=300, help="PCA dimensions.")] = 25,
    held_out: Annotated[
        bool, typer.Option("--hold-out", help="Keep a sixth of the sentences out, to tune and to test on.")
    ] = False,
    split: Annotated[str | None, typer.Option(help="Hold out by sentences, letters or digits.")] = None,
    keep_captures: Annotated[
        bool, typer.Option("--keep-captures", help="Store whole faces too, to fit components anew when it has grown.")
    ] = False,
    json: Json = False,
) -> None:
    """Build a motion database from a corpus folder."""
    from core.evaluation.split import hold_out
    from core.media.swap_in import check_target
    from core.motion.build import BuildSettings, build_database
    from core.motion.readers.corpus_folder import read_corpus

    check_target(output, folders_are_made=True)
    began = time.perf_counter()
    with progress_bar("build") as progress:
        read = read_corpus(corpus, progress.part(0.0, 0.1))
        if held_out or split is not None:
            read = hold_out(read, split or "sentences")
        database = build_database(
            read, output, BuildSettings(n_dims=dims, keep_captures=keep_captures), progress.part(0.1, 1.0)
        )
    summary = {**database.summary(), "seconds_to_build": round(time.perf_counter() - began, 2)}
    if json:
        print_json(summary)
    else:
        print(f"{output}: {_in_words(summary)}, built in {summary['seconds_to_build']:.0f} s")


def info(
    database: Annotated[Path | None, typer.Argument(metavar="[DB]", help="The demo's when absent.")] = None,
    json: Json = False,
) -> None:
    """Say what a motion database holds."""
    from app.demo import open_named
    from core.importing.report import told_by

    with progress_bar("info") as progress:
        summary = open_named(database, progress).summary()
    if json:
        print_json(summary)
        return
    print(f"{summary['name']}{' (synthetic)' if summary['synthetic'] else ''}: {_in_words(summary)}")
    print(f"emotions: {', '.join(f'{n} {e}' for e, n in summary['emotions'].items())}")
    print(f"phonemes: {', '.join(f'{p} {n}' for p, n in summary['phonemes'].items())}")
    print(f"weights: {_tuning_in_words(summary['tuning'])}")
    if imported := told_by(summary["report"]):
        print(imported)
    print(f"content {summary['content_hash'][:16]}")


def tune(
    db: Database = None,
    starts: Annotated[int, typer.Option(min=2, help="Random starts; each pays for 200 sentence-solves.")] = 100,
    seed: Annotated[int, typer.Option(min=0)] = 2008,
    method: Annotated[str, typer.Option(help="evolution, or gradient as in the paper.")] = "evolution",
    objective: Annotated[str, typer.Option(help="all markers (equations 12 and 13), lips, or the lip gap.")] = "all",
    as_printed: Annotated[bool, typer.Option("--as-printed", help="Tune α1 to α6 and PNT of the paper's own.")] = False,
    jobs: Annotated[int, typer.Option(min=-1, help="Processes; -1 is one a core.")] = -1,
    cluster: Annotated[str | None, typer.Option(metavar="tcp://HOST:PORT", help="A Dask scheduler.")] = None,
    limit_s: Annotated[float | None, typer.Option(min=1, help="Stop after so many seconds.")] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="Write the weights to a JSON file too.")] = None,
    forget: Annotated[bool, typer.Option("--forget", help="Give the database its untuned weights back.")] = False,
    json: Json = False,
) -> None:
    """Find the search's weights on the sentences held out to tune; a run that was cut goes on where it was."""
    import math

    from app import tune as tuning
    from core.evaluation.tuning import TuningSettings

    with progress_bar("tune") as progress:
        if forget:
            answer = tuning.forget(db, progress)
        else:
            settings = TuningSettings(method, starts, seed, with_further=not as_printed)
            answer = tuning.run(
                tuning.TuningJob(db, settings, objective, as_printed, jobs or -1, cluster, limit_s or math.inf, output),
                progress,
            )
    if json:
        print_json(answer)
    else:
        print("the weights are untuned" if forget else tuning.in_words(answer))


def _tuning_in_words(tuning: dict) -> str:
    found = tuning.get("search")
    if not found:
        return "untuned"
    return (f"tuned on {found['sentences']} sentences, {found['mean_error']:.3f} mm² a sentence "
            f"(untuned {found['untuned_mean_error']:.3f})")  # fmt: skip


def _in_words(summary: dict) -> str:
    return (
        f"{summary['nodes']} motion nodes in {summary['sentences']} sentences, {summary['frames']} frames at "
        f"{summary['rate_hz']:g} Hz of {summary['markers']} markers, {summary['pca_dims']} dimensions that cover "
        f"{summary['pca_coverage']:.2%}"
    )
