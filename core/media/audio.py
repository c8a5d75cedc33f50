"""Sound as one channel of float32, whatever file it came from."""

from __future__ import annotations

import hashlib
import io
import os
import re
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import BinaryIO

import numpy as np
import soundfile
import soxr

from core.errors import UserFacingError
from core.media.swap_in import swapped_in

SHORTEST_S = 0.05
LONGEST_S = 3600.0
RATES_HZ = (4_000, 768_000)
_BLOCK_FRAMES = 1 << 16
_HIGHEST_FLAC_HZ = 655_350

# What libsndfile's log says of a file that lost its end. A streamed WAV promises 2**31 bytes or more: that is no loss.
_PROMISED_BYTES = re.compile(r"^\s*(?:data|SSND) : (\d+) \(should be (\d+)\)", re.MULTILINE)
_STREAMED_BYTES = 0x7FFF0000
_PADDING_BYTES = 64
_OTHER_LOSSES = ("File ended unexpectedly", "Junk after the last page", "does not match value from 'ds64'")


@dataclass(frozen=True, eq=False)
class Audio:
    """Mono sound.

    samples : float32, shape (n,), full scale is -1..1
    rate_hz : samples per second
    path : the file it came from, or None
    """

    samples: np.ndarray
    rate_hz: int
    path: Path | None = None

    @property
    def duration_s(self) -> float:
        """Length in seconds."""
        return len(self.samples) / self.rate_hz

    @cached_property
    def kept(self) -> bytes:
        """The sound as a project keeps it: a FLAC file of 24 bits, or WAV at a rate that FLAC does not know."""
        container, subtype = ("FLAC", "PCM_24") if self.rate_hz <= _HIGHEST_FLAC_HZ else ("WAV", "FLOAT")
        return _encoded(self, container, subtype)

    @cached_property
    def digest(self) -> str:
        """SHA-256 of `kept`, in hexadecimal."""
        return hashlib.sha256(self.kept).hexdigest()

    @property
    def name(self) -> str:
        """What messages call this sound: its path in quotes, or 'the sound'."""
        return f"'{self.path}'" if self.path else "the sound"


def load_audio(path: str | Path) -> Audio:
    """Read WAV, FLAC, OGG or another format of libsndfile; the channels are averaged.

    Raises `UserFacingError` when the file is missing, not a file, empty, truncated, not audio, shorter than
    0.05 s, longer than an hour, or holds samples that are not finite.
    """
    path = Path(path)
    if not path.exists():
        raise UserFacingError(f"There is no audio file '{path}'.")
    if not path.is_file():
        raise UserFacingError(f"'{path}' is not a file.", "Name a WAV, FLAC or OGG file.")
    if path.stat().st_size == 0:
        raise UserFacingError(f"The audio file '{path}' is empty.")
    try:
        path.open("rb").close()  # says why, where libsndfile does not
        # by name: a Python file would be read through callbacks, and those swallow Ctrl-C
        return _read(os.fsencode(path), f"'{path}'", path)
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error


def audio_from_bytes(data: bytes, name: str = "the embedded sound") -> Audio:
    """Read sound from the bytes of an audio file, such as `encode_flac` makes; raises as `load_audio` does."""
    return _read(io.BytesIO(data), name, None)


def audio_from_kept(data: bytes, name: str, path: Path | None) -> Audio:
    """Inverse of `Audio.kept`, for sound that once came from ``path``; raises as `load_audio` does."""
    audio = replace(audio_from_bytes(data, name), path=path)
    audio.__dict__["kept"] = data  # another version of the encoder might make other bytes of it
    return audio


def _read(file: BinaryIO | bytes, name: str, path: Path | None) -> Audio:
    try:
        with soundfile.SoundFile(file) as sound:
            return Audio(_mono(sound, name), sound.samplerate, path)
    # TypeError: the name ends in .raw, and soundfile asks for the format it cannot know
    except (soundfile.SoundFileError, TypeError) as error:
        raise UserFacingError(
            f"{name} is not sound that can be read, or it is damaged.", "Use a WAV, FLAC or OGG file."
        ) from error


def _mono(sound: soundfile.SoundFile, name: str) -> np.ndarray:
    lowest, highest = RATES_HZ
    if not lowest <= sound.samplerate <= highest:
        raise UserFacingError(
            f"{name} has a rate of {sound.samplerate} Hz.", f"Rates from {lowest} to {highest} Hz can be read."
        )
    duration_s = sound.frames / sound.samplerate
    if duration_s < SHORTEST_S:
        raise UserFacingError(f"{name} lasts {duration_s:.3f} s; at least {SHORTEST_S} s of sound is needed.")
    if duration_s > LONGEST_S:
        raise UserFacingError(f"{name} lasts {duration_s / 60:.0f} min; at most {LONGEST_S / 60:.0f} min can be read.")
    samples = np.empty(sound.frames, np.float32)
    n_read = 0
    # In blocks, so that the channels of a long take are never in memory together.
    while len(block := sound.read(_BLOCK_FRAMES, dtype="float32", always_2d=True)):
        if not np.isfinite(block).all():
            raise UserFacingError(
                f"{name} holds samples that are not finite numbers, near {n_read / sound.samplerate:.2f} s."
            )
        samples[n_read : n_read + len(block)] = block.mean(axis=1)
        n_read += len(block)
    if n_read < sound.frames or _lost_its_end(sound.extra_info):
        raise UserFacingError(
            f"{name} is truncated: it breaks off after {n_read / sound.samplerate:.2f} s.", "Copy or export it again."
        )
    return samples


def _lost_its_end(log: str) -> bool:
    promised = _PROMISED_BYTES.search(log)
    missing_bytes = int(promised[1]) - int(promised[2]) if promised and int(promised[1]) < _STREAMED_BYTES else 0
    return missing_bytes > _PADDING_BYTES or any(loss in log for loss in _OTHER_LOSSES)


def resampled(audio: Audio, rate_hz: int) -> Audio:
    """Return the same sound at ``rate_hz``, band-limited (soxr, high quality)."""
    if rate_hz == audio.rate_hz:
        return audio
    return Audio(soxr.resample(audio.samples, audio.rate_hz, rate_hz), rate_hz, audio.path)


def write_wav(audio: Audio, path: str | Path) -> None:
    """Write 16-bit WAV; louder than full scale is clipped. Raises `UserFacingError` when it cannot be written."""
    with swapped_in(path) as beside:
        beside.touch()  # says why it cannot be written, where libsndfile does not
        soundfile.write(
            os.fsencode(beside), np.clip(audio.samples, -1, 1), audio.rate_hz, format="WAV", subtype="PCM_16"
        )


def encode_flac(audio: Audio, subtype: str = "PCM_16") -> bytes:
    """Return the sound as the bytes of a FLAC file, for keeping inside a database or a project."""
    return _encoded(audio, "FLAC", subtype)


def _encoded(audio: Audio, container: str, subtype: str) -> bytes:
    buffer = io.BytesIO()
    soundfile.write(buffer, np.clip(audio.samples, -1, 1), audio.rate_hz, format=container, subtype=subtype)
    return buffer.getvalue()
