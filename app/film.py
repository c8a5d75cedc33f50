"""The composed film of the motion on show, made in the background and kept until the motion changes."""

from __future__ import annotations

import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from app import texts
from app.export import VideoSettings
from app.film_process import FilmRequest, compose_apart
from app.jobs import JobRunner
from app.pictures import FaceRig
from core.document.document import Document
from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.media.video import FRAME_RATES
from core.progress import Progress

_SIZE_PX = (800, 600)
_COMPOSE_AFTER_MS = 400
# longer films are made when they are asked for: drawing takes about as long as the speech
_LONGEST_UNASKED_S = 60.0


class FilmComposer(QObject):
    """Composes whenever the motion, the face or the frame rate changed and all is quiet.

    changed() : see `path`, the film on disk, or None while there is none
    failed(sentence) : why there is none
    saved(path) : a copy was made
    """

    changed = Signal()
    failed = Signal(str)
    saved = Signal(str)

    def __init__(self, document: Document, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.path: Path | None = None
        self.fps_name = "30"
        self._document, self._jobs = document, jobs
        self._rig: FaceRig | None = None
        self._head_moves = True
        self._folder = tempfile.TemporaryDirectory(prefix="efase-films-", ignore_cleanup_errors=True)
        self._n_films = 0
        self._made_of: FilmRequest | None = None
        self._soon = QTimer(self, singleShot=True, interval=_COMPOSE_AFTER_MS)
        self._soon.timeout.connect(self._compose_unasked)

    @property
    def fps(self) -> float:
        """Output frames a second."""
        return float(FRAME_RATES[self.fps_name])

    def set_frame_rate(self, name: str) -> None:
        """Choose the output rate, one of `core.media.video.FRAME_RATES`."""
        if name != self.fps_name:
            self.fps_name = name
            self.renew()

    def set_rig(self, rig: FaceRig | None) -> None:
        """Draw another face, or markers."""
        self._rig = rig
        self.renew()

    def set_head_moves(self, moves: bool) -> None:
        """Let head and gaze move by themselves, or keep them still."""
        self._head_moves = moves
        self.renew()

    def renew(self) -> None:
        """Drop a film that no longer shows what is asked for, and compose soon; the same is not made again."""
        wanted = self._request()
        is_there = self.path is not None or self._jobs.is_running("film")
        if is_there and wanted is not None and _shows(self._made_of, wanted):
            return
        self._jobs.cancel("film")
        if self.path is not None:
            self.path.unlink(missing_ok=True)
            self.path = None
            self.changed.emit()
        if self._document.answer is not None:
            self._soon.start()

    def compose(self) -> None:
        """Compose the film of the motion on show, if there is none yet."""
        request = self._request()
        if request is None or self.path is not None or self._jobs.is_running("film"):
            return
        if self._jobs.is_running("face") or self._jobs.is_running("search"):
            self._soon.start()
            return
        self._n_films += 1
        self._made_of = replace(request, path=Path(self._folder.name) / f"synthesis-{self._n_films}.avi")
        self._jobs.start("film", texts.COMPOSING, self._made_of, compose_apart, self._on_composed, self._on_failed)

    def _request(self) -> FilmRequest | None:
        """What the film on show is to be made of, without a path; None while there is no motion."""
        document = self._document
        speech = document.speech
        if document.answer is None or speech is None:
            return None
        style = "face" if self._rig is not None else "markers"
        settings = VideoSettings(
            FRAME_RATES[self.fps_name], *_SIZE_PX, style, head=self._head_moves, gaze=self._head_moves
        )
        return FilmRequest(document.motion, speech.audio, speech.transcript, self._rig, settings, Path())

    def _compose_unasked(self) -> None:
        speech = self._document.speech
        if speech is not None and speech.transcript.duration_s <= _LONGEST_UNASKED_S:
            self.compose()

    def save(self, path: Path) -> None:
        """Copy the film to ``path``."""
        if self.path is not None:
            request = (self.path, path)
            self._jobs.start("save", texts.SAVING_FILM, request, _copy, lambda _: self.saved.emit(str(path)))

    def shut_down(self) -> None:
        """Remove the films."""
        self._soon.stop()
        self._folder.cleanup()

    def _on_composed(self, path: Path) -> None:
        self.path = path
        self.changed.emit()

    def _on_failed(self, error: UserFacingError) -> None:
        self.failed.emit(str(error))


def _copy(request: tuple[Path, Path], _progress: Progress) -> None:
    source, target = request
    with swapped_in(target) as beside:
        shutil.copyfile(source, beside)


def _shows(made_of: FilmRequest, wanted: FilmRequest) -> bool:
    """Whether a film of one request is, frame for frame, that of the other."""
    one, other = made_of.motion, wanted.motion
    same_moves = one.rate_hz == other.rate_hz and one.markers is other.markers
    return (
        same_moves and made_of.audio is wanted.audio and made_of.transcript == wanted.transcript
        and made_of.rig is wanted.rig and made_of.settings == wanted.settings
        and np.array_equal(one.positions, other.positions)
    )  # fmt: skip
