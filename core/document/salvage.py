"""Whatever is whole in a damaged project, put into a new file."""

from __future__ import annotations

import contextlib
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from pathlib import Path

from core import sqlite_file
from core.document.project_tables import KIND, SOUNDS, beyond_repair, has_sound, sound_digest, whole_states, write_state
from core.media.swap_in import swapped_in
from core.sqlite_file import transaction

_PAGE_SIZE_AT, _N_PAGES_AT = slice(16, 18), slice(28, 32)
_LARGEST_PADDING = 1 << 30


@contextlib.contextmanager
def salvaged(path: Path) -> Iterator[Path]:
    """Give a file, for as long as the block runs, with what is whole in ``path``; `UserFacingError` if nothing is."""
    with tempfile.TemporaryDirectory(prefix="efase-mending-") as folder:
        broken, mended = Path(folder) / "broken", Path(folder) / "mended"
        shutil.copyfile(path, broken)
        _pad(broken)
        sqlite_file.create(mended, KIND)
        try:
            with (
                contextlib.closing(sqlite_file.connect_damaged(broken)) as source,
                contextlib.closing(sqlite_file.connect(mended, KIND)) as target,
                transaction(target),
            ):
                if not _carry_over(source, target):
                    raise beyond_repair(path, "no state of it is whole")
        except sqlite3.Error as error:
            raise beyond_repair(path, error) from error
        yield mended


def mend(path: Path) -> Path:
    """Put what is whole in ``path`` in its place; return where the damaged file is kept."""
    kept = path.with_name(f"{path.stem}.damaged{path.suffix}")
    with salvaged(path) as mended:
        with swapped_in(kept) as beside:
            shutil.copyfile(path, beside)
        with swapped_in(path) as beside:
            shutil.copyfile(mended, beside)
    return kept


def _pad(path: Path) -> None:
    """Let the file be as long as its header says; SQLite reads nothing of one that lost its end."""
    with path.open("r+b") as file:
        header = file.read(100)
        page_size = int.from_bytes(header[_PAGE_SIZE_AT], "big")
        page_size = 65536 if page_size == 1 else page_size
        n_bytes = page_size * int.from_bytes(header[_N_PAGES_AT], "big")
        if path.stat().st_size < n_bytes < _LARGEST_PADDING:
            file.truncate(n_bytes)


def _carry_over(source: sqlite3.Connection, target: sqlite3.Connection) -> bool:
    """Copy sounds, versions and the newest state whose sound is whole; tell whether there was one.

    An older state without any sound is no substitute for one whose sound is lost.
    """
    for table, n_columns in (*((name, 2) for name in SOUNDS), ("version", 3)):
        with contextlib.suppress(sqlite3.DatabaseError):
            marks = ", ".join("?" * n_columns)
            for row in source.execute(f"SELECT * FROM {table} NOT INDEXED"):
                target.execute(f"INSERT OR IGNORE INTO {table} VALUES ({marks})", row)
    for i, (revision, text) in enumerate(whole_states(source)):
        if has_sound(target, text) and (i == 0 or sound_digest(text) is not None):
            write_state(target, revision, text)
            return True
    return False
