"""Pictures of a video as the playhead asks for them: read off the main thread, the last wish first."""

from __future__ import annotations

import threading
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QImage

from app.jobs import JobRunner
from core.errors import UserFacingError
from core.media.video_reader import VideoReader
from core.progress import Progress


class _Reel:
    """A video that is opened when its first picture is wanted, and closed for good by `close`."""

    def __init__(self, path: Path) -> None:
        self._path, self._reader, self._lock, self._closed = path, None, threading.Lock(), False

    def picture_at(self, time_s: float) -> QImage | None:
        """Return the picture at a time, or None once closed."""
        with self._lock:
            if self._closed:
                return None
            if self._reader is None:
                self._reader = VideoReader(self._path)
            picture = self._reader.frame_at(time_s)
        height, width, _ = picture.shape
        return QImage(picture.data, width, height, 3 * width, QImage.Format.Format_RGB888).copy()

    def close(self) -> None:
        """Let go of the file; waits while a picture is read."""
        with self._lock:
            self._closed = True
            if self._reader is not None:
                self._reader.close()
                self._reader = None


class VideoFrames(QObject):
    """Shows one video at the times that are asked for; while one picture is read, only the last wish is kept.

    arrived(QImage) : the picture at the time that was asked for last, or a little before it
    failed(sentence) : the video cannot be read
    """

    arrived = Signal(QImage)
    failed = Signal(str)

    def __init__(self, jobs: JobRunner, kind: str, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs, self._kind = jobs, kind
        self._reel: _Reel | None = None
        self._wanted_s: float | None = None
        self._reading = False

    def set_video(self, path: Path | None) -> None:
        """Show another video from now on, or none."""
        self._jobs.cancel(self._kind)
        if self._reel is not None:
            self._reel.close()
        self._reel = None if path is None else _Reel(path)
        self._wanted_s, self._reading = None, False

    def ask(self, time_s: float) -> None:
        """Ask for the picture at a time of the video, seconds."""
        self._wanted_s = time_s
        self._next()

    def _next(self) -> None:
        if self._reading or self._reel is None or self._wanted_s is None:
            return
        request, self._wanted_s, self._reading = (self._reel, self._wanted_s), None, True
        self._jobs.start(self._kind, "", request, _read, self._on_read, self._on_failed)

    def _on_read(self, picture: QImage | None) -> None:
        self._reading = False
        if picture is not None:
            self.arrived.emit(picture)
        self._next()

    def _on_failed(self, error: UserFacingError) -> None:
        self._reading = False
        self.failed.emit(str(error))


def _read(request: tuple[_Reel, float], _progress: Progress) -> QImage | None:
    reel, time_s = request
    return reel.picture_at(time_s)
