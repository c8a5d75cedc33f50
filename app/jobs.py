"""Work that takes time: off the main thread, with progress and cancel, its answer applied on the main thread."""

from __future__ import annotations

import logging
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QObject, QRunnable, Qt, QThreadPool, Signal

from app.texts import UNEXPECTED
from core.errors import UserFacingError
from core.progress import Cancelled, Progress

log = logging.getLogger("jobs")

WORKERS = 3
_TELL_EVERY_S = 0.04

Work = Callable[[Any, Progress], Any]


class _Voice(QObject):
    """Carries a job's words from its worker to the main thread."""

    stepped = Signal(object, float, str)
    ended = Signal(object, object, object)


class _JobProgress(Progress):
    def __init__(self, job: _Job) -> None:
        self._job, self._told_s = job, 0.0

    def step(self, fraction: float, message: str = "") -> None:
        if self._job.cancelled.is_set():
            raise Cancelled
        now_s = time.monotonic()
        if now_s - self._told_s > _TELL_EVERY_S:
            self._told_s = now_s
            self._job.voice.stepped.emit(self._job, fraction, message)


class _Job(QRunnable):
    def __init__(self, kind: str, title: str, request: object, work: Work, voice: _Voice) -> None:
        super().__init__()
        self.setAutoDelete(False)  # Python owns it
        self.kind, self.title, self.voice = kind, title, voice
        self.cancelled = threading.Event()
        self.applied: Callable[[Any], None] | None = None
        self.failed: Callable[[UserFacingError], None] | None = None
        self.discarded: Callable[[Any], None] | None = None
        self._request, self._work = request, work

    def run(self) -> None:
        """Do the work, on a worker."""
        answer, failure = None, None
        try:
            if self.cancelled.is_set():
                raise Cancelled
            answer = self._work(self._request, _JobProgress(self))
        except BaseException as error:  # whatever it is, the main thread has to hear that the job is over
            failure = _Failure.of(error, self.title)
            # what the failed work held (a generator that owns a GL context) must go in the thread that made it
            traceback.clear_frames(error.__traceback__)
        self.voice.ended.emit(self, answer, failure)


@dataclass(frozen=True)
class _Failure:
    """What is left of an exception once it leaves its thread: a sentence and a remedy, or nothing for a cancel."""

    error: UserFacingError | None

    @classmethod
    def of(cls, error: BaseException, title: str) -> _Failure:
        if isinstance(error, Cancelled):
            return cls(None)
        if isinstance(error, UserFacingError):
            return cls(UserFacingError(error.message, error.remedy))
        log.error("%s failed", title or "a job", exc_info=error)
        return cls(UserFacingError(UNEXPECTED.format(what=title.lower(), error=type(error).__name__)))


class JobRunner(QObject):
    """Runs jobs by kind; a new one of a kind retires the old one, whose late answer is ignored.

    started(kind, title), progressed(kind, fraction, message), ended(kind) : for the status bar
    failed(sentence, remedy) : for the message bar, when the job brought no handler of its own
    """

    started = Signal(str, str)
    progressed = Signal(str, float, str)
    ended = Signal(str)
    failed = Signal(str, str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._pool = QThreadPool(self)
        self._pool.setMaxThreadCount(WORKERS)
        self._voice = _Voice()
        self._voice.stepped.connect(self._on_stepped, Qt.ConnectionType.QueuedConnection)
        self._voice.ended.connect(self._on_ended, Qt.ConnectionType.QueuedConnection)
        self._current: dict[str, _Job] = {}
        self._alive: set[_Job] = set()
        self._closed = False

    def start(
        self,
        kind: str,
        title: str,
        request: object,
        work: Work,
        applied: Callable[[Any], None],
        failed: Callable[[UserFacingError], None] | None = None,
        discarded: Callable[[Any], None] | None = None,
    ) -> None:
        """Run ``work(request, progress)`` and hand what it returns to ``applied``, here on the main thread.

        request : frozen; holds all that the work needs
        failed : takes a `UserFacingError` instead of the message bar
        discarded : takes a late answer that nobody wants any more, to free what it holds
        """
        if self._closed:
            return
        self.cancel(kind)
        job = _Job(kind, title, request, work, self._voice)
        job.applied, job.failed, job.discarded = applied, failed, discarded
        self._current[kind] = job
        self._alive.add(job)
        self.started.emit(kind, title)
        self._pool.start(job)

    def cancel(self, kind: str) -> None:
        """Retire the job of ``kind``, if there is one."""
        job = self._current.pop(kind, None)
        if job is not None:
            job.cancelled.set()
            self.ended.emit(kind)

    def is_running(self, kind: str) -> bool:
        """Whether an answer of ``kind`` is still to come."""
        return kind in self._current

    @property
    def is_idle(self) -> bool:
        """Whether no answer is to come."""
        return not self._current

    def shut_down(self) -> None:
        """Cancel everything and wait for the workers; nothing starts any more."""
        self._closed = True
        for kind in list(self._current):
            self.cancel(kind)
        self._pool.waitForDone()

    def _on_stepped(self, job: _Job, fraction: float, message: str) -> None:
        if self._current.get(job.kind) is job:
            self.progressed.emit(job.kind, fraction, message)

    def _on_ended(self, job: _Job, answer: object, failure: _Failure | None) -> None:
        self._alive.discard(job)
        if self._current.get(job.kind) is not job:
            if failure is None and job.discarded is not None:
                job.discarded(answer)
            return
        del self._current[job.kind]
        self.ended.emit(job.kind)
        if failure is None:
            job.applied(answer)
        elif failure.error is not None and job.failed is not None:
            job.failed(failure.error)
        elif failure.error is not None:
            self.failed.emit(failure.error.message, failure.error.remedy)
