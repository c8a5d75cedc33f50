"""Our SQLite files: each edit is one transaction that is on disk when it returns, and nothing foreign is opened.

They have a rollback journal and synchronous FULL: what was confirmed outlives a kill.
"""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from core.errors import UserFacingError

_HEADER = b"SQLite format 3\0"
_WAIT_S = 5.0
# of one value; an hour of sound is about 250 MB
_LARGEST_VALUE_BYTES = 1 << 30
_MAJOR_SHIFT = 16
_REASONS = {
    "SQLITE_FULL": "the disk is full",
    "SQLITE_READONLY": "it is read-only",
    "SQLITE_CANTOPEN": "its folder refuses",
    "SQLITE_BUSY": "another program is writing it",
    "SQLITE_LOCKED": "another program is writing it",
    "SQLITE_IOERR": "the disk reports an error",
    "SQLITE_PERM": "it is not allowed",
    "SQLITE_AUTH": "it is not allowed",
    "SQLITE_TOOBIG": "it is too large",
}


class Damaged(Exception):
    """A file that is ours, but broken; says how, as a clause."""


@dataclass(frozen=True)
class FileKind:
    """One kind of file.

    what : what a user calls it ("eFASE project")
    version : (major, minor) that this workstation writes
    tables : name to SQL that makes it; nothing else may be in the file
    """

    what: str
    application_id: int
    version: tuple[int, int]
    tables: Mapping[str, str]


def create(path: Path, kind: FileKind) -> None:
    """Make an empty file; raises `sqlite3.Error` or `OSError`."""
    with contextlib.closing(_connected(path, "rwc")) as connection, transaction(connection):
        connection.execute(f"PRAGMA application_id = {kind.application_id}")
        set_version(connection, kind.version)
        for sql in kind.tables.values():
            connection.execute(sql)


def connect(path: Path, kind: FileKind, writable: bool = True) -> sqlite3.Connection:
    """Open a file of ``kind``.

    Raises `UserFacingError` when it is missing, of another kind, from a newer major version, or cannot be used;
    `Damaged` when it is broken.
    """
    try:
        with path.open("rb") as file:
            header = file.read(len(_HEADER))
    except FileNotFoundError as error:
        raise UserFacingError(f"There is no {kind.what} at '{path}'.") from error
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    if header != _HEADER:
        raise UserFacingError(f"'{path}' is not an {kind.what}.")
    connection = None
    try:
        connection = _connected(path, "rw" if writable else "ro")
        _check(connection, path, kind)
        return connection
    except sqlite3.DatabaseError as error:
        if connection is not None:
            connection.close()
        if (getattr(error, "sqlite_errorname", None) or "").startswith(
            ("SQLITE_CORRUPT", "SQLITE_NOTADB", "SQLITE_ERROR")
        ):
            raise Damaged(str(error)) from error
        raise refused(path, error, "read") from error
    except BaseException:
        if connection is not None:
            connection.close()
        raise


def _connected(path: Path, mode: str, more: str = "") -> sqlite3.Connection:
    uri = f"{path.absolute().as_uri()}?mode={mode}{more}"
    connection = sqlite3.connect(uri, timeout=_WAIT_S, isolation_level=None, uri=True, check_same_thread=False)
    try:
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, _LARGEST_VALUE_BYTES)
        # a file from elsewhere shall not run code of its own
        connection.execute("PRAGMA trusted_schema = OFF")
        connection.execute("PRAGMA cell_size_check = ON")
        connection.execute("PRAGMA synchronous = FULL")
    except BaseException:
        connection.close()
        raise
    return connection


def connect_damaged(path: Path) -> sqlite3.Connection:
    """Open what is left of a damaged file, as it lies there: nothing is checked, rolled back or locked."""
    return _connected(path, "ro", "&immutable=1")


def _check(connection: sqlite3.Connection, path: Path, kind: FileKind) -> None:
    (application_id,) = connection.execute("PRAGMA application_id").fetchone()
    if application_id != kind.application_id:
        raise UserFacingError(f"'{path}' is an SQLite file, but not an {kind.what}.")
    major, minor = version_of(connection)
    if major > kind.version[0]:
        raise UserFacingError(
            f"'{path}' was made by a newer eFASE (version {major}.{minor} of its format; this one reads up to "
            f"{kind.version[0]}.x).",
            "Update the workstation to open it.",
        )
    names = set()
    for what, name in connection.execute("SELECT type, name FROM sqlite_master"):
        if what != "table" and not (what == "index" and name.startswith("sqlite_autoindex_")):
            raise Damaged(f"it holds a foreign {what}")
        names.add(name)
    if not names.issuperset(kind.tables):
        raise Damaged("a table is missing")
    ((verdict,),) = connection.execute("PRAGMA quick_check(1)").fetchall()
    if verdict != "ok":
        raise Damaged("its pages do not fit together")


def version_of(connection: sqlite3.Connection) -> tuple[int, int]:
    """Return (major, minor)."""
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    return version >> _MAJOR_SHIFT, version & ((1 << _MAJOR_SHIFT) - 1)


def set_version(connection: sqlite3.Connection, version: tuple[int, int]) -> None:
    """Say which version the file has from now on."""
    connection.execute(f"PRAGMA user_version = {(version[0] << _MAJOR_SHIFT) | version[1]}")


@contextlib.contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[None]:
    """Do all of the block or nothing; it is on disk when the block ends."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


def refused(path: Path, error: sqlite3.Error, done: str = "written") -> UserFacingError:
    """Return what to tell the user when SQLite refuses."""
    name = getattr(error, "sqlite_errorname", None) or ""
    reason = next((said for key, said in _REASONS.items() if name.startswith(key)), str(error))
    return UserFacingError(f"'{path}' cannot be {done}: {reason}.")
