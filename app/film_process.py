"""Composing a film in a process of its own: drawing would hold Python's lock and stutter the window."""

from __future__ import annotations

import multiprocessing
import os
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path

from app import texts
from app.export import VideoSettings, export
from app.pictures import FaceRig
from core.errors import UserFacingError
from core.media.audio import Audio
from core.progress import Progress
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion

_ASK_EVERY_S = 0.05
_POLITENESS = 5


@dataclass(frozen=True)
class FilmRequest:
    """All that a film needs; without a rig, markers are drawn; the transcript moves the tongue, and head and gaze."""

    motion: MarkerMotion
    audio: Audio
    transcript: Transcript
    rig: FaceRig | None
    settings: VideoSettings
    path: Path


def compose_apart(request: FilmRequest, progress: Progress) -> Path:
    """Compose the film and return its path; a cancel kills the process. Raises what `app.export.export` raises."""
    context = multiprocessing.get_context("spawn")
    hears, tells = context.Pipe(duplex=False)
    process = context.Process(target=_compose, args=(request, tells), daemon=True)
    process.start()
    tells.close()
    fraction = 0.0
    try:
        while True:
            progress.step(fraction, texts.COMPOSING)
            if not hears.poll(_ASK_EVERY_S):
                continue
            told = hears.recv()
            if isinstance(told, float):
                fraction = told
            elif told is None:
                return request.path
            else:
                raise UserFacingError(*told)
    except EOFError:
        raise UserFacingError(texts.FILM_PROCESS_DIED) from None
    finally:
        process.kill()
        process.join()
        hears.close()


class _Telling(Progress):
    def __init__(self, tells: Connection) -> None:
        self._tells = tells

    def step(self, fraction: float, message: str = "") -> None:
        self._tells.send(float(fraction))


def _compose(request: FilmRequest, tells: Connection) -> None:
    if hasattr(os, "nice"):
        os.nice(_POLITENESS)
    try:
        export(
            request.motion, request.audio, request.rig, request.path, request.settings, _Telling(tells),
            request.transcript,
        )  # fmt: skip
        tells.send(None)
    except UserFacingError as error:
        tells.send((error.message, error.remedy))
