"""A project on disk: one SQLite file in which each edit is one transaction (its form: `project_tables`)."""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Self

from core import sqlite_file
from core.document.content import ProjectContent
from core.document.content_checks import Unbelievable
from core.document.project_lock import ProjectLock
from core.document.project_tables import (
    KIND,
    LONGEST_CONTENT,
    SOUNDS,
    beyond_repair,
    drop_unused_sounds,
    is_torn,
    newest,
    newest_revision,
    read_sound,
    sound_tables,
    write_state,
)
from core.document.salvage import mend, salvaged
from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.swap_in import swapped_in
from core.sqlite_file import Damaged, transaction

SUFFIX = ".efase"
_LONGEST_VERSION_NAME = 200


class ReadOnlyProject(UserFacingError):
    """A project that can be read, but not written."""


@dataclass(frozen=True)
class NamedVersion:
    """A state of the project that was given a name; ``made`` is UTC as ISO 8601 writes it."""

    name: str
    made: str


class ProjectFile:
    """An open project, locked against other windows; `save` returns when the state is on disk.

    content : as it was saved last
    said : sentences for the user about what had to be mended
    """

    def __init__(self, path: Path, lock: ProjectLock, connection: sqlite3.Connection, said: tuple[str, ...]) -> None:
        self.path = path
        self._lock, self._connection = lock, connection
        self._revision, self.content = newest(connection, path)
        self._text = self.content.to_json()
        self._sounds = sound_tables(connection)
        self.said = said

    @classmethod
    def create(cls, path: Path) -> Self:
        """Make an empty project at ``path``, in place of what is there; raises `UserFacingError` when it cannot be."""
        lock = ProjectLock(path)
        try:
            with _told(path), swapped_in(path) as beside:
                _make(beside, ProjectContent())
            return cls(path, lock, sqlite_file.connect(path, KIND), ())
        except BaseException:
            lock.release()
            raise

    @classmethod
    def open(cls, path: Path) -> Self:
        """Open a project, mending what can be mended.

        Raises `core.document.project_lock.ProjectLocked`, `ReadOnlyProject`, or `UserFacingError` when it is missing,
        foreign, newer than this workstation, or damaged beyond repair.
        """
        lock = ProjectLock(path)
        try:
            with _told(path):
                connection, said = _opened(path)
            try:
                said += _made_writable(connection, path)
                return cls(path, lock, connection, said)
            except BaseException:
                connection.close()
                raise
        except BaseException:
            lock.release()
            raise

    def close(self) -> None:
        """Let go of the file; sounds that nothing refers to any more are dropped."""
        with contextlib.suppress(sqlite3.Error), transaction(self._connection):
            drop_unused_sounds(self._connection)
        self._connection.close()
        self._lock.release()

    # Saving

    def save(self, content: ProjectContent, audio: Audio | None = None) -> None:
        """Write ``content`` in one transaction; its sound, if the file does not have it yet, goes before in another.

        Raises `UserFacingError` when it cannot be written (a full disk), or when another machine wrote the file.
        """
        text = content.to_json()
        if text == self._text:
            return
        sound = content.sound
        with _told(self.path):
            if sound is not None and sound.digest not in self._sounds:
                in_use = self.content.sound
                table = SOUNDS[(SOUNDS.index(self._sounds[in_use.digest]) + 1) % len(SOUNDS)] if in_use else SOUNDS[0]
                with transaction(self._connection):
                    row = (sound.digest, audio.kept)
                    self._connection.execute(f"INSERT INTO {table} VALUES (?, ?)", row)
                self._sounds[sound.digest] = table
            with transaction(self._connection):
                if newest_revision(self._connection) != self._revision:
                    raise UserFacingError(
                        f"'{self.path}' was changed by another window.", "Save a copy of what is open here."
                    )
                write_state(self._connection, self._revision + 1, text)
        self._revision += 1
        self._text, self.content = text, content

    def audio(self, content: ProjectContent) -> Audio | None:
        """Return the sound that ``content`` refers to; raises `UserFacingError` when it is damaged."""
        return read_sound(self._connection, content, self.path)

    def copy_to(self, path: Path) -> None:
        """Write a whole copy; raises `UserFacingError` when it cannot be written."""
        if path.exists() and path.samefile(self.path):
            raise UserFacingError(f"'{path}' is the open project itself.", "Choose another name for the copy.")
        lock = ProjectLock(path)
        try:
            with _told(path), swapped_in(path) as beside, contextlib.closing(sqlite3.connect(beside)) as target:
                self._connection.backup(target)
        finally:
            lock.release()

    # Named versions

    def versions(self) -> list[NamedVersion]:
        """Return the named versions, oldest first."""
        with _told(self.path):
            rows = self._connection.execute("SELECT name, made FROM version ORDER BY made, name").fetchall()
        return [NamedVersion(str(name), str(made)) for name, made in rows]

    def save_version(self, name: str) -> None:
        """Give the state as it is now a name, in place of what had it; raises `UserFacingError` for no name."""
        name = name.strip()[:_LONGEST_VERSION_NAME]
        if not name:
            raise UserFacingError("A version needs a name.")
        made = datetime.now(UTC).isoformat(timespec="microseconds")
        with _told(self.path), transaction(self._connection):
            self._connection.execute("INSERT OR REPLACE INTO version VALUES (?, ?, ?)", (name, made, self._text))

    def version(self, name: str) -> ProjectContent:
        """Return what the project was in a named version; raises `UserFacingError` when there is none."""
        with _told(self.path):
            row = self._connection.execute(
                "SELECT content FROM version WHERE name = ? AND length(content) < ?", (name, LONGEST_CONTENT)
            ).fetchone()
        if row is None:
            raise UserFacingError(f"'{self.path.name}' has no version “{name}”.")
        try:
            return ProjectContent.from_json(row[0])
        except Unbelievable as error:
            raise UserFacingError(f"The version “{name}” of '{self.path.name}' is damaged ({error}).") from error

    def forget_version(self, name: str) -> None:
        """Drop a named version."""
        with _told(self.path), transaction(self._connection):
            self._connection.execute("DELETE FROM version WHERE name = ?", (name,))


