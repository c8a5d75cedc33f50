"""What lies in a project file: the state, kept four times over, the sounds, and the versions.

The states are in tables of their own that are written in turn, each with its revision and a digest. So a file that is
copied in the very moment of an edit (SQLite's locks mean nothing to a copying program) holds one table that is torn,
and three that are whole: the newest of those is the project after its last edit but one. A new sound likewise goes
into another table than the sound in use.
"""

from __future__ import annotations

import contextlib
import hashlib
import sqlite3
from pathlib import Path

from core.document.content import ProjectContent
from core.document.content_checks import Unbelievable
from core.errors import UserFacingError
from core.media.audio import Audio, audio_from_kept
from core.sqlite_file import FileKind

_STATES = tuple(f"state{i}" for i in range(4))
SOUNDS = tuple(f"sound{i}" for i in range(4))
LONGEST_CONTENT = 1 << 28
KIND = FileKind(
    what="eFASE project", application_id=0x65464153, version=(1, 0),
    tables={
        **{name: f"CREATE TABLE {name} (revision INTEGER, digest TEXT, content TEXT)" for name in _STATES},
        # no index: it would be shared by all sounds of the table, and there are few
        **{name: f"CREATE TABLE {name} (digest TEXT NOT NULL, data BLOB NOT NULL)" for name in SOUNDS},
        "version": "CREATE TABLE version (name TEXT PRIMARY KEY, made TEXT NOT NULL, content TEXT NOT NULL)",
    },
)  # fmt: skip


def _digest(revision: int, text: str) -> str:
    return hashlib.sha256(f"{revision}\n{text}".encode()).hexdigest()


def write_state(connection: sqlite3.Connection, revision: int, text: str) -> None:
    """Write a state in place of the one that is four revisions older."""
    table = _STATES[revision % len(_STATES)]
    connection.execute(f"DELETE FROM {table}")
    connection.execute(f"INSERT INTO {table} VALUES (?, ?, ?)", (revision, _digest(revision, text), text))


def newest_revision(connection: sqlite3.Connection) -> int:
    """Return the number of the newest state, whole or not."""
    tables = " UNION ALL ".join(f"SELECT revision FROM {table}" for table in _STATES)
    return connection.execute(f"SELECT max(revision) FROM ({tables})").fetchone()[0]


def whole_states(connection: sqlite3.Connection) -> list[tuple[int, str]]:
    """Return (revision, content) of the states that are as they were written, newest first."""
    found = []
    for table in _STATES:
        # a torn table may be unreadable
        with contextlib.suppress(sqlite3.DatabaseError):
            sql = f"SELECT revision, digest, content FROM {table} WHERE length(content) < ? LIMIT 2"
            for revision, digest, text in connection.execute(sql, (LONGEST_CONTENT,)).fetchall():
                if type(revision) is int and isinstance(text, str) and digest == _digest(revision, text):
                    found.append((revision, text))
    return sorted(found, reverse=True)


def sound_digest(text: str) -> str | None:
    """Return which sound a state refers to; none for a state that nobody would believe."""
    try:
        sound = ProjectContent.from_json(text).sound
    except Unbelievable:
        return None
    return None if sound is None else sound.digest


def has_sound(connection: sqlite3.Connection, text: str) -> bool:
    """Whether the sound that a state refers to, if it does, is there and whole."""
    digest = sound_digest(text)
    try:
        return digest is None or _sound_bytes(connection, digest) is not None
    except sqlite3.DatabaseError:
        return False


def _sound_bytes(connection: sqlite3.Connection, digest: str) -> bytes | None:
    """Return what is kept of a sound; None when it is not there or not whole."""
    for table in SOUNDS:
        for (data,) in connection.execute(f"SELECT data FROM {table} WHERE digest = ?", (digest,)).fetchall():
            if isinstance(data, bytes) and hashlib.sha256(data).hexdigest() == digest:
                return data
    return None


def sound_tables(connection: sqlite3.Connection) -> dict[str, str]:
    """Return the table that each sound lies in, by its digest."""
    return {digest: table for table in SOUNDS for (digest,) in connection.execute(f"SELECT digest FROM {table}")}


def is_torn(connection: sqlite3.Connection) -> bool:
    """Whether some state is not as it was written."""
    try:
        n_rows = sum(connection.execute(f"SELECT count(*) FROM {table}").fetchone()[0] for table in _STATES)
        states = whole_states(connection)
        return n_rows != len(states) or not all(has_sound(connection, text) for _, text in states[:1])
    except sqlite3.DatabaseError:
        return True


def newest(connection: sqlite3.Connection, path: Path) -> tuple[int, ProjectContent]:
    """Return number and content of the newest state that is whole; raises `UserFacingError` when there is none."""
    why = "it holds no state"
    for revision, text in whole_states(connection):
        try:
            return revision, ProjectContent.from_json(text)
        except Unbelievable as error:
            why = str(error)
    raise beyond_repair(path, why)


def beyond_repair(path: Path, why: object) -> UserFacingError:
    """Return what to tell the user of a file from which nothing can be had."""
    return UserFacingError(f"The project '{path}' is damaged ({why}).", "Open a copy of it, or begin a new one.")


def read_sound(connection: sqlite3.Connection, content: ProjectContent, path: Path) -> Audio | None:
    """Return the sound that ``content`` refers to; raises `UserFacingError` when it is damaged."""
    if content.sound is None:
        return None
    data = _sound_bytes(connection, content.sound.digest)
    if data is None:
        raise beyond_repair(path, "its sound is not what it was")
    was = content.sound.path
    return audio_from_kept(data, f"the sound of '{path.name}'", None if was is None else Path(was))


def drop_unused_sounds(connection: sqlite3.Connection) -> None:
    """Drop sounds that neither the newest state nor a version names. Undo does not reach beyond an open window."""
    states = whole_states(connection)
    texts = [states[0][1]] if states else []
    texts += [text for (text,) in connection.execute("SELECT content FROM version")]
    for digest, table in sound_tables(connection).items():
        if states and not any(digest in text for text in texts):
            connection.execute(f"DELETE FROM {table} WHERE digest = ?", (digest,))
