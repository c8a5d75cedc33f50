"""From a synthesis to files: video, still pictures, markers for other programs, or its transcript."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from app.control_export import write_motion_controls
from app.controlled_face import drawable
from app.pictures import STYLES, Drawable, frames
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.face.default_face import FaceUnavailable
from core.media.audio import Audio
from core.media.image_sequence import SUFFIX as IMAGE_SUFFIX
from core.media.image_sequence import numbered, write_images
from core.media.picture import read_picture
from core.media.swap_in import check_target
from core.media.video import FRAME_RATES, n_video_frames, write_video
from core.pipeline.control_files import SUFFIXES as CONTROL_SUFFIXES
from core.pipeline.control_files import check_control_suffix, control_suffix
from core.progress import SILENT, Progress
from core.speech.loudness import levels_db
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

VIDEO_SUFFIXES = (".avi", ".mp4")
MARKER_SUFFIXES = (".csv", ".c3d")
TRANSCRIPT_SUFFIX = ".textgrid"
DRAWN_SUFFIXES = (*VIDEO_SUFFIXES, IMAGE_SUFFIX)
SUFFIXES = (*VIDEO_SUFFIXES, IMAGE_SUFFIX, *MARKER_SUFFIXES, ".TextGrid", *CONTROL_SUFFIXES)
_COLOUR = re.compile("#[0-9a-fA-F]{6}")
_PIXELS = re.compile("[0-9]{2,4}")


@dataclass(frozen=True)
class VideoSettings:
    """How a video is drawn.

    fps : one of `FRAME_RATES`; width, height : pixels; style : one of `app.pictures.STYLES`
    start_frame : number of the first frame, written as timecode
    head, gaze : whether head and eyes move by tracks of their own, made from the speech
    texture : a picture for the face's texture coordinates (style ``face``), or None
    background : red, green, blue, 0..1 as on screen, behind the face; None: the studio's
    span_s : start and end of what is written, seconds of the speech; None: all of it
    """

    fps: Fraction = FRAME_RATES["30"]
    width: int = 640
    height: int = 480
    style: str = "face"
    start_frame: int = 0
    head: bool = True
    gaze: bool = True
    texture: Path | None = None
    background: tuple[float, float, float] | None = None
    span_s: tuple[float, float] | None = None

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


def background_colour(text: str | None) -> tuple[float, float, float] | None:
    """Return the colour that ``#rrggbb`` means, None for None; `UserFacingError` for anything else."""
    if text is None:
        return None
    if not _COLOUR.fullmatch(text):
        raise UserFacingError(f"'{text}' is not a colour.", "Write it as #rrggbb, for instance #00ff00.")
    return tuple(int(text[i : i + 2], 16) / 255 for i in (1, 3, 5))


def span_of_time(text: str | None) -> tuple[float, float] | None:
    """Return (start_s, end_s) of ``1.5-3``, None for None; `UserFacingError` unless it is a stretch of time."""
    if text is None:
        return None
    start, _, end = text.partition("-")
    try:
        span_s = float(start), float(end)
    except ValueError:
        span_s = math.nan, math.nan
    if not 0.0 <= span_s[0] < span_s[1] < math.inf:
        raise UserFacingError(f"'{text}' is not a stretch of time.", "Write it in seconds as START-END, as in 1.5-3.")
    return span_s


def is_drawn(paths: Iterable[Path]) -> bool:
    """Whether any of the outputs shows a face."""
    return any(path.suffix.lower() in DRAWN_SUFFIXES for path in paths)


def check_outputs(paths: list[Path]) -> None:
    """Raise `UserFacingError` before any work when an output could not be written."""
    for path in paths:
        suffix = path.suffix.lower()
        controls = control_suffix(path)
        if controls is not None:
            check_control_suffix(controls)
        elif suffix not in (*DRAWN_SUFFIXES, *MARKER_SUFFIXES, TRANSCRIPT_SUFFIX):
            raise UserFacingError(f"'{path}' has no suffix that can be written.", f"Known are {', '.join(SUFFIXES)}.")
        check_target(numbered(path, 0) if suffix == IMAGE_SUFFIX else path)


def check_outputs_are_not_read(outputs: Iterable[Path], files_read: Iterable[str]) -> None:
    """Raise `UserFacingError` for an output that is also one of ``files_read``."""
    read = {os.path.realpath(path) for path in files_read}
    for path in outputs:
        if os.path.realpath(path) in read:
            raise UserFacingError(f"'{path}' is read and cannot be written at the same time.")


