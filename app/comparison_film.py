"""The film of a comparison: two motions of one speech side by side, each under its name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.child_process import run_apart
from app.export import VideoSettings
from app.pictures import Drawable, face_pictures, marker_pictures, n_columns
from app.texts import compare as texts
from core.media.audio import Audio
from core.media.video import n_video_frames, write_video
from core.progress import SILENT, Progress
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion
from core.synthesis.pose_tracks import PoseTracks

_TEXT_SHARE, _LEAST_TEXT_PX = 0.032, 11  # of the picture's height
_INK, _PAPER, _PAPER_SHARE = 225, 18, 0.6


@dataclass(frozen=True)
class FilmRequest:
    """All that the film needs; heads are still, and tongues move alike, so that nothing but the motions differs.

    titles : written over each; rig : one face, for both; None draws markers
    """

    motions: tuple[MarkerMotion, MarkerMotion]
    titles: tuple[str, str]
    audio: Audio
    transcript: Transcript
    rig: Drawable | None
    settings: VideoSettings
    path: Path


def compose_apart(request: FilmRequest, progress: Progress) -> Path:
    """Compose the film in a process of its own and return its path; a cancel kills the process."""
    return run_apart(compose, (request,), progress, texts.FILM_PROCESS_DIED)


def compose(request: FilmRequest, progress: Progress = SILENT) -> Path:
    """Compose the film and return its path.

    Raises `UserFacingError` on a machine without GL, and for a file that cannot be written.
    """
    settings, audio = request.settings, request.audio
    n_frames = n_video_frames(audio.duration_s, settings.fps)
    pictures = _titled(_pictures(request, n_frames), request.titles, settings)
    write_video(request.path, pictures, n_frames, settings.fps, audio, progress, settings.start_frame)
    return request.path


def _pictures(request: FilmRequest, n_frames: int) -> Iterator[np.ndarray]:
    settings, rig = request.settings, request.rig
    motions = [motion.at_rate(settings.fps, n_frames) for motion in request.motions]
    if rig is None or settings.style == "markers":
        return marker_pictures(motions, settings.width, settings.height, SILENT, settings.background, 0, n_frames)
    tracks = PoseTracks.of(request.transcript, float(settings.fps), n_frames, head=False, gaze=False)
    both = zip(*(rig.poses(motion, tracks, 0, n_frames) for motion in motions))
    poses = (one + other for one, other in both)
    return face_pictures(rig.faces * 2, poses, n_frames, settings.style, settings.width, settings.height, SILENT,
                         background=settings.background)  # fmt: skip


def _titled(pictures: Iterable[np.ndarray], titles: tuple[str, str], settings: VideoSettings) -> Iterator[np.ndarray]:
    """Lay a line of text over the upper left corner of each half."""
    width, height = settings.width, settings.height
    columns = n_columns(len(titles), width, height)
    size_px = max(_LEAST_TEXT_PX, round(_TEXT_SHARE * height))
    corners = [(n // columns * (height // -(-len(titles) // columns)), n % columns * (width // columns))
               for n in range(len(titles))]  # fmt: skip
    labels = [title_picture(title, size_px, width // columns) for title in titles]
    for picture in pictures:
        picture = picture.copy()
        for (top, left), (paper, ink) in zip(corners, labels):
            under = picture[top : top + len(ink), left : left + ink.shape[1]]
            shaded = under * (1 - _PAPER_SHARE * paper) + _PAPER * _PAPER_SHARE * paper
            under[:] = np.rint(shaded * (1 - ink) + _INK * ink)
        yield picture


def title_picture(title: str, size_px: int, most_px: int) -> tuple[np.ndarray, np.ndarray]:
    """Return where a title's ground and its letters are, 0..1, both of shape (height, width, 1); cut at ``most_px``."""
    import cv2

    scale = cv2.getFontScaleFromHeight(cv2.FONT_HERSHEY_DUPLEX, round(0.7 * size_px), 1)
    (wide, high), below = cv2.getTextSize(title, cv2.FONT_HERSHEY_DUPLEX, scale, 1)
    margin = round(0.5 * size_px)
    ink = np.zeros((high + below + 2 * margin, wide + 2 * margin), np.uint8)
    cv2.putText(ink, title, (margin, margin + high), cv2.FONT_HERSHEY_DUPLEX, scale, 255, 1, cv2.LINE_AA)
    ink = ink[:, :most_px, None] / 255.0
    return np.ones_like(ink), ink
