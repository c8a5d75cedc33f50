"""Which motion nodes of a database are removed, by whom, when and why: a list of the database's own.

It lies beside the database and is shared by all projects and windows that use it; the database itself never changes.
"""

from __future__ import annotations

import contextlib
import getpass
import os
import re
import sqlite3
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from core import sqlite_file
from core.errors import UserFacingError
from core.folders import cache_dir, data_dir
from core.motion.database import MotionDatabase
from core.sqlite_file import Damaged, FileKind

SUFFIX = ".curation"
LONGEST_TEXT = 1000
_MOST_REMOVALS = 1_000_000
_KIND = FileKind(
    what="eFASE curation list", application_id=0x65464355, version=(1, 0),
    tables={
        "removal": """CREATE TABLE IF NOT EXISTS removal (node TEXT PRIMARY KEY, who TEXT NOT NULL,
                      at TEXT NOT NULL, why TEXT NOT NULL) WITHOUT ROWID""",
        "history": """CREATE TABLE IF NOT EXISTS history (id INTEGER PRIMARY KEY, node TEXT NOT NULL,
                      done TEXT NOT NULL, who TEXT NOT NULL, at TEXT NOT NULL, why TEXT NOT NULL)""",
    },
)  # fmt: skip


@dataclass(frozen=True)
class Removal:
    """Why a motion node is not used; ``at`` is UTC as ISO 8601 writes it."""

    who: str
    at: str
    why: str

    @classmethod
    def now(cls, why: str) -> Removal:
        """Return a removal by the user of this machine, now."""
        try:
            who = getpass.getuser()
        except (OSError, KeyError, ImportError):
            who = "someone"
        return cls(who[:LONGEST_TEXT], datetime.now(UTC).isoformat(timespec="seconds"), why[:LONGEST_TEXT])


def curation_path(database: MotionDatabase) -> Path:
    """Return where the list of ``database`` is kept: beside it.

    The demo's lies in the cache, where it is made anew when it has to be (and one made in memory lies nowhere): such a
    list lies in the data folder, by the database's name.
    """
    if database.path is None or (path := Path(database.path)).parent.absolute() == cache_dir().absolute():
        return data_dir() / "curation" / f"{re.sub('[^0-9A-Za-z]+', '-', database.name)[:80]}{SUFFIX}"
    return path.with_name(path.name + SUFFIX)


class CurationList:
    """The list on disk. Nothing is held between calls, so that each sees what other windows wrote."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @classmethod
    def of(cls, database: MotionDatabase) -> CurationList:
        """Return the list of ``database``."""
        return cls(curation_path(database))

    def read(self) -> dict[str, Removal]:
        """Return the removed nodes by public name; nothing was removed while there is no file.

        Raises `UserFacingError` when the file is broken, foreign, from a newer version or cannot be read.
        """
        if not self._exists:
            return {}
        try:
            with contextlib.closing(sqlite_file.connect(self.path, _KIND, writable=self.can_be_written)) as connection:
                rows = connection.execute(
                    "SELECT node, who, at, why FROM removal LIMIT ?", (_MOST_REMOVALS,)
                ).fetchall()
        except sqlite3.Error as error:
            raise sqlite_file.refused(self.path, error, "read") from error
        except Damaged as error:
            raise self._damaged(error) from error
        if not all(isinstance(text, str) for row in rows for text in row):
            raise self._damaged("a name is no text")
        return {node: Removal(*(text[:LONGEST_TEXT] for text in about)) for node, *about in rows}

    def change(self, removed: Mapping[str, Removal], restored: Iterable[str] = ()) -> dict[str, Removal]:
        """Remove and restore nodes in one transaction; return the list as it is then.

        Raises `UserFacingError` when it cannot be written, as in a read-only folder; nothing is changed then.
        """
        try:
            if not self._exists:
                self.path.parent.mkdir(parents=True, exist_ok=True)
                sqlite_file.create(self.path, _KIND)
            with contextlib.closing(sqlite_file.connect(self.path, _KIND)) as connection:
                self._write(connection, removed, restored)
        except sqlite3.Error as error:
            raise self._refused(sqlite_file.refused(self.path, error).message) from error
        except OSError as error:
            raise self._refused(f"'{self.path}' cannot be written: {error.strerror or error}.") from error
        except Damaged as error:
            raise self._damaged(error) from error
        return self.read()

    def _write(self, connection: sqlite3.Connection, removed: Mapping[str, Removal], restored: Iterable[str]) -> None:
        with sqlite_file.transaction(connection):
            for node, removal in removed.items():
                about = (removal.who, removal.at, removal.why)
                connection.execute("INSERT OR REPLACE INTO removal VALUES (?, ?, ?, ?)", (node, *about))
                connection.execute("INSERT INTO history VALUES (NULL, ?, 'removed', ?, ?, ?)", (node, *about))
            for node in restored:
                now = Removal.now("")
                connection.execute("DELETE FROM removal WHERE node = ?", (node,))
                connection.execute(
                    "INSERT INTO history VALUES (NULL, ?, 'restored', ?, ?, '')", (node, now.who, now.at)
                )

    @property
    def _exists(self) -> bool:
        # one of no bytes was about to be made when its window ended
        return self.path.exists() and self.path.stat().st_size > 0

    @property
    def can_be_written(self) -> bool:
        """Whether `change` has a chance: the file and its folder are not read-only."""
        folder = self.path.parent
        while not folder.exists() and folder != folder.parent:
            folder = folder.parent
        return os.access(folder, os.W_OK) and (not self._exists or os.access(self.path, os.W_OK))

    def _refused(self, message: str) -> UserFacingError:
        return UserFacingError(
            message, "What you remove is removed for this project only, until the folder can be written."
        )

    def _damaged(self, error: object) -> UserFacingError:
        return UserFacingError(
            f"The curation list '{self.path}' is damaged ({error}).", "Move it away to start a new one."
        )
