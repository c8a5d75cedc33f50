"""How the command line shows progress and failure. Standard output belongs to results alone."""

from __future__ import annotations

import contextlib
import json
import logging
import re
import signal
import sys
import traceback
from collections.abc import Callable, Iterable, Iterator
from typing import NoReturn

from core.errors import UserFacingError
from core.folders import cache_dir
from core.progress import Cancelled, Progress

EXIT_USER_ERROR = 2
EXIT_OUR_FAULT = 1
EXIT_CANCELLED = 130
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]+")


class TerminalProgress(Progress):
    """A progress bar on standard error; silent when that is not a terminal."""

    def __init__(self, bar, task) -> None:
        self._bar, self._task = bar, task

    def step(self, fraction: float, message: str = "") -> None:
        """See `Progress.step`."""
        self._bar.update(self._task, completed=min(fraction, 1.0), description=message or None)


@contextlib.contextmanager
def progress_bar(title: str) -> Iterator[Progress]:
    """Show one bar while the block runs."""
    from rich.console import Console
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as RichProgress

    console = Console(stderr=True)
    columns = (TextColumn("{task.description:40.40}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with RichProgress(*columns, console=console, transient=True, disable=not console.is_terminal) as bar:
        yield TerminalProgress(bar, bar.add_task(title, total=1.0))


def note(sentence: str) -> None:
    """Tell the user something on standard error, on one line whatever the files and names in it hold."""
    print(_CONTROL.sub("\N{REPLACEMENT CHARACTER}", sentence), file=sys.stderr)


def warn(sentences: Iterable[str]) -> None:
    """Tell the user what was done otherwise than asked, a line a sentence."""
    for sentence in sentences:
        note(f"efase: {sentence}")


def print_json(answer: dict) -> None:
    """Print the one object of ``--json``."""
    text = json.dumps(answer, ensure_ascii=False, allow_nan=False)
    try:
        text.encode(sys.stdout.encoding)
    except UnicodeEncodeError:  # a terminal without Unicode, or a file name that is none
        text = json.dumps(answer, allow_nan=False)
    print(text)


def tell(answer: dict, in_words: Callable[[dict], str], as_json: bool) -> None:
    """Say what a verb answers, in words or as JSON, and before that its warnings."""
    warn(answer.get("warnings", ()))
    if as_json:
        print_json(answer)
    else:
        print(in_words(answer))


def tell_written(answer: dict, as_json: bool) -> None:
    """The same of a verb that wrote files: their names are all there is to say."""
    tell(answer, lambda answer: "\n".join(answer["outputs"]), as_json)


def end_on_signals() -> None:
    """Let a polite kill and a closed terminal end the work as Ctrl-C does: with nothing half-written left behind."""

    def leave(number: int, _frame: object) -> None:
        sys.exit(128 + number)

    for name in ("SIGTERM", "SIGHUP"):  # Windows has no SIGHUP; under nohup it stays ignored
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, leave)


@contextlib.contextmanager
def clear_failures() -> Iterator[None]:
    """Turn every failure into one sentence and an exit code: 2 for the user to mend, 1 for our own fault."""
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        yield
    except UserFacingError as error:
        note(f"efase: {error}")
        sys.exit(EXIT_USER_ERROR)
    except (Cancelled, KeyboardInterrupt):
        note("efase: cancelled.")
        sys.exit(EXIT_CANCELLED)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(EXIT_OUR_FAULT)
    except MemoryError:
        note("efase: there is not enough memory for this.")
        sys.exit(EXIT_USER_ERROR)
    except OSError as error:
        if error.strerror is None:
            _exit_by_our_fault(error)
        what = f"'{error.filename}' cannot be used" if error.filename else "the system refused"
        note(f"efase: {what}: {error.strerror}.")
        sys.exit(EXIT_USER_ERROR)
    except Exception as error:
        _exit_by_our_fault(error)


def _exit_by_our_fault(error: Exception) -> NoReturn:
    note(f"efase: this should not have happened ({type(error).__name__}); {_written_down()}")
    sys.exit(EXIT_OUR_FAULT)


def _written_down() -> str:
    """Keep the traceback for a report, and say where."""
    path = cache_dir() / "last-failure.txt"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(traceback.format_exc(), encoding="utf-8")
    except OSError:
        return "the details could not be written down."
    return f"the details are in '{path}'."


def show_log(verbose: bool) -> None:
    """Send the workstation's log to standard error; warnings only, unless ``verbose``."""
    logging.basicConfig(stream=sys.stderr, level=logging.INFO if verbose else logging.WARNING,
                        format="%(name)s: %(message)s")  # fmt: skip
