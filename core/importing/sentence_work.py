"""What an import does with one sentence: read, pick markers, place the speech, mend, compare with the sound."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.importing.mending import GAP, LONG_GAP, SPIKE, SWAP, Mended, mend
from core.importing.plan import ImportPlan, SentencePlan
from core.importing.pose_model import PoseModel
from core.importing.report import SentenceReport
from core.importing.sound_offset import OffsetEstimate, audio_offset, mouth_opening
from core.importing.steady_markers import rigid_residual_mm
from core.importing.takes import limits_for, read_take
from core.media.audio import Audio, load_audio
from core.motion.motion_track import MotionTrack
from core.motion.recording import Recording
from core.speech.placing import ALIGNED, RECOGNISED, SILENCE, placed_speech
from core.speech.transcript import Transcript

# A take as long as this knows its own poses better than another's database does.
_OWN_POSES_S = 10.0


@dataclass(frozen=True)
class WorkedSentence:
    """A sentence that is ready to be built, and what was done to it.

    mended : row by row, for a picture; offset : None where there was nothing to compare
    """

    recording: Recording
    report: SentenceReport
    mended: Mended
    offset: OffsetEstimate | None


def work_on(plan: ImportPlan, sentence: SentencePlan) -> WorkedSentence:
    """Do all of an import's work on one sentence, except for taking the measured offset out.

    Raises `UserFacingError` for files that cannot be used or do not fit each other.
    """
    track = read_take(sentence, plan.reading)
    if track.true_scale == plan.with_scale:
        raise UserFacingError(
            f"'{sentence.motion}' holds {'millimetres' if track.true_scale else 'points of a picture'}, and the "
            f"import is one of {'points of pictures' if plan.with_scale else 'millimetres'}."
        )
    names, positions = picked(track, plan.markers, sentence)
    audio = load_audio(Path(sentence.audio)) if sentence.audio else None
    duration_s = audio.duration_s if audio is not None else len(positions) / track.rate_hz
    transcript, text, alignment = placed_speech(audio, duration_s, sentence.transcript, sentence.text, plan.lexicon)
    rigid = [names.index(name) for name in plan.rigid if name in names]
    limits = limits_for(sentence, plan.mending)
    mended = mend(positions, names, track.rate_hz, limits, rigid, model_of(plan.like, names, track))
    lips = [names.index(plan.landmarks[lip]) if plan.landmarks.get(lip) in names else None
            for lip in ("upper_lip", "lower_lip")]  # fmt: skip
    offset = None
    if audio is not None and alignment != SILENCE:
        opening = mouth_opening(mended.positions, *lips)
        offset = audio_offset(opening, track.rate_hz, audio, transcript, signed=None not in lips)
    report = SentenceReport(
        sentence.name, seconds=round(len(positions) / track.rate_hz, 3), rate_hz=track.rate_hz, markers=len(names),
        gaps_filled=mended.count(GAP), gap_samples=mended.samples(GAP), gaps_left=mended.count(LONG_GAP),
        spikes_cut=mended.count(SPIKE), spike_samples=mended.samples(SPIKE), swaps_undone=mended.count(SWAP),
        rigid_residual_mm=_residual(mended.positions, rigid, plan.with_scale),
        offset_s=None if offset is None else round(offset.offset_s, 4),
        offset_confidence=None if offset is None else round(offset.confidence, 3),
        alignment=alignment, alignment_confidence=_confidence(audio, transcript, alignment),
        notes=(*track.notes, *transcript.warnings),
    )  # fmt: skip
    recording = Recording(
        sentence.name, sentence.emotion, mended.positions.astype(np.float32), names, track.rate_hz, transcript, text,
        None if sentence.audio is None else Path(sentence.audio),
    )  # fmt: skip
    return WorkedSentence(recording, report, mended, offset)


def picked(
    track: MotionTrack, markers: Mapping[str, str], sentence: SentencePlan
) -> tuple[tuple[str, ...], np.ndarray]:
    """Return the database's marker names and their positions; all of the take's own without a map.

    Raises `UserFacingError` when the take lacks one.
    """
    if not markers:
        return track.names, np.asarray(track.positions)
    column = {name: k for k, name in enumerate(track.names)}
    lacking = [name for name in markers if name not in column]
    if lacking:
        raise UserFacingError(f"'{sentence.motion}' has no marker '{lacking[0]}', which the import keeps.")
    return tuple(markers.values()), np.asarray(track.positions)[:, [column[name] for name in markers]]


def _confidence(audio: Audio | None, transcript: Transcript, alignment: str) -> float | None:
    if alignment not in (ALIGNED, RECOGNISED):
        return None
    from core.speech.second_listening import listen_again

    return round(listen_again(audio, transcript).of_sentence, 3)


def model_of(like: str | None, names: tuple[str, ...], track: MotionTrack) -> PoseModel | None:
    """Return the poses that fill the gaps of a short take, learnt from the database ``like``; None: the take's own."""
    if like is None or len(track.positions) >= _OWN_POSES_S * track.rate_hz:
        return None
    from core.motion.database import open_database

    return PoseModel.of_database(open_database(Path(like)), names)


def _residual(positions: np.ndarray, rigid: list[int], with_scale: bool) -> float | None:
    if len(rigid) < 3 or with_scale:
        return None
    residual = rigid_residual_mm(positions, rigid)
    return round(float(np.sqrt(np.mean(residual**2))), 3) if np.isfinite(residual).all() else None


def failed(sentence: SentencePlan, reason: str) -> SentenceReport:
    """Return the row of a sentence that is left out."""
    return replace(SentenceReport(sentence.name), failure=reason)