def read_project(path: Path) -> tuple[ProjectContent, Audio | None]:
    """Return what a project holds and its sound, without opening it for work; raises as `ProjectFile.open` does."""
    with _told(path, "read"):
        try:
            connection = sqlite_file.connect(path, KIND, writable=False)
        except Damaged:
            with salvaged(path) as mended, contextlib.closing(sqlite_file.connect(mended, KIND)) as connection:
                content = newest(connection, path)[1]
                return content, read_sound(connection, content, path)
        with contextlib.closing(connection):
            content = newest(connection, path)[1]
            return content, read_sound(connection, content, path)


def _opened(path: Path) -> tuple[sqlite3.Connection, tuple[str, ...]]:
    try:
        connection = sqlite_file.connect(path, KIND)
        if not is_torn(connection):
            return connection, ()
        connection.close()
    except Damaged:
        pass
    kept = mend(path)
    said = (
        f"'{path.name}' was damaged, as by copying it while it was written; what it holds was put in order, and the "
        f"damaged file is kept as '{kept.name}'."
    )
    return sqlite_file.connect(path, KIND), (said,)


def _made_writable(connection: sqlite3.Connection, path: Path) -> tuple[str, ...]:
    """Write a little, to know that it can be; a file of an older minor version becomes one of ours."""
    before = sqlite_file.version_of(connection)
    try:
        with transaction(connection):
            sqlite_file.set_version(connection, max(before, KIND.version))
            drop_unused_sounds(connection)
    except sqlite3.Error as error:
        refusal = sqlite_file.refused(path, error)
        raise ReadOnlyProject(refusal.message, refusal.remedy) from error
    if before < KIND.version:
        return (f"'{path.name}' was made by an older eFASE and was brought up to date.",)
    if before > KIND.version:
        return (f"'{path.name}' was made by a newer eFASE; what this one does not know is kept, and not shown.",)
    return ()


def _make(path: Path, content: ProjectContent) -> None:
    sqlite_file.create(path, KIND)
    with contextlib.closing(sqlite_file.connect(path, KIND)) as connection, transaction(connection):
        write_state(connection, 1, content.to_json())


@contextlib.contextmanager
def _told(path: Path, done: str = "written") -> Iterator[None]:
    try:
        yield
    except sqlite3.Error as error:
        raise sqlite_file.refused(path, error, done) from error
    except Damaged as error:
        raise beyond_repair(path, error) from error
