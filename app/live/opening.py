"""Opens what a live session needs: a motion database and the face that was trained on it."""

from __future__ import annotations

from pathlib import Path

from core.iface.speaking import SpeakingFace
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress


def open_speaking_face(path: Path | None, progress: Progress = SILENT) -> tuple[MotionDatabase, SpeakingFace]:
    """Open a motion database (None: the demo's) and the face that it teaches; raises `UserFacingError`."""
    from app.demo import open_named

    database = open_named(path, progress.part(0.0, 0.2))
    return database, speaking_face(database, progress.part(0.2, 1.0))


def speaking_face(database: MotionDatabase, progress: Progress = SILENT) -> SpeakingFace:
    """Return the default model of a database, which is trained the first time; a job.

    Raises `UserFacingError` when nothing can be learned from it.
    """
    from core.iface.default_model import default_model

    return default_model(database, progress)
