"""`efase curves`: control curves of any program to the files of another, or to a film of a face that plays them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

from app.control_export import check_control_outputs, write_track
from app.export import VideoSettings, check_outputs_are_not_read
from core.media.audio import Audio, load_audio
from core.motion.readers.blendshape_files import read_blendshapes
from core.motion.shape_mapping import mapped, read_shape_mapping
from core.pipeline.blendshapes import controls_of
from core.pipeline.curves import read_curves_json
from core.progress import SILENT, Progress
from core.rig.control_track import ControlTrack


@dataclass(frozen=True)
class CurveJob:
    """Everything that `efase curves` was told; see its help."""

    track: Path
    outputs: tuple[Path, ...]
    names: Path | None = None
    rate_hz: float | None = None
    mapping: Path | None = None
    audio: Path | None = None
    face: str = "default"
    video: VideoSettings = field(default_factory=VideoSettings)


def run(job: CurveJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is half-written."""
    given = (job.track, job.audio, job.names, job.mapping, job.face, job.video.texture)
    check_outputs_are_not_read(job.outputs, (str(path) for path in given if path is not None))
    check_control_outputs(job.outputs, job.face)
    track, warnings = _read(job)
    audio = None if job.audio is None else load_audio(job.audio)
    track, audio = cut(track.at_rate(job.video.fps), audio, job.video.span_s)
    warnings += write_track(job.outputs, track, job.face, job.video, audio, progress)
    return {
        "controls": list(track.names), "frames": len(track), "rate_hz": track.rate_hz, "warnings": warnings,
        "outputs": [str(path) for path in job.outputs],
    }  # fmt: skip


def cut(
    track: ControlTrack, audio: Audio | None, span_s: tuple[float, float] | None
) -> tuple[ControlTrack, Audio | None]:
    """Return curves and their sound from ``span_s``, all of them when it is None; raises `UserFacingError`."""
    if span_s is None:
        return track, audio
    part = track.between(*span_s)
    if audio is not None:
        first_s = (part.start_frame - track.start_frame) / track.rate_hz
        begin, end = (round(time_s * audio.rate_hz) for time_s in (first_s, first_s + part.duration_s))
        audio = replace(audio, samples=audio.samples[begin:end])
    return part, audio


def _read(job: CurveJob) -> tuple[ControlTrack, list[str]]:
    if job.track.suffix.lower() == ".json":
        return read_curves_json(job.track), []
    captured = read_blendshapes(job.track, job.names, job.rate_hz)
    if job.mapping is not None:
        captured = mapped(captured, read_shape_mapping(job.mapping))
    return controls_of(captured), list(captured.notes)
