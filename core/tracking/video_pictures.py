"""The pictures of a video one after the other, grey, upright and no larger than tracking needs; and its sound."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio

if TYPE_CHECKING:
    import av

LARGEST_PX = 1280
SMALLEST_PX = 64
MOST_FRAMES = 200_000
_MICROSECONDS = 1_000_000
_RATES_HZ = (1.0, 1000.0)
_MOST_PIXELS = 1 << 26
# Their first plane is the grey picture, a byte a pixel; converting takes longer than decoding.
_LUMA_FIRST = {"gray", "nv12", "nv21", *(f"yuv{j}{n}p" for j in ("", "j") for n in ("420", "422", "440", "444"))}


@dataclass(frozen=True)
class VideoFormat:
    """What a video promises.

    width, height : pixels, as it is shown (a phone's film may be stored lying down)
    rate_hz : pictures a second, on average; n_frames : about how many, 0 where the file does not say
    """

    width: int
    height: int
    rate_hz: float
    n_frames: int


def format_of(path: str | Path) -> VideoFormat:
    """Look at a video; raises `UserFacingError` for what cannot be read, and for pictures too small or too large."""
    with _opened(path) as (container, stream):
        frame = next(_decoded(container, stream, path), None)
        if frame is None:
            raise UserFacingError(f"'{path}' holds no picture that can be read.")
        width, height = (frame.height, frame.width) if frame.rotation % 180 else (frame.width, frame.height)
        if min(width, height) < SMALLEST_PX:
            raise UserFacingError(f"The pictures of '{path}' have only {width} by {height} pixels; "
                                  f"{SMALLEST_PX} by {SMALLEST_PX} are needed.")  # fmt: skip
        rate = float(stream.average_rate or stream.guessed_rate or 25)
        if not _RATES_HZ[0] <= rate <= _RATES_HZ[1]:
            raise UserFacingError(f"'{path}' states {rate:g} pictures a second.")
        seconds = float(stream.duration * stream.time_base) if stream.duration else (container.duration or 0) / 1e6
        n_frames = stream.frames or round(seconds * rate)
        if n_frames > MOST_FRAMES:
            raise UserFacingError(f"'{path}' has {n_frames} pictures, and at most {MOST_FRAMES} are tracked at once.",
                                  "Cut it into takes.")  # fmt: skip
        return VideoFormat(width, height, rate, max(0, n_frames))


@dataclass(frozen=True)
class Picture:
    """One picture.

    grey : uint8, shape (height, width), of the working size; time_s : when it is shown, from the file's beginning
    """

    grey: np.ndarray
    time_s: float


def pictures(path: str | Path, shrink: float = 1.0, from_s: float | None = None) -> Iterator[Picture]:
    """Yield the pictures of a video, shrunk to the share ``shrink`` of their size.

    from_s : begin with the picture at this time, which an earlier call gave; None: with the first
    A file that breaks off ends there. Raises `UserFacingError` when there is no first picture.
    """
    with _opened(path) as (container, stream):
        start_s = (container.start_time or 0) / _MICROSECONDS
        if from_s is not None:
            # AVI files are sought to the nearest picture, which may be the one after
            early_s = max(0.0, from_s - 2.0) + start_s
            container.seek(round(early_s * _MICROSECONDS), backward=True)
        rate = float(stream.average_rate or stream.guessed_rate or 25)
        for n, frame in enumerate(_decoded(container, stream, path)):
            timed = frame.pts is not None
            time_s = float(frame.pts * frame.time_base) - start_s if timed else n / rate
            if from_s is None or time_s > from_s - 1e-6:
                yield Picture(_grey(frame, shrink), time_s)


def sound_of(path: str | Path) -> Audio | None:
    """Return the sound of a video, one channel, beginning with the first picture; None where it has none.

    Silence is put before sound that begins later. Sound that cannot be decoded ends there.
    """
    import av

    with _opened(path) as (container, stream):
        sound = next(iter(container.streams.audio), None)
        if sound is None:
            return None
        first_s, blocks, sound_s = None, [], None
        resampler = av.AudioResampler("fltp", "mono", sound.codec_context.sample_rate)
        try:
            for packet in container.demux(stream, sound):
                if packet.stream.type == "video":
                    if first_s is None and packet.pts is not None:
                        first_s = float(packet.pts * packet.time_base)
                    continue
                for frame in packet.decode():
                    if sound_s is None and frame.pts is not None:
                        sound_s = float(frame.pts * frame.time_base)
                    blocks += [block.to_ndarray()[0] for block in resampler.resample(frame)]
        except (av.FFmpegError, ValueError, OSError):
            pass  # what was heard so far
        rate_hz = int(sound.codec_context.sample_rate)
    if not blocks:
        return None
    late = round(((sound_s or 0.0) - (first_s or 0.0)) * rate_hz)
    samples = np.concatenate(blocks)
    samples = np.concatenate([np.zeros(late, np.float32), samples]) if late > 0 else samples[-late:]
    return Audio(np.nan_to_num(samples).astype(np.float32), rate_hz) if len(samples) else None


@contextmanager
def _opened(path: str | Path) -> Iterator[tuple[av.container.InputContainer, av.VideoStream]]:
    import av

    path = Path(path)
    if not path.is_file():
        raise UserFacingError(f"There is no video '{path}'.")
    try:
        container = av.open(str(path))
    except (OSError, av.FFmpegError, ValueError) as error:
        raise UserFacingError(f"'{path}' is not a video that can be read.") from error
    with container:
        stream = next(iter(container.streams.video), None)
        if stream is None:
            raise UserFacingError(f"'{path}' is not a video that can be read.", "It has no pictures.")
        if stream.codec_context is None or stream.width * stream.height > _MOST_PIXELS:
            raise UserFacingError(f"The pictures of '{path}' are too large or of an unknown kind.")
        stream.thread_type = "AUTO"
        yield container, stream


def _decoded(container, stream, path) -> Iterator[av.VideoFrame]:
    import av

    n, size = 0, None
    frames = container.decode(stream)
    while True:
        try:
            frame = next(frames, None)
        except (OSError, av.FFmpegError, ValueError) as error:
            if n:
                return
            raise UserFacingError(f"'{path}' is not a video that can be read.") from error
        if frame is None or n >= MOST_FRAMES:
            return
        size = size or (frame.width, frame.height)
        if (frame.width, frame.height) != size:
            return  # another film begins
        n += 1
        yield frame


def _grey(frame: av.VideoFrame, shrink: float) -> np.ndarray:
    import cv2

    if frame.format.name in _LUMA_FIRST:
        plane = frame.planes[0]
        grey = np.frombuffer(plane, np.uint8).reshape(-1, plane.line_size)[: frame.height, : frame.width]
    else:
        grey = frame.reformat(format="gray").to_ndarray()
    if shrink < 1.0:
        width, height = max(1, round(frame.width * shrink)), max(1, round(frame.height * shrink))
        grey = cv2.resize(grey, (width, height), interpolation=cv2.INTER_AREA)
    return np.ascontiguousarray(np.rot90(grey, round(frame.rotation / 90)))
