"""Keeps the database's curation list on disk and in the document the same, whichever window changes it."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app import texts
from core.document.change import Change
from core.document.document import EMPTY, Document
from core.errors import UserFacingError
from core.motion.curation import CurationList, Removal
from core.motion.database_lock import DatabaseLock, DatabaseLocked


class Curating(QObject):
    """Writes what an edit removes or restores, and reads what other windows did.

    The first window on a database holds its lock and writes; the others read, until it is closed.

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
        document.changed.connect(self._on_document_changed)

    @property
    def can_be_written(self) -> bool:
        """Whether a removal can be shared with other projects."""
        curation = self._list
        return curation is not None and curation.can_be_written and (self._lock is not None or self._is_unstored)

    def close(self) -> None:
        """Let another window write the list."""
        if self._lock is not None:
            self._lock.release()
            self._lock = None

    def refresh(self) -> None:
        """Take what another window wrote, if it did; write from now on, if the window that did is closed."""
        curation = self._list
        if curation is not None and self._lock is None:
            with contextlib.suppress(UserFacingError):
                self._hold()
        if curation is None or _stamp_of(curation.path) == self._stamp:
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
        try:
            on_disk = curation.change(removed, restored)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self._stamp = _stamp_of(curation.path)
        self._take(on_disk)

    def _take(self, on_disk: Mapping[str, Removal]) -> None:
        self._on_disk = dict(on_disk)
        self._document.read_curation(on_disk, origin=self)


def _stamp_of(path: Path) -> tuple[int, int] | None:
    try:
        about = path.stat()
    except OSError:
        return None
    return about.st_mtime_ns, about.st_size
