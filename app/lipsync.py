"""`efase lipsync --model`: speech to a rig's controls by animemes that were trained on just these controls."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from pathlib import Path

from app.control_export import check_control_outputs, write_track
from app.curve_export import cut
from app.export import VideoSettings, check_outputs_are_not_read, rounded_seconds
from app.speech import emotion_modifiers, load_speech
from core.animeme.animeme import load_animemes
from core.errors import UserFacingError
from core.media.video import n_video_frames
from core.progress import SILENT, Progress
from core.rig.key_poses import load_key_poses, share_controls
from core.rig.rig_files import load_rig
from core.speech.loudness import levels_db
from core.synthesis.pose_tracks import PoseTracks


@dataclass(frozen=True)
class LipsyncJob:
    """Everything that `efase lipsync --model` was told; see its help."""

    audio: Path
    outputs: tuple[Path, ...]
    model: Path
    text: str | None = None
    phones: Path | None = None
    emotion: str | None = None
    emotions: Path | None = None
    face: str = "default"
    key_poses: Path | None = None
    video: VideoSettings = field(default_factory=VideoSettings)
    lexicon: Path | None = None
    strict: bool = False
    language: str | None = None
    phone_table: str | None = None
    holds: bool = False

    @property
    def files_read(self) -> tuple[str, ...]:
        """Every file that is read for it; a few of the names are words (a text, a face of ours), and no files."""
        given = (self.audio, self.model, self.text, self.phones, self.emotions, self.face, self.key_poses,
                 self.video.texture, self.lexicon, self.phone_table)  # fmt: skip
        return tuple(str(name) for name in given if name is not None)


def run(job: LipsyncJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is half-written."""
    check_outputs_are_not_read(job.outputs, job.files_read)
    check_control_outputs(job.outputs, job.face)
    model = load_animemes(job.model)
    if model.names[0].startswith("component"):
        raise UserFacingError(f"'{job.model}' drives the components of a database, not controls.",
                              "Train with --rig arkit, with --rig lips, or from an artist's curves.")  # fmt: skip
    poses = None if job.key_poses is None else load_key_poses(job.key_poses)
    if poses is not None and set(poses.keys) != set(model.names):
        raise UserFacingError(
            f"The key lip shapes of '{job.key_poses}' are not those that '{job.model}' was trained on."
        )
    speech = load_speech(job.audio, job.text, job.phones, job.lexicon, job.strict, progress.part(0.0, 0.3),
                         job.language, job.phone_table)  # fmt: skip
    modifiers = emotion_modifiers(job.emotion, job.emotions, speech.audio.duration_s)
    fps, n_frames = job.video.fps, n_video_frames(speech.audio.duration_s, job.video.fps)
    began = time.perf_counter()
    track = model.curves(speech.transcript, float(fps), modifiers, n_frames, job.holds)
    synthesis_s = time.perf_counter() - began
    if poses is not None:
        track = share_controls(poses, load_rig(job.face), track)
    track = replace(track, start_frame=job.video.start_frame)
    part, audio = cut(track, speech.audio, job.video.span_s)
    first = part.start_frame - track.start_frame
    loudness_db = levels_db(speech.audio.samples, speech.audio.rate_hz)
    tracks = PoseTracks.of(speech.transcript, float(fps), n_frames, loudness_db, head=job.video.head,
                           gaze=job.video.gaze)  # fmt: skip
    warnings = list(speech.transcript.warnings)
    warnings += write_track(job.outputs, part, job.face, job.video, audio, progress.part(0.3, 1.0), tracks.later(first))
    return {
        "phonemes": [{"phone": u.phone, "start_s": u.start_s, "end_s": u.end_s} for u in speech.transcript.phonemes],
        "controls": list(track.names), "engine": "animeme", "text": speech.text,
        "seconds": {"synthesis": rounded_seconds(synthesis_s)}, "warnings": warnings,
        "outputs": [str(path) for path in job.outputs],
    }  # fmt: skip
