"""From a synthesis to files: video, or markers for other programs."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from app.pictures import STYLES, FaceRig, frames
from core.errors import UserFacingError
from core.media.audio import Audio
from core.media.picture import read_picture
from core.media.swap_in import check_target
from core.media.video import FRAME_RATES, n_video_frames, write_video
from core.progress import SILENT, Progress
from core.speech.loudness import levels_db
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

VIDEO_SUFFIXES = (".avi", ".mp4")
MARKER_SUFFIXES = (".csv", ".c3d")
_PIXELS = re.compile("[0-9]{2,4}")


@dataclass(frozen=True)
class VideoSettings:
    """How a video is drawn.

    fps : one of `FRAME_RATES`; width, height : pixels; style : one of `app.pictures.STYLES`
    start_frame : number of the first frame, written as timecode
    head, gaze : whether head and eyes move by tracks of their own, made from the speech
    texture : a picture for the face's texture coordinates (style ``face``), or None
    """

    fps: Fraction = FRAME_RATES["30"]
    width: int = 640
    height: int = 480
    style: str = "face"
    start_frame: int = 0
    head: bool = True
    gaze: bool = True
    texture: Path | None = None

    def __post_init__(self) -> None:
        if self.style not in STYLES:
            raise UserFacingError(f"There is no style '{self.style}'.", f"Choose one of {', '.join(STYLES)}.")


def frame_rate(name: str) -> Fraction:
    """Return the exact rate that a user's ``--fps`` means; `UserFacingError` for one that is not offered."""
    if name not in FRAME_RATES:
        raise UserFacingError(f"'{name}' is not a frame rate on offer.", f"Choose one of {', '.join(FRAME_RATES)}.")
    return FRAME_RATES[name]


def video_size(text: str) -> tuple[int, int]:
    """Return (width, height) of ``640x480``; `UserFacingError` outside 64 to 4096 pixels."""
    width, _, height = text.lower().partition("x")
    if not all(_PIXELS.fullmatch(n) and 64 <= int(n) <= 4096 for n in (width, height)):
        raise UserFacingError(f"'{text}' is not a picture size.", "Write it as 640x480, each side 64 to 4096 pixels.")
    return int(width), int(height)


def check_outputs(paths: list[Path]) -> None:
    """Raise `UserFacingError` before any work when an output could not be written."""
    for path in paths:
        if path.suffix.lower() not in VIDEO_SUFFIXES + MARKER_SUFFIXES:
            known = ", ".join(VIDEO_SUFFIXES + MARKER_SUFFIXES)
            raise UserFacingError(f"'{path}' has no suffix that can be written.", f"Known are {known}.")
        check_target(path)


def export(
    motion: MarkerMotion,
    audio: Audio,
    rig: FaceRig | None,
    path: Path,
    settings: VideoSettings,
    progress: Progress = SILENT,
    transcript: Transcript | None = None,
) -> None:
    """Write ``motion`` with its sound to ``path``; the suffix says as what. Sampled at the video's frame rate.

    transcript : what is said; in a video it moves the tongue and, if ``settings`` ask for it, head and gaze
    """
    n_frames = n_video_frames(audio.duration_s, settings.fps)
    sampled = motion.at_rate(settings.fps, n_frames)
    suffix = path.suffix.lower()
    if suffix in VIDEO_SUFFIXES:
        tracks = None
        if transcript is not None:
            loudness_db = levels_db(audio.samples, audio.rate_hz)
            tracks = PoseTracks.of(
                transcript, float(settings.fps), n_frames, loudness_db, head=settings.head, gaze=settings.gaze
            )
        texture = None if settings.texture is None else read_picture(settings.texture)
        size = (settings.width, settings.height)
        pictures = frames(sampled, rig, settings.style, *size, tracks=tracks, texture=texture)
        write_video(path, pictures, n_frames, settings.fps, audio, progress, settings.start_frame)
    else:
        from core.motion.motion_files import write_c3d, write_markers_csv

        write = write_c3d if suffix == ".c3d" else write_markers_csv
        write(path, sampled.positions, sampled.markers.names, float(settings.fps))
    progress.step(1.0, f"{path.name} written")


def rounded_seconds(seconds: float) -> float:
    """Round a measured time for a report."""
    return round(seconds, 3 if seconds < 10 else 1) if math.isfinite(seconds) else seconds
