"""What the compare window does in the background. Functions for `app.jobs`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from app.comparison_words import title_of
from app.texts import compare as texts
from core.document.live_engine import LiveEngine
from core.errors import UserFacingError
from core.evaluation.course_table import write_course_table
from core.evaluation.known_capture import KnownCapture, known_capture
from core.evaluation.side_by_side import CAPTURED, SideBySide
from core.motion.database import MotionDatabase
from core.progress import Progress
from core.rig.control_layer import control_basis
from core.rig.control_track import ControlTrack
from core.search.weights import SearchWeights
from core.synthesis.engine import SpeechInput
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks


@dataclass(frozen=True)
class CompareRequest:
    """Two engines and what they are to say.

    names : of the two, `core.evaluation.side_by_side.CAPTURED` for the capture
    engines : the others by name; weights : under which each of them searches
    """

    names: tuple[str, str]
    engines: Mapping[str, LiveEngine]
    weights: Mapping[str, SearchWeights | None]
    speech: SpeechInput
    capture: KnownCapture | None


@dataclass(frozen=True, eq=False)
class Compared:
    """Both motions beside each other; ``tracks`` move the tongue, alike for both, while heads are still."""

    beside: SideBySide
    tracks: PoseTracks
    warnings: tuple[str, ...]


def find_capture(request: tuple[MotionDatabase, str, float], _progress: Progress) -> KnownCapture | None:
    """Look for the capture of a sentence by its words and length."""
    return known_capture(*request)


def compare(request: CompareRequest, progress: Progress) -> Compared:
    """Let one engine after the other speak; raises `UserFacingError`, which names the engine that cannot."""
    motions, warnings = [], []
    for n, name in enumerate(request.names):
        stage = progress.part(0.45 * n, 0.45 * (n + 1))
        stage.step(0.0, texts.COMPARING_WITH)
        motions.append(None if name == CAPTURED else _motion(request, name, stage, warnings))
    progress.step(0.9, texts.COMPARING_WITH)
    truth = None if request.capture is None else request.capture.truth
    transcript = request.speech.transcript
    beside = SideBySide.of(request.names, tuple(motions), transcript, truth)
    beside.courses, beside.agreements  # noqa: B018  computed here, off the main thread
    tracks = PoseTracks.of(transcript, beside.rate_hz, beside.n_frames, head=False, gaze=False)
    return Compared(beside, tracks, tuple(dict.fromkeys(warnings)))


def _motion(request: CompareRequest, name: str, progress: Progress, warnings: list[str]) -> MarkerMotion:
    try:
        answer = request.engines[name].answer(request.speech, request.weights[name], progress)
    except UserFacingError as error:
        why = texts.FAILED.format(engine=title_of(name), why=error.message)
        raise UserFacingError(why, error.remedy) from error
    warnings += answer.warnings
    return answer.motion


@dataclass(frozen=True, eq=False)
class ControlsRequest:
    """Motions by name whose control curves are wanted."""

    motions: Mapping[str, MarkerMotion]
    database: MotionDatabase


def find_controls(request: ControlsRequest, progress: Progress) -> dict[str, ControlTrack]:
    """Return the control curves that make each motion, see `core.rig.control_layer.ControlBasis.curves`."""
    basis = control_basis(request.database)
    found = {}
    for n, (name, motion) in enumerate(request.motions.items()):
        progress.step(n / len(request.motions), texts.FINDING_CONTROLS)
        found[name] = basis.curves(motion, request.database)
    return found


def write_curves(request: tuple[SideBySide, Path], _progress: Progress) -> Path:
    """Write the table of all curves."""
    beside, path = request
    write_course_table(path, beside)
    return path
