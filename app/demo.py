"""The embedded default: a synthetic actress, her database, and sentences to try."""

from __future__ import annotations

import hashlib
from importlib.resources import files
from pathlib import Path

from core.folders import cache_dir
from core.motion.corpus import Corpus
from core.motion.database import VERSION, MotionDatabase, open_database
from core.progress import SILENT, Progress


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
    """Let the synthetic actress perform her corpus."""
    from core.actress.corpus import CORPUS_NAME, actress_marker_set, recordings

    markers = actress_marker_set()
    return Corpus(CORPUS_NAME, recordings(progress), markers.names, markers.groups, markers.landmarks,
                  rest=markers.rest, synthetic=True)  # fmt: skip


def demo_database(progress: Progress = SILENT) -> MotionDatabase:
    """Open the demo database; the first time, perform the actress's corpus and build it (under a minute)."""
    path = demo_database_path()
    if path.is_file():
        return open_database(path)
    from core.motion.build import build_database

    database = build_database(demo_corpus(progress.part(0.0, 0.3)), path, progress=progress.part(0.3, 1.0))
    for older in path.parent.glob("demo-*.h5"):
        if older != path:
            older.unlink(missing_ok=True)
    return database
