"""A microphone as a source of live sound; another process listens (`app.live.microphone_child`)."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.live.microphone_child import BLOCK_HEAD, MESSAGE_HEAD
from app.live.source import Block, SourceLost
from app.texts import live as texts
from core.progress import SILENT, Progress

_CHILD = [sys.executable, "-m", "app.live.microphone_child"]
_LIST_LIMIT_S = 20.0


@dataclass(frozen=True)
class InputDevice:
    """A device that hears, as PortAudio names it; ``host`` is the interface that it is reached through."""

    name: str
    host: str
    is_default: bool = False


def input_devices(_request: object = None, _progress: Progress = SILENT) -> tuple[InputDevice, ...]:
    """Return the devices that hear at this moment; a job.

    Raises `UserFacingError` where there is no PortAudio library, or the sound system does not answer.
    """
    try:
        done = subprocess.run([*_CHILD, "list"], capture_output=True, timeout=_LIST_LIMIT_S, check=True)
        return tuple(InputDevice(**entry) for entry in json.loads(done.stdout))
    except (subprocess.SubprocessError, ValueError) as error:
        raise SourceLost(texts.NO_SOUND_SYSTEM, texts.NO_SOUND_SYSTEM_REMEDY) from error


class Microphone:
    """The default input device, or the one that is named; a `Source`."""

    def __init__(self, device: InputDevice | None = None) -> None:
        self.name = texts.DEFAULT_DEVICE if device is None else device.name
        self.rate_hz = 0
        self._wish = ("", "") if device is None else (device.name, device.host)
        self._process: subprocess.Popen | None = None
        self._closed = False

    def blocks(self) -> Iterator[Block]:
        """See `Source.blocks`; raises `SourceLost` when the device cannot be opened, and when it goes away."""
        with subprocess.Popen(
            [*_CHILD, "open", *self._wish], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        ) as self._process:
            try:
                yield from self._heard(self._process.stdout)
            finally:
                self._process.kill()

    def _heard(self, pipe) -> Iterator[Block]:
        while not self._closed:
            head = pipe.read(MESSAGE_HEAD.size)
            if len(head) < MESSAGE_HEAD.size:  # the process ended without a word
                if self._closed:
                    return
                raise SourceLost(texts.DEVICE_LOST.format(device=self.name), texts.DEVICE_LOST_REMEDY)
            kind, length = MESSAGE_HEAD.unpack(head)
            data = pipe.read(length)
            if kind == b"O":
                self.rate_hz = json.loads(data)["rate_hz"]
            elif kind == b"E":
                why = data.decode("utf-8", "replace").rstrip(".")
                raise SourceLost(texts.DEVICE_REFUSED.format(device=self.name, why=why), texts.DEVICE_LOST_REMEDY)
            elif kind == b"L":
                raise SourceLost(texts.DEVICE_LOST.format(device=self.name), texts.DEVICE_LOST_REMEDY)
            else:
                arrived_s, age_s, overflowed = BLOCK_HEAD.unpack(data[: BLOCK_HEAD.size])
                samples = np.frombuffer(data, np.float32, offset=BLOCK_HEAD.size)
                yield Block(samples, arrived_s, arrived_s - age_s, overflowed)

    def close(self) -> None:
        """See `Source.close`."""
        self._closed = True
        if self._process is not None:
            with contextlib.suppress(OSError):
                self._process.kill()
