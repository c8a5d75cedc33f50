"""Keeps the database's curation list on disk and in the document the same, whichever window changes it."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, Qt, Signal

from app import texts
from core.document.change import Change
from core.document.document import EMPTY, Document
from core.errors import UserFacingError
from core.motion.curation import CurationList, Removal
from core.motion.database_lock import DatabaseLock, DatabaseLocked


@dataclass(frozen=True)
class _Written:
    """How the write of that number ended: what the list at ``path`` holds then, and why it was refused, if it was."""

    path: Path
    number: int
    on_disk: Mapping[str, Removal]
    stamp: tuple[int, int] | None
    error: UserFacingError | None


class _Voice(QObject):
    """Carries how a write ended to the main thread."""

    written = Signal(object)


class Curating(QObject):
    """Writes what an edit removes or restores, and reads what other windows did.

    The first window on a database holds its lock and writes; the others read, until it is closed. A thread writes, one
    edit after the other, so that no edit waits for the disk.

    failed(sentence, remedy) : the list cannot be written or read; noted(sentence) : another window writes it
    """

    failed = Signal(str, str)
    noted = Signal(str)

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._on_disk: Mapping[str, Removal] = EMPTY
        self._stamp: tuple[int, int] | None = None
        self._lock: DatabaseLock | None = None
        self._thread: ThreadPoolExecutor | None = None
        self._newest: Future[_Written] | None = None
        self._n_writes = 0
        self._voice = _Voice()
        self._voice.written.connect(self._on_written, Qt.ConnectionType.QueuedConnection)
        document.changed.connect(self._on_document_changed)

    @property
    def can_be_written(self) -> bool:
        """Whether a removal can be shared with other projects."""
        curation = self._list
        return curation is not None and curation.can_be_written and (self._lock is not None or self._is_unstored)

    def wait(self) -> None:
        """Return when all that was removed or restored so far is written or refused, and on its way to be told."""
        if self._thread is not None:
            self._thread.submit(int).result()  # the thread tells of a write before it goes on to this

    def close(self) -> None:
        """Let another window write the list, once all is written."""
        if self._thread is not None:
            self._thread.shutdown(wait=True)
            self._thread = None
        if self._lock is not None:
            self._lock.release()
            self._lock = None

    def refresh(self) -> None:
        """Take what another window wrote, if it did; write from now on, if the window that did is closed."""
        curation = self._list
        if curation is not None and self._lock is None:
            with contextlib.suppress(UserFacingError):
                self._hold()
        is_writing = self._newest is not None and not self._newest.done()
        if curation is None or is_writing or _stamp_of(curation.path) == self._stamp:
            return
        try:
            self._take(curation.read())
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
        self._stamp = _stamp_of(curation.path)

    @property
    def _list(self) -> CurationList | None:
        database = self._document.database
        return None if database is None else CurationList.of(database)

    @property
    def _is_unstored(self) -> bool:
        database = self._document.database
        return database is not None and database.path is None

    def _hold(self) -> None:
        database = self._document.database
        if database is not None and database.path is not None:
            self._lock = DatabaseLock(database.path)

    def _on_document_changed(self, change: Change, origin: object) -> None:
        if change & Change.NODES:  # another database, with what its list held when it was opened
            self._on_disk, self._stamp = self._document.shared_removals, None
            self.close()
            try:
                self._hold()
            except DatabaseLocked:
                self.noted.emit(texts.DATABASE_OPEN_ELSEWHERE)
            except UserFacingError:
                pass  # its folder cannot be written, which is said when something is removed
            self.refresh()
        elif change & Change.CURATION and origin is not self:
            self._write()

    def _write(self) -> None:
        wanted, curation = self._document.shared_removals, self._list
        removed = {node: removal for node, removal in wanted.items() if self._on_disk.get(node) != removal}
        restored = [node for node in self._on_disk if node not in wanted]
        if curation is None or not (removed or restored):
            return
        self._on_disk = dict(wanted)
        self._n_writes += 1
        self._thread = self._thread or ThreadPoolExecutor(1, "curation")
        self._newest = self._thread.submit(_change, curation, self._n_writes, removed, restored)
        self._newest.add_done_callback(self._tell)

    def _tell(self, done: Future[_Written]) -> None:
        self._voice.written.emit(done.result())

    def _on_written(self, written: _Written) -> None:
        if written.error is not None:
            self.failed.emit(written.error.message, written.error.remedy)
        # what later edits ask for is on its way, and must not be taken back meanwhile
        if written.number == self._n_writes and self._list is not None and self._list.path == written.path:
            self._stamp = written.stamp
            if written.error is None:
                self._take(written.on_disk)
            else:
                self._on_disk = written.on_disk

    def _take(self, on_disk: Mapping[str, Removal]) -> None:
        self._on_disk = dict(on_disk)
        self._document.read_curation(on_disk, origin=self)


def _change(curation: CurationList, number: int, removed: Mapping[str, Removal], restored: list[str]) -> _Written:
    """Write, on the thread; the next edit tries again what was refused."""
    try:
        on_disk = curation.change(removed, restored)
        return _Written(curation.path, number, on_disk, _stamp_of(curation.path), None)
    except UserFacingError as error:
        refused = UserFacingError(error.message, error.remedy)
    try:
        on_disk = curation.read()
    except UserFacingError:
        on_disk = EMPTY
    return _Written(curation.path, number, on_disk, _stamp_of(curation.path), refused)


def _stamp_of(path: Path) -> tuple[int, int] | None:
    try:
        about = path.stat()
    except OSError:
        return None
    return about.st_mtime_ns, about.st_size
