"""The embedded default: a synthetic actress, her database, and sentences to try."""

from __future__ import annotations

import contextlib
import hashlib
import logging
from importlib.resources import files
from pathlib import Path

from core.errors import UserFacingError
from core.folders import cache_dir
from core.media.swap_in import check_target
from core.motion.corpus import Corpus
from core.motion.database import VERSION, MotionDatabase, open_database
from core.motion.stored_weights import store_tuned
from core.progress import SILENT, Progress
from core.search.weight_files import read_weights

# Versions of the workstation that are used side by side shall not throw out each other's database.
_KEPT = 3
# made by `efase tune --output resources/demo/weights.json`
_WEIGHTS = Path(str(files("resources").joinpath("demo"))) / "weights.json"
log = logging.getLogger("database")


def demo_database_path() -> Path:
    """Return where the demo database is cached; the name changes with what it is made from."""
    digest = hashlib.sha256(repr(VERSION).encode())
    for folder in ("core/actress", "core/motion", "core/manifold", "resources/demo", "resources/markers"):
        root = files(folder.split("/")[0]).joinpath(*folder.split("/")[1:])
        for path in sorted(Path(str(root)).rglob("*")):
            if path.is_file() and path.suffix not in (".pyc", ".ogg", ".flac"):
                digest.update(path.name.encode() + path.read_bytes())
    return cache_dir() / f"demo-{digest.hexdigest()[:12]}.h5"


def demo_corpus(progress: Progress = SILENT) -> Corpus:
    """Let the synthetic actress perform her corpus, and the sentences that are held out to tune and to compare on."""
    from core.actress import corpus as actress

    markers = actress.actress_marker_set()
    held_out = {"tune": actress.tuning_sentences(), "test": actress.comparison_sentences()}
    names = {split: tuple(spoken.sentence for spoken in sentences) for split, sentences in held_out.items()}
    apart = [actress.record(spoken) for split in held_out.values() for spoken in split]
    return Corpus(actress.CORPUS_NAME, actress.recordings(progress) + apart, markers.names, markers.groups,
                  markers.landmarks, rest=markers.rest, synthetic=True, held_out=names)  # fmt: skip


def demo_database(progress: Progress = SILENT) -> MotionDatabase:
    """Open the demo database; the first time, perform the actress's corpus and build it (under a minute).

    A damaged one is made again. Raises `UserFacingError` when the cache folder cannot be written.
    """
    path = demo_database_path()
    if path.is_file():
        try:
            return open_database(path)
        except UserFacingError as error:
            log.warning("%s It is made again.", error.message)
    from core.motion.build import build_database

    try:
        check_target(path, folders_are_made=True)
    except UserFacingError as error:
        raise UserFacingError(
            f"The demo database cannot be kept in '{path.parent}'.",
            "Let EFASE_CACHE_DIR name a folder that can be written, or name a database.",
        ) from error
    database = build_database(demo_corpus(progress.part(0.0, 0.3)), path, progress=progress.part(0.3, 1.0))
    if _WEIGHTS.is_file():
        database = store_tuned(database, read_weights(_WEIGHTS)[1])
    with contextlib.suppress(OSError):  # on Windows one may be open in another workstation
        for older in sorted(path.parent.glob("demo-*.h5"), key=lambda p: p.stat().st_mtime)[:-_KEPT]:
            older.unlink(missing_ok=True)
    return database


def open_named(path: Path | None, progress: Progress = SILENT) -> MotionDatabase:
    """Open a motion database; None means the demo's."""
    return demo_database(progress) if path is None else open_database(path)
