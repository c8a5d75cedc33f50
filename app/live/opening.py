"""Opens what a live session needs: a motion database and the face that was trained on it."""

from __future__ import annotations

from pathlib import Path

from core.iface.speaking import SpeakingFace
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress


def open_speaking_face(path: Path | None, progress: Progress = SILENT) -> tuple[MotionDatabase, SpeakingFace]:
    """Open a motion database (None: the demo's) and its default model, which is trained the first time.

    Raises `UserFacingError` when the database cannot be opened, or nothing can be learned from it.
    """
    from app.demo import open_named
    from core.iface.default_model import default_model

    database = open_named(path, progress.part(0.0, 0.2))
    return database, default_model(database, progress.part(0.2, 1.0))
