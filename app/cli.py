"""The command line: one verb a job, each with ``--help``, progress on standard error, ``--json`` on standard output."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from typer.core import TyperGroup

from app.terminal import clear_failures, end_on_signals, show_log
from app.verbs import comparing, databases, importing, live, measuring, motion, pipeline, speech, stimuli, units
from app.verbs.animeme import train
from app.verbs.bench import bench
from app.verbs.growth import db
from app.verbs.iface import train_iface
from app.verbs.own_face import fit_face
from app.verbs.strip import strip
from app.verbs.tracking import track
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
train.command("iface")(train_iface)
app.add_typer(train, name="train")
app.add_typer(db, name="db")
for verb in (motion.demo, databases.build, databases.info, databases.tune, speech.align, motion.synth,
             measuring.evaluate):  # fmt: skip
    app.command()(verb)
app.command("export")(motion.export_project)
app.command("import")(importing.import_captures)
app.command()(comparing.compare)
app.command()(pipeline.lipsync)
app.command()(pipeline.curves)
app.command()(pipeline.poses)
app.command()(units.units)
app.command()(strip)
app.command()(stimuli.stimuli)
app.command("stimuli-table")(stimuli.stimuli_table)
app.command()(live.live)
app.command("fit-face")(fit_face)
app.command()(track)


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