def export(
    motion: MarkerMotion,
    audio: Audio,
    rig: Drawable | None,
    path: Path,
    settings: VideoSettings,
    progress: Progress = SILENT,
    transcript: Transcript | None = None,
) -> None:
    """Write ``motion`` with its sound to ``path``; the suffix says as what. Sampled at the video's frame rate.

    transcript : what is said; in pictures it moves the tongue and, if ``settings`` ask for it, head and gaze
    Raises `UserFacingError` for a span that lies outside the speech, and for a TextGrid of nothing said.
    """
    suffix = path.suffix.lower()
    first, stop = _frame_span(settings, n_video_frames(audio.duration_s, settings.fps))
    if suffix == TRANSCRIPT_SUFFIX:
        _write_transcript(path, transcript, settings)
    elif suffix in DRAWN_SUFFIXES:
        _write_pictures(motion, audio, rig, path, settings, progress, transcript, first, stop)
    else:
        from core.motion.motion_files import write_c3d, write_markers_csv

        write = write_c3d if suffix == ".c3d" else write_markers_csv
        sampled = motion.at_rate(settings.fps, stop).positions[first:]
        write(path, sampled, motion.markers.names, float(settings.fps))
    progress.step(1.0, f"{path.name} written")


def _frame_span(settings: VideoSettings, n_frames: int) -> tuple[int, int]:
    """First frame and the one after the last, of those that begin within the span."""
    if settings.span_s is None:
        return 0, n_frames
    first, stop = (math.ceil(time_s * settings.fps - 1e-6) for time_s in settings.span_s)
    if first >= min(stop, n_frames):
        start_s, end_s = settings.span_s
        raise UserFacingError(f"From {start_s:g} s to {end_s:g} s there is no frame of the speech.")
    return first, min(stop, n_frames)


def _write_pictures(
    motion: MarkerMotion, audio: Audio, rig: Drawable | None, path: Path, settings: VideoSettings, progress: Progress,
    transcript: Transcript | None, first: int, stop: int,
) -> None:  # fmt: skip
    tracks = PoseTracks()
    n_frames = n_video_frames(audio.duration_s, settings.fps)
    if transcript is not None:
        loudness_db = levels_db(audio.samples, audio.rate_hz)
        tracks = PoseTracks.of(
            transcript, float(settings.fps), n_frames, loudness_db, head=settings.head, gaze=settings.gaze
        )
    texture = None if settings.texture is None else read_picture(settings.texture)
    sampled = motion.at_rate(settings.fps, n_frames)
    pictures = frames(sampled, rig, settings.style, settings.width, settings.height, tracks=tracks, texture=texture,
                      background=settings.background, span=(first, stop))  # fmt: skip
    start_frame = settings.start_frame + first
    if path.suffix.lower() == IMAGE_SUFFIX:
        write_images(path, pictures, stop - first, progress, start_frame)
        return
    begin, end = (round(frame / settings.fps * audio.rate_hz) for frame in (first, stop))
    heard = audio if settings.span_s is None else replace(audio, samples=audio.samples[begin:end])
    write_video(path, pictures, stop - first, settings.fps, heard, progress, start_frame)


def _write_transcript(path: Path, transcript: Transcript | None, settings: VideoSettings) -> None:
    from core.speech.textgrid import write_textgrid

    if transcript is None:
        raise UserFacingError(f"There is no transcript to write to '{path}'.")
    write_textgrid(transcript if settings.span_s is None else transcript.between(*settings.span_s), path)


def write_outputs(
    outputs: Sequence[Path],
    motion: MarkerMotion,
    audio: Audio,
    transcript: Transcript,
    video: VideoSettings,
    face: FaceChoice,
    progress: Progress = SILENT,
    key_poses: Path | None = None,
    csv_is_live_link: bool = False,
) -> list[str]:
    """Write ``motion`` to every one of ``outputs`` (see `export`); return sentences to warn with.

    key_poses : an artist's poses of key lip shapes on a rig that the face names
    csv_is_live_link : a plain .csv holds the weights of ARKit's units, else the markers

    Files of controls (`core.pipeline.control_files`) are sampled at the video's frame rate too. Where the face cannot
    be had, pictures show the markers, and that is one of the warnings.
    """
    controls = [path for path in outputs if control_suffix(path, csv_is_live_link)]
    others = [path for path in outputs if path not in controls]
    rig, warnings = None, []
    if video.style != "markers" and is_drawn(others):
        try:
            rig = drawable(face, motion.markers, key_poses, progress.part(0.0, 0.1))
        except FaceUnavailable as error:
            warnings.append(str(error))
            video = replace(video, style="markers")
    if controls:
        first, stop = _frame_span(video, n_video_frames(audio.duration_s, video.fps))
        sampled = motion.at_rate(video.fps, stop)
        sampled = replace(sampled, positions=sampled.positions[first:])
        warnings += write_motion_controls(
            controls, sampled, face, key_poses, video.start_frame + first, csv_is_live_link
        )
    for i, path in enumerate(others):
        stage = progress.part(0.1 + 0.9 * i / len(others), 0.1 + 0.9 * (i + 1) / len(others))
        export(motion, audio, rig, path, video, stage, transcript)
    return warnings


def rounded_seconds(seconds: float) -> float:
    """Round a measured time for a report."""
    return round(seconds, 3 if seconds < 10 else 1) if math.isfinite(seconds) else seconds
