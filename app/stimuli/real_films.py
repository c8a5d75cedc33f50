"""Films of a real speaker as the captured faces of a study: shown under the study's sound, at its size and rate."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.export import VideoSettings
from app.stimuli.tracks import Track
from core.errors import UserFacingError
from core.media.video import n_video_frames, write_video
from core.media.video_reader import VideoReader
from core.progress import Progress

SUFFIXES = (".mp4", ".mov", ".avi", ".mkv", ".webm", ".mpg")


def with_real_films(folder: Path, tracks: Sequence[Track], expressions: Sequence[str]) -> list[Track]:
    """Return the tracks with the films ``AUDIO-EXPRESSION`` (any of `SUFFIXES`) in ``folder``.

    Raises `UserFacingError` that names the first one that is missing.
    """
    if not folder.is_dir():
        raise UserFacingError(f"There is no folder of films '{folder}'.")
    filmed = []
    for track in tracks:
        found = {}
        for expression in expressions:
            paths = [folder / f"{track.name}-{expression}{suffix}" for suffix in SUFFIXES]
            path = next((path for path in paths if path.is_file()), None)
            if path is None:
                raise UserFacingError(f"The folder '{folder}' has no film '{track.name}-{expression}.mp4'.",
                                      f"A film may end in {', '.join(SUFFIXES)}.")  # fmt: skip
            found[expression] = path
        filmed.append(replace(track, films=found))
    return filmed


def write_real_film(path: Path, film: Path, track: Track, video: VideoSettings, progress: Progress) -> None:
    """Write ``film`` to ``path``, under the track's sound and as long, in the size and at the rate of ``video``."""
    n_frames = n_video_frames(track.audio.duration_s, video.fps)
    write_video(path, _pictures(film, n_frames, video), n_frames, video.fps, track.audio, progress)


def _pictures(film: Path, n_frames: int, video: VideoSettings) -> Iterator[np.ndarray]:
    reader = VideoReader(film)
    try:
        for f in range(n_frames):
            yield fitted(reader.frame_at(float(f / video.fps)), video.width, video.height)
    finally:
        reader.close()


def fitted(picture: np.ndarray, width: int, height: int) -> np.ndarray:
    """Return a picture as large as it fits into ``width`` by ``height`` pixels, black where it does not reach."""
    import cv2

    high, wide = picture.shape[:2]
    scale = min(width / wide, height / high)
    size = max(1, round(wide * scale)), max(1, round(high * scale))
    small = cv2.resize(picture, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    whole = np.zeros((height, width, 3), np.uint8)
    top, left = (height - size[1]) // 2, (width - size[0]) // 2
    whole[top : top + size[1], left : left + size[0]] = small
    return whole
