"""Pictures and sound into one video file: AVI for exact editing, MP4 for showing around."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio, resampled
from core.media.swap_in import swapped_in
from core.progress import SILENT, Progress

if TYPE_CHECKING:
    import av
    from av.container import InputContainer, OutputContainer

# What ``--fps`` may name. The television rate is 30000/1001, never 29.97 itself.
FRAME_RATES = {
    "24": Fraction(24), "25": Fraction(25), "29.97": Fraction(30000, 1001), "30": Fraction(30), "60": Fraction(60),
}  # fmt: skip
SUFFIXES = (".avi", ".mp4")
_AAC_RATES_HZ = (8000, 11025, 12000, 16000, 22050, 24000, 32000, 44100, 48000, 64000, 88200, 96000)
_AUDIO_BLOCK = 1024


def n_video_frames(duration_s: float, fps: Fraction) -> int:
    """Return how many frames cover a sound of ``duration_s``: rounded up, at least one.

    So the picture never stops before the sound, and outlasts it by less than one frame.
    """
    # a millionth of a frame is rounding in duration_s, not sound to be covered
    return max(1, math.ceil(Fraction(duration_s) * fps - Fraction(1, 1_000_000)))


def timecode(start_frame: int, fps: Fraction | float) -> str:
    """Return ``hh:mm:ss:ff`` of a frame counted from midnight; non-drop, so 29.97 counts 30 frames a second.

    A rate that was measured, 60.02 say, counts the nearest whole number of frames too.
    """
    nominal = max(1, round(fps))
    seconds, frame = divmod(start_frame % (24 * 3600 * nominal), nominal)
    return f"{seconds // 3600:02d}:{seconds // 60 % 60:02d}:{seconds % 60:02d}:{frame:02d}"


def check_video_path(path: str | Path) -> None:
    """Raise `UserFacingError` unless ``path`` ends in .avi or .mp4, before hours of work go into it."""
    if Path(path).suffix.lower() not in SUFFIXES:
        raise UserFacingError(f"'{path}' is no kind of video that can be written.", "End its name in .avi or .mp4.")


def write_video(
    path: str | Path,
    frames: Iterable[np.ndarray],
    n_frames: int,
    fps: Fraction,
    audio: Audio | None = None,
    progress: Progress = SILENT,
    start_frame: int = 0,
) -> None:
    """Write a video whose frame k is shown at k / fps and whose sound starts with frame 0.

    .avi holds Motion JPEG and 16-bit PCM, .mp4 holds H.264 and AAC. H.264 has no B-frames, and the priming of AAC
    lies before time zero (the file's edit list says so), so that nothing starts late. Odd sizes are raised to even
    ones by repeating the last row and column.

    frames : ``n_frames`` pictures, uint8, shape (height, width, 3), all of one size, top row first
    audio : louder than full scale is clipped; None writes a silent film
    progress : asked before each frame; when it raises, nothing is left behind
    start_frame : kept as a timecode, ``hh:mm:ss:ff``, in the file

    Raises `UserFacingError` for another suffix and for a file that cannot be written.
    """
    import av

    check_video_path(path)
    if n_frames < 1:
        raise ValueError("a video needs at least one frame")
    is_mp4 = Path(path).suffix.lower() == ".mp4"
    if audio is not None and is_mp4 and audio.rate_hz not in _AAC_RATES_HZ:
        audio = resampled(audio, 48_000)
    settings = {"movflags": "+faststart"} if is_mp4 else {}
    try:
        # the inner block closes first: the container writes its index before the file is swapped in
        with (
            swapped_in(path) as beside,
            av.open(str(beside), "w", format="mp4" if is_mp4 else "avi", options=settings) as container,
        ):
            container.metadata["timecode"] = timecode(start_frame, fps)
            _write(container, frames, n_frames, fps, audio, progress, is_mp4)
    except av.FFmpegError as error:
        raise UserFacingError(f"'{path}' cannot be written: {error.strerror or error}.") from error


def _write(
    container: OutputContainer,
    frames: Iterable[np.ndarray],
    n_frames: int,
    fps: Fraction,
    audio: Audio | None,
    progress: Progress,
    is_mp4: bool,
) -> None:
    import av

    pictures = container.add_stream("libx264" if is_mp4 else "mjpeg", rate=fps)
    pictures.pix_fmt = "yuv420p" if is_mp4 else "yuvj420p"
    pictures.options = {"crf": "17", "preset": "veryfast", "bf": "0"} if is_mp4 else {"qmin": "2", "qmax": "2"}
    pictures.codec_context.time_base = 1 / fps
    sound, blocks = None, iter(())
    if audio is not None:
        sound = container.add_stream("aac" if is_mp4 else "pcm_s16le", rate=audio.rate_hz, layout="mono")
        if is_mp4:
            sound.bit_rate = 160_000
        blocks = _audio_blocks(audio, is_mp4)

    n_written, shape = 0, None
    for k, picture in enumerate(frames):
        progress.step(k / n_frames, "writing video")
        if shape is None:
            shape = picture.shape
            pictures.height, pictures.width = (n + n % 2 for n in shape[:2])
        if picture.shape != shape or picture.dtype != np.uint8:
            raise ValueError(f"frame {k} is {picture.dtype} {picture.shape}; the first one is uint8 {shape}")
        frame = av.VideoFrame.from_ndarray(_even(picture), format="rgb24")
        frame.pts, frame.time_base = k, 1 / fps
        container.mux(pictures.encode(frame))
        n_written += 1
        # sound keeps up with the picture, so that players need not seek and the muxer need not wait
        for block in blocks:
            container.mux(sound.encode(block))
            if block.pts + block.samples >= n_written / fps * block.sample_rate:
                break
    if n_written != n_frames:
        raise ValueError(f"{n_frames} frames were promised and {n_written} came")
    container.mux(pictures.encode(None))
    if sound is not None:
        for block in blocks:
            container.mux(sound.encode(block))
        container.mux(sound.encode(None))
    progress.step(1.0)


def _audio_blocks(audio: Audio, as_float: bool) -> Iterator[av.AudioFrame]:
    import av

    for start in range(0, len(audio.samples), _AUDIO_BLOCK):
        samples = np.clip(audio.samples[None, start : start + _AUDIO_BLOCK], -1.0, 1.0)
        if as_float:
            block = av.AudioFrame.from_ndarray(np.ascontiguousarray(samples, np.float32), "fltp", "mono")
        else:
            block = av.AudioFrame.from_ndarray(
                np.rint(samples * 32768).clip(-32768, 32767).astype(np.int16), "s16", "mono"
            )
        block.sample_rate = audio.rate_hz
        block.pts, block.time_base = start, Fraction(1, audio.rate_hz)
        yield block


def _even(picture: np.ndarray) -> np.ndarray:
    height, width = picture.shape[:2]
    if height % 2 or width % 2:
        picture = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
    return np.ascontiguousarray(picture)


@dataclass(frozen=True)
class VideoFacts:
    """What a video file says of itself.

    width, height : pixels
    n_frames : pictures that decode
    fps : their rate
    video_start_s, video_duration_s : when the first picture is shown and how long all of them last
    audio_start_s, audio_duration_s : the same of the sound; None without any
    audio_rate_hz : samples a second, or None
    timecode : ``hh:mm:ss:ff`` of the first frame, or an empty text
    """

    width: int
    height: int
    n_frames: int
    fps: Fraction
    video_start_s: float
    video_duration_s: float
    audio_start_s: float | None
    audio_duration_s: float | None
    audio_rate_hz: int | None
    timecode: str


def probe(path: str | Path) -> VideoFacts:
    """Decode a video file once and return what it holds. Raises `UserFacingError` if it is not a video."""
    import av

    try:
        with av.open(str(path)) as container:
            return _facts(container)
    except (OSError, av.FFmpegError, IndexError) as error:
        raise UserFacingError(f"'{path}' is not a video that can be read.") from error


def _facts(container: InputContainer) -> VideoFacts:
    stream = container.streams.video[0]
    sound = container.streams.audio[0] if container.streams.audio else None
    shown_s: list[Fraction] = []
    heard_s: list[tuple[Fraction, Fraction]] = []
    for packet in container.demux([s for s in (stream, sound) if s is not None]):
        for frame in packet.decode():
            start_s = frame.pts * frame.time_base
            if packet.stream.type == "video":
                shown_s.append(start_s)
            else:
                heard_s.append((start_s, start_s + Fraction(frame.samples, frame.sample_rate)))
    fps = stream.average_rate
    code = container.metadata.get("timecode") or stream.metadata.get("timecode", "")
    return VideoFacts(
        width=stream.codec_context.width,
        height=stream.codec_context.height,
        n_frames=len(shown_s),
        fps=fps,
        video_start_s=float(shown_s[0]),
        video_duration_s=float(shown_s[-1] - shown_s[0] + 1 / fps),
        audio_start_s=float(heard_s[0][0]) if heard_s else None,
        audio_duration_s=float(heard_s[-1][1] - heard_s[0][0]) if heard_s else None,
        audio_rate_hz=sound.codec_context.sample_rate if sound is not None else None,
        timecode=code,
    )
