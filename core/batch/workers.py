"""Where the pieces of a batch are worked on: in this process, on all cores, or on a Dask cluster."""

from __future__ import annotations

import collections
import contextlib
import os
from collections.abc import Callable, Iterable, Iterator

from core.errors import UserFacingError

_CONNECT_S = 10
# Takes calls (function, arguments), yields their answers as they come.
Workers = Callable[[Iterable[tuple[Callable, tuple]]], Iterator]


def here(calls: Iterable[tuple[Callable, tuple]]) -> Iterator:
    """Work in this process, one call after the other."""
    for work, arguments in calls:
        yield work(*arguments)


def cores(n_jobs: int = -1) -> Workers:
    """Workers of this machine: ``n_jobs`` processes, -1 is one a core; this process alone for one.

    Left half way, or stopped by a call that raises, the calls already begun end in peace and no other begins: killing
    them would race with joblib's own thread.
    """
    n_jobs = (os.cpu_count() or 1) if n_jobs < 0 else n_jobs

    def work(calls: Iterable[tuple[Callable, tuple]]) -> Iterator:
        from joblib import Parallel, delayed

        calls = list(calls)
        if n_jobs == 1 or len(calls) < 2:
            yield from here(calls)
            return
        is_left = False
        jobs = (delayed(_answer_or_error)(*call) for call in calls if not is_left)
        answers = Parallel(n_jobs=n_jobs, return_as="generator_unordered", batch_size=1, pre_dispatch=n_jobs + 1)(jobs)
        try:
            for answer, error in answers:
                if error is not None:
                    raise error
                yield answer
        finally:
            is_left = True
            collections.deque(answers, maxlen=0)

    return work


def _answer_or_error(function: Callable, arguments: tuple) -> tuple:
    try:
        return function(*arguments), None
    except Exception as error:
        return None, error


@contextlib.contextmanager
def dask_client(address: str, work: str) -> Iterator:
    """Connect to the Dask scheduler at ``address`` (``tcp://host:port``); ``work`` begins the sentence of a refusal.

    Raises `UserFacingError` when `distributed` is not installed or no scheduler answers.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise UserFacingError(
            f"{work} on a cluster needs the package 'distributed'.", "Install it with `pip install distributed`."
        ) from error
    try:
        client = Client(address, timeout=_CONNECT_S, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        raise UserFacingError(
            f"No Dask scheduler answers at '{address}'.",
            "Start one with `dask scheduler`, and workers with `dask worker`.",
        ) from error
    with client:
        yield client


@contextlib.contextmanager
def workers_at(address: str | None, n_jobs: int, work: str) -> Iterator[Workers]:
    """Workers of a Dask cluster at ``address``, or of this machine without one.

    All machines of a cluster see the same folders, for files are named, not sent. A worker that dies takes nothing
    along: its calls go to others.
    """
    if address is None:
        yield cores(n_jobs)
        return
    with dask_client(address, work) as client:

        def there(calls: Iterable[tuple[Callable, tuple]]) -> Iterator:
            from distributed import as_completed

            futures = [client.submit(function, *arguments, pure=False, retries=3) for function, arguments in calls]
            for future in as_completed(futures, loop=client.loop):
                yield future.result()

        yield there
