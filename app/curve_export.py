"""`efase curves`: control curves of any program to the files of another, or to a film of a face that plays them."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.controlled_face import CAST, Cast, ControlledFace, one_rig
from app.export import DRAWN_SUFFIXES, VideoSettings
from app.pictures import face_pictures
from core.animeme.controls import ControlTrack
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.face.characters import CHARACTERS
from core.media.audio import load_audio
from core.media.image_sequence import SUFFIX as IMAGE_SUFFIX
from core.media.image_sequence import numbered, write_images
from core.media.swap_in import check_target
from core.media.video import write_video
from core.motion.readers.blendshape_files import read_blendshapes
from core.motion.shape_mapping import mapped, read_shape_mapping
from core.pipeline.blendshapes import controls_of
from core.pipeline.control_files import SUFFIXES, check_control_suffix, control_suffix, needs_rig, write_controls
from core.pipeline.curves import read_curves_json
from core.progress import SILENT, Progress
from core.synthesis.pose_tracks import PoseTracks


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
    _check(job)
    track, warnings = _read(job)
    track = track.at_rate(job.video.fps)
    if job.video.span_s is not None:
        track = track.between(*job.video.span_s)
    face = FaceChoice(job.face)
    for n, path in enumerate(job.outputs):
        stage = progress.part(n / len(job.outputs), (n + 1) / len(job.outputs))
        suffix = control_suffix(path, plain_csv=True)
        if suffix is None:
            _write_pictures(job, track, path, stage)
        else:
            rig = one_rig(face, None, path) if needs_rig(suffix) else None
            warnings += write_controls(path, suffix, track, rig)
    return {
        "controls": list(track.names), "frames": len(track), "rate_hz": track.rate_hz,
        "warnings": list(dict.fromkeys(warnings)), "outputs": [str(path) for path in job.outputs],
    }  # fmt: skip


def _check(job: CurveJob) -> None:
    for path in job.outputs:
        suffix = control_suffix(path, plain_csv=True)
        if suffix is not None:
            check_control_suffix(suffix)
        elif path.suffix.lower() not in DRAWN_SUFFIXES:
            raise UserFacingError(f"'{path}' has no suffix that curves can be written to.",
                                  f"Known are .csv, {', '.join((*SUFFIXES, *DRAWN_SUFFIXES))}.")  # fmt: skip
        if os.path.realpath(path) in {os.path.realpath(given) for given in (job.track, job.audio) if given}:
            raise UserFacingError(f"'{path}' is read and cannot be written at the same time.")
        check_target(numbered(path, 0) if path.suffix.lower() == IMAGE_SUFFIX else path)


def _read(job: CurveJob) -> tuple[ControlTrack, list[str]]:
    if job.track.suffix.lower() == ".json":
        return read_curves_json(job.track), []
    captured = read_blendshapes(job.track, job.names, job.rate_hz)
    if job.mapping is not None:
        captured = mapped(captured, read_shape_mapping(job.mapping))
    return controls_of(captured), list(captured.notes)


def _write_pictures(job: CurveJob, track: ControlTrack, path: Path, progress: Progress) -> None:
    names = list(CHARACTERS) if job.face == CAST else [job.face]
    members = [ControlledFace(one_rig(FaceChoice(name), None, path)) for name in names]
    still, n_frames = PoseTracks(), len(track)
    poses = (
        tuple(positions for of_one in at_once for positions in of_one)
        for at_once in zip(*(member.controlled(track, still, 0, n_frames) for member in members))
    )
    video = job.video
    pictures = face_pictures(Cast(tuple(members)).faces, poses, n_frames, video.style, video.width, video.height,
                             background=video.background)  # fmt: skip
    if path.suffix.lower() == IMAGE_SUFFIX:
        write_images(path, pictures, n_frames, progress, track.start_frame)
        return
    audio = None if job.audio is None else load_audio(job.audio)
    if audio is not None and video.span_s is not None:
        begin, end = (round(time_s * audio.rate_hz) for time_s in video.span_s)
        audio = replace(audio, samples=audio.samples[begin:end])
    write_video(path, pictures, n_frames, video.fps, audio, progress, track.start_frame)
