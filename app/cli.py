"""The command line: one verb a job, each with ``--help``, progress on standard error, ``--json`` on standard output."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer
from typer.core import TyperGroup

from app.cli_bench import bench
from app.terminal import clear_failures, end_on_signals, note, print_json, progress_bar, show_log
from core.errors import UserFacingError


class _OpensFiles(TyperGroup):
    """Takes ``efase PROJECT.efase`` (or a sound file) for ``efase open PROJECT.efase``."""

    def resolve_command(self, ctx, args):
        """See `click.Group.resolve_command`."""
        if args and args[0] not in self.commands and (Path(args[0]).suffix.lower() == ".efase" or _is_file(args[0])):
            args = ["open", *args]
        return super().resolve_command(ctx, args)


def _is_file(text: str) -> bool:
    try:
        return Path(text).is_file()
    except (OSError, ValueError):  # too long for a name, or holding a zero
        return False


app = typer.Typer(
    cls=_OpensFiles, name="efase", help="Author expressive speech animation from captured facial motion.",
    add_completion=False,
    pretty_exceptions_enable=False, rich_markup_mode=None, context_settings={"help_option_names": ["-h", "--help"]},
)  # fmt: skip

app.add_typer(bench, name="bench")

OUTPUTS = ".avi, .mp4, .png (numbered), .c3d, .csv or .TextGrid; repeat for more."
Background = Annotated[str | None, typer.Option(help="Colour behind the face, #rrggbb.")]
Span = Annotated[str | None, typer.Option("--range", metavar="START-END", help="Only this part, in seconds.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object and nothing else.")]
Database = Annotated[Path | None, typer.Option("--db", help="Motion database; the demo's when absent.")]
Lexicon = Annotated[Path | None, typer.Option(help="Pronunciations of names and coined words, `word phone phone …`.")]
Strict = Annotated[bool, typer.Option(help="Refuse phones that are not in the set, instead of taking the nearest.")]


def main() -> None:
    """Entry point of the ``efase`` command."""
    with clear_failures():
        app(standalone_mode=True)


@app.callback(invoke_without_command=True)
def window(
    context: typer.Context,
    verbose: Annotated[bool, typer.Option("--verbose", help="Show the workstation's log.")] = False,
) -> None:
    """Open the workstation when no verb is given."""
    show_log(verbose)
    if context.invoked_subcommand is None:
        from app.main import run_window

        raise typer.Exit(run_window())
    if context.invoked_subcommand != "open":  # a window ends by itself
        end_on_signals()


@app.command("open", hidden=True)
def open_file(file: Annotated[Path, typer.Argument(help="A project (.efase), or a sound file.")]) -> None:
    """Open the workstation with a project; `efase PROJECT.efase` does the same."""
    from app.main import run_window

    if not file.is_file():
        raise UserFacingError(f"There is no file '{file}'.")
    raise typer.Exit(run_window(file))


@app.command()
def demo(
    out: Annotated[Path, typer.Option(help="Folder for the pictures and films.")] = Path("out"),
    json: Json = False,
) -> None:
    """Synthesise the demo sentences in four emotions and draw the window, without a display."""
    from app.headless import write_demo

    with progress_bar("demo") as progress:
        written = write_demo(out, progress)
    if json:
        print_json(written)
    else:
        for path in written["outputs"]:
            print(path)
        for sentence in written["notes"]:
            note(sentence)


@app.command()
def build(
    corpus: Annotated[Path, typer.Argument(help="Corpus folder; its layout is described in docs/corpus.md.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Motion database to write (.h5).")],
    dims: Annotated[int, typer.Option(min=2, max=300, help="PCA dimensions.")] = 25,
    held_out: Annotated[
        bool, typer.Option("--hold-out", help="Keep a sixth of the sentences out, to tune and to test on.")
    ] = False,
    split: Annotated[str | None, typer.Option(help="Hold out by sentences, letters or digits.")] = None,
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
        database = build_database(read, output, BuildSettings(n_dims=dims), progress.part(0.1, 1.0))
    summary = {**database.summary(), "seconds_to_build": round(time.perf_counter() - began, 2)}
    if json:
        print_json(summary)
    else:
        print(f"{output}: {_in_words(summary)}, built in {summary['seconds_to_build']:.0f} s")


@app.command()
def info(
    database: Annotated[Path | None, typer.Argument(metavar="[DB]", help="The demo's when absent.")] = None,
    json: Json = False,
) -> None:
    """Say what a motion database holds."""
    from app.demo import open_named

    with progress_bar("info") as progress:
        summary = open_named(database, progress).summary()
    if json:
        print_json(summary)
        return
    print(f"{summary['name']}{' (synthetic)' if summary['synthetic'] else ''}: {_in_words(summary)}")
    print(f"emotions: {', '.join(f'{n} {e}' for e, n in summary['emotions'].items())}")
    print(f"phonemes: {', '.join(f'{p} {n}' for p, n in summary['phonemes'].items())}")
    print(f"weights: {_tuning_in_words(summary['tuning'])}")
    print(f"content {summary['content_hash'][:16]}")


@app.command()
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


@app.command()
def align(
    audio: Annotated[Path, typer.Argument(help="WAV, FLAC or OGG.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Praat TextGrid to write.")],
    text: Annotated[str | None, typer.Option(help="What is said, or a text file; recognised when absent.")] = None,
    lexicon: Lexicon = None,
    json: Json = False,
) -> None:
    """Find when each word and phone is said."""
    from app.speech import load_speech
    from core.media.swap_in import check_target
    from core.speech.textgrid import write_textgrid

    if output.suffix.lower() != ".textgrid":
        raise UserFacingError(f"'{output}' is not a name for a TextGrid.", "Let it end in .TextGrid.")
    check_target(output)
    with progress_bar("align") as progress:
        speech = load_speech(audio, text, lexicon=lexicon, progress=progress)
    write_textgrid(speech.transcript, output)
    _warn(speech.transcript.warnings)
    if json:
        print_json(
            {
                "text": speech.text, "recognised": speech.recognised, "duration_s": speech.transcript.duration_s,
                "words": [[w.word, w.start_s, w.end_s] for w in speech.transcript.words],
                "phonemes": _phonemes(speech.transcript), "warnings": list(speech.transcript.warnings),
                "outputs": [str(output)],
            }
        )  # fmt: skip
    else:
        print(output)


@app.command()
def synth(
    audio: Annotated[Path, typer.Argument(help="WAV, FLAC or OGG.")],
    output: Annotated[list[Path], typer.Option("--output", "-o", help=OUTPUTS)],
    text: Annotated[str | None, typer.Option(help="What is said, or a text file with it.")] = None,
    phones: Annotated[Path | None, typer.Option(help="TextGrid, label or `start end phone` file instead.")] = None,
    db: Database = None,
    emotion: Annotated[str | None, typer.Option(help="neutral, happiness, anger or sadness.")] = None,
    emotions: Annotated[Path | None, typer.Option(help="Text lines `start end emotion [intensity]`.")] = None,
    engine: Annotated[str, typer.Option(help="search, search-single (one path) or search-paper (printed).")] = "search",
    face: Annotated[str, typer.Option(help="default, ben, rosa, otto, pip, or a mesh: OBJ, PLY, glTF.")] = "default",
    markers: Annotated[Path | None, typer.Option(help="CSV `marker,vertex` for a face of your own.")] = None,
    backend: Annotated[str, typer.Option(help="auto, numpy, opencl or glsl.")] = "auto",
    pin: Annotated[list[str] | None, typer.Option(metavar="SLOT=NODE", help="Tie a motion node to a slot.")] = None,
    weights: Annotated[str, typer.Option(help="tuned (the database's), default (untuned), or a JSON file.")] = "tuned",
    fps: Annotated[str, typer.Option(help="24, 25, 29.97, 30 or 60.")] = "30",
    start_frame: Annotated[int, typer.Option(min=0, help="Number of the first frame (timecode).")] = 0,
    size: Annotated[str, typer.Option(help="Picture size.")] = "640x480",
    style: Annotated[str, typer.Option(help="face, shaded (without texture), wireframe or markers.")] = "face",
    texture: Annotated[Path | None, typer.Option(help="PNG or JPEG for a mesh with texture coordinates.")] = None,
    head: Annotated[bool, typer.Option("--head/--no-head", help="Let the head move, subtly.")] = True,
    gaze: Annotated[bool, typer.Option("--gaze/--no-gaze", help="Let the eyes wander.")] = True,
    background: Background = None,
    span: Span = None,
    lexicon: Lexicon = None,
    strict: Strict = False,
    json: Json = False,
) -> None:
    """Animate speech: find the best path through the database and write films or markers."""
    from app.export import VideoSettings, background_colour, frame_rate, span_of_time, video_size
    from app.synthesis import SynthesisJob, run

    job = SynthesisJob(
        audio=audio, outputs=tuple(output), text=text, phones=phones, database=db, emotion=emotion, emotions=emotions,
        engine=engine, face=face, marker_file=markers, backend=backend, pins=tuple(pin or ()),
        weights=weights,
        video=VideoSettings(frame_rate(fps), *video_size(size), style, start_frame, head, gaze, texture,
                            None if background is None else background_colour(background),
                            None if span is None else span_of_time(span)),
        lexicon=lexicon, strict=strict,
    )  # fmt: skip
    with progress_bar("synth") as progress:
        answer = run(job, progress)
    _tell_written(answer, json)


@app.command()
def evaluate(
    db: Database = None,
    corpus: Annotated[Path | None, typer.Option(help="Measure on this corpus folder instead.")] = None,
    split: Annotated[str, typer.Option(help="test, tune or all.")] = "test",
    engine: Annotated[list[str] | None, typer.Option(help="Repeat for more; all when absent.")] = None,
    report: Annotated[Path | None, typer.Option(help="Folder for the page, its figures and the JSON.")] = None,
    json: Json = False,
) -> None:
    """Measure engines on captured sentences that the database does not hold."""
    from app.evaluate import PAGE, EvaluationJob, as_table, run

    with progress_bar("evaluate") as progress:
        answer = run(EvaluationJob(db, corpus, split, tuple(engine or ()), report), progress)
    if json:
        print_json(answer)
    else:
        print(as_table(answer))
        if report is not None:
            print(report / PAGE)


@app.command("export")
def export_project(
    project: Annotated[Path, typer.Argument(help="A project (.efase).")],
    output: Annotated[list[Path], typer.Option("--output", "-o", help=OUTPUTS)],
    db: Annotated[Path | None, typer.Option("--db", help="Motion database, instead of the project's own.")] = None,
    size: Annotated[str, typer.Option(help="Picture size.")] = "800x600",
    style: Annotated[str | None, typer.Option(help="face, shaded, wireframe or markers.")] = None,
    background: Background = None,
    span: Span = None,
    json: Json = False,
) -> None:
    """Write films or markers of a project, with the same motion as in the window."""
    from app.export import background_colour, span_of_time, video_size
    from app.project_export import ExportJob, run

    job = ExportJob(project, tuple(output), db, video_size(size), style,
                    None if background is None else background_colour(background),
                    None if span is None else span_of_time(span))  # fmt: skip
    with progress_bar("export") as progress:
        answer = run(job, progress)
    _tell_written(answer, json)


def _tell_written(answer: dict, json: bool) -> None:
    _warn(answer["warnings"])
    if json:
        print_json(answer)
    else:
        for path in answer["outputs"]:
            print(path)


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


def _phonemes(transcript) -> list[dict]:
    return [{"phone": u.phone, "start_s": u.start_s, "end_s": u.end_s} for u in transcript.phonemes]


def _warn(sentences) -> None:
    for sentence in sentences:
        note(f"efase: {sentence}")
