"""Work in a process of its own: it leaves Python's lock to the window, and a cancel ends it at once."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from core.errors import UserFacingError, WorkstationError
from core.progress import Progress

_ASK_EVERY_S = 0.05
# a film that is composed shall not slow the window that it is composed beside
_POLITENESS = 15


class ChildFailure(WorkstationError):
    """Our own fault in a child process; the text is its traceback."""


def run_apart(work: Callable[..., Any], arguments: tuple, progress: Progress, died: str) -> Any:
    """Return ``work(*arguments, progress)``, done in a new process; a cancel kills it.

    work : a function that a fresh interpreter can import; arguments and answer travel pickled
    died : what to say if the process ends without an answer, as when the system runs out of memory
    A daemonic process, as a worker of a cluster is, may have no children: it does the work itself.
    Raises `UserFacingError` and `OSError` as ``work`` does, `ChildFailure` for any other exception, and whatever
    ``progress.step`` raises, which is called every 50 ms at least.
    """
    if multiprocessing.current_process().daemon:
        return work(*arguments, progress)
    context = multiprocessing.get_context("spawn")
    hears, tells = context.Pipe(duplex=False)
    process = context.Process(target=_work, args=(work, arguments, tells), daemon=True)
    process.start()
    tells.close()
    step = _Step(0.0, "")
    try:
        while True:
            progress.step(step.fraction, step.message)
            if not hears.poll(_ASK_EVERY_S):
                continue
            told = hears.recv()
            if not isinstance(told, _Step):
                return told.result()
            step = told
    except EOFError:
        raise UserFacingError(died) from None
    finally:
        process.kill()
        process.join()
        hears.close()


@dataclass(frozen=True)
class _Step:
    fraction: float
    message: str


@dataclass(frozen=True)
class _Answer:
    answer: Any

    def result(self) -> Any:
        return self.answer


@dataclass(frozen=True)
class _Raised:
    error: Exception

    def result(self) -> Any:
        raise self.error


class _Telling(Progress):
    def __init__(self, tells: Connection) -> None:
        self._tells = tells

    def step(self, fraction: float, message: str = "") -> None:
        self._tells.send(_Step(float(fraction), message))


def _work(work: Callable[..., Any], arguments: tuple, tells: Connection) -> None:
    # Ctrl-C reaches the whole group of processes; the parent is the one to answer it
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(os, "nice"):
        os.nice(_POLITENESS)
    # a parent that was killed hears nothing any more
    with contextlib.suppress(BrokenPipeError):
        tells.send(_outcome(work, arguments, _Telling(tells)))


def _outcome(work: Callable[..., Any], arguments: tuple, progress: Progress) -> _Answer | _Raised:
    try:
        return _Answer(work(*arguments, progress))
    except UserFacingError as error:
        # a subclass may not travel
        return _Raised(UserFacingError(error.message, error.remedy))
    except (OSError, MemoryError) as error:
        return _Raised(error)
    except Exception:
        return _Raised(ChildFailure(traceback.format_exc()))
