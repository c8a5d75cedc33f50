"""What the tracking window lets do off the main thread: frozen requests, functions, answers."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path

from app.demo import demo_database
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.tracking.capture import write_capture
from core.tracking.face_model import FaceModel
from core.tracking.track import Track, TrackingRequest, track_video
from core.tracking.video_pictures import VideoFormat, format_of


def open_video(path: Path, _progress: Progress) -> tuple[Path, VideoFormat]:
    """Look at a film."""
    return path, format_of(path)


@dataclass(frozen=True)
class ModelRequest:
    """Whose units, and of which expression; without a database the demo's."""

    database: MotionDatabase | None
    expression: str


def learn_model(request: ModelRequest, progress: Progress) -> FaceModel:
    """Learn points and units."""
    database = demo_database(progress.part(0.0, 0.9)) if request.database is None else request.database
    return FaceModel.of_database(database, request.expression)


@dataclass(frozen=True)
class TrackJob:
    """A film to be tracked, and an earlier track of it that is good up to the first correction, or None."""

    request: TrackingRequest
    earlier: Track | None


def track(job: TrackJob, progress: Progress) -> tuple[Track, float]:
    """Track, and tell how many pictures a second that was."""
    began = time.perf_counter()
    done = track_video(job.request, progress, job.earlier)
    return done, len(done.points) / max(time.perf_counter() - began, 1e-6)


def save_capture(request: tuple[Track, Path], _progress: Progress) -> list[Path]:
    """Write the capture and the sound beside it."""
    return write_capture(*request)
