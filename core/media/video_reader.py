"""The picture of a video at any time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from core.errors import UserFacingError

if TYPE_CHECKING:
    import av

# Decoding on is quicker than a jump to the key frame before, up to about this far.
_DECODE_ON_S = 1.0
_LARGEST_PX = 1280
_MICROSECONDS = 1_000_000


class VideoReader:
    """Decodes a video where it is asked to, forwards or by jumps. Not for two threads at once.

    path : anything that FFmpeg reads; raises `UserFacingError` when it holds no picture
    duration_s : seconds, as the file says; fps : pictures a second, on average
    """

    def __init__(self, path: str | Path) -> None:
        import av

        self.path = Path(path)
        try:
            self._container = av.open(str(path))
            self._stream = self._container.streams.video[0]
            self._stream.thread_type = "AUTO"
            self._start_s = (self._container.start_time or 0) / _MICROSECONDS
            self._frames = self._container.decode(self._stream)
            self._shown: av.VideoFrame | None = next(self._frames)
        except (OSError, av.FFmpegError, IndexError, StopIteration, ValueError) as error:
            raise UserFacingError(f"'{path}' is not a video that can be read.") from error
        self._following: av.VideoFrame | None = None
        self._is_at_end = False
        self.fps = float(self._stream.average_rate or self._stream.guessed_rate or 25)
        self.duration_s = self._length_s()

    def frame_at(self, time_s: float) -> np.ndarray:
        """Return the picture that is shown at ``time_s``, uint8 RGB, shape (height, width, 3), 1280 pixels at most.

        Before the first picture it is the first, after the last the last. Raises `UserFacingError` when the file
        breaks off before.
        """
        import av

        try:
            self._go_to(time_s)
            return self._picture()
        except (OSError, av.FFmpegError, ValueError) as error:
            raise UserFacingError(f"'{self.path}' cannot be read at {time_s:.2f} s.") from error

    def close(self) -> None:
        """Let go of the file."""
        self._container.close()

    def _length_s(self) -> float:
        if self._container.duration:
            return self._container.duration / _MICROSECONDS
        if self._stream.duration:
            return float(self._stream.duration * self._stream.time_base)
        return 0.0

    def _time_s(self, frame: av.VideoFrame) -> float:
        return (float(frame.pts * frame.time_base) if frame.pts is not None else 0.0) - self._start_s

    def _go_to(self, time_s: float) -> None:
        now_s = self._time_s(self._shown)
        if time_s < now_s or (time_s > now_s + _DECODE_ON_S and not self._is_at_end):
            self._jump(max(time_s, 0.0))
        while not self._is_at_end:
            if self._following is None:
                self._following = next(self._frames, None)
                self._is_at_end = self._following is None
            # times in files are rounded to their time base
            if self._following is None or self._time_s(self._following) > time_s + 1e-4:
                return
            self._shown, self._following = self._following, None

    def _jump(self, time_s: float) -> None:
        # AVI files are sought to the nearest picture, which may be the one after
        early_s = max(time_s - 1.5 / self.fps, 0.0) + self._start_s
        self._container.seek(round(early_s * _MICROSECONDS), backward=True)
        self._frames = self._container.decode(self._stream)
        first = next(self._frames, None)
        if first is not None:
            self._shown, self._following, self._is_at_end = first, None, False

    def _picture(self) -> np.ndarray:
        frame = self._shown
        share = min(1.0, _LARGEST_PX / max(frame.width, frame.height))
        width, height = max(round(frame.width * share), 1), max(round(frame.height * share), 1)
        picture = frame.reformat(width=width, height=height, format="rgb24").to_ndarray()
        # phones store films lying down, and say so
        return np.ascontiguousarray(np.rot90(picture, round(frame.rotation / 90)))
