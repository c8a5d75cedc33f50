"""Composing a film in a process of its own: drawing would hold Python's lock and stutter the window."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from app import texts
from app.child_process import run_apart
from app.export import VideoSettings, export
from app.pictures import FaceRig
from core.media.audio import Audio
from core.progress import Progress
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion


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
    return run_apart(_compose, (request,), progress, texts.FILM_PROCESS_DIED)


def _compose(request: FilmRequest, progress: Progress) -> Path:
    progress = _Composing(progress)
    export(request.motion, request.audio, request.rig, request.path, request.settings, progress, request.transcript)
    return request.path


class _Composing(Progress):
    """Says all the while what is done, instead of each of the export's own stages."""

    def __init__(self, whole: Progress) -> None:
        self._whole = whole

    def step(self, fraction: float, message: str = "") -> None:
        self._whole.step(fraction, texts.COMPOSING)
