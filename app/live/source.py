"""Where live sound comes from: the protocol of a source, and a file that plays at the pace of real time."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from core.errors import UserFacingError
from core.media.audio import Audio, load_audio

BLOCK_S = 0.010


class SourceLost(UserFacingError):
    """The device went away, or cannot be opened; the session can go on with another."""


@dataclass(frozen=True, eq=False)
class Block:
    """A stretch of sound as it came.

    samples : float32, shape (n,), -1..1
    arrived_s : when it was handed over; captured_s : when its last sample was in the air, as far as the device tells;
        both by `time.perf_counter`
    overflowed : whether the device says that sound was lost before it
    """

    samples: np.ndarray
    arrived_s: float
    captured_s: float
    overflowed: bool = False


class Source(Protocol):
    """Sound in blocks. ``name`` is what messages call it; ``rate_hz`` is known once `blocks` gave its first one."""

    name: str
    rate_hz: int

    def blocks(self) -> Iterator[Block]:
        """Yield blocks until the sound ends or `close` is called; raises `SourceLost`."""

    def close(self) -> None:
        """End `blocks`, from any thread."""


class FileSource:
    """A sound file, or sound at hand, that comes as from a microphone: 10 ms at a time, when they are due.

    repeats : begin anew at the end, for ever
    """

    def __init__(self, sound: Path | Audio, repeats: bool = False) -> None:
        """Raises `UserFacingError` for a file that is no sound."""
        audio = sound if isinstance(sound, Audio) else load_audio(sound)
        self.name, self.rate_hz = audio.name, audio.rate_hz
        self._samples, self._repeats = audio.samples, repeats
        self._closed = threading.Event()

    def blocks(self) -> Iterator[Block]:
        """See `Source.blocks`."""
        began_s, n, step = time.perf_counter(), 0, max(1, round(BLOCK_S * self.rate_hz))
        while self._repeats or n < len(self._samples):
            first = n % len(self._samples)
            samples = self._samples[first : first + step]
            n += len(samples)
            due_s = began_s + n / self.rate_hz
            if self._closed.wait(max(0.0, due_s - time.perf_counter())):
                return
            yield Block(samples, time.perf_counter(), due_s)

    def close(self) -> None:
        """See `Source.close`."""
        self._closed.set()
