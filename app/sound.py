"""Clocks that playback follows: the sound that is heard, or a timer where there is none; and the sound of scrubbing."""

from __future__ import annotations

import logging
import time
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from app.texts import SOUND_MISSING
from core.media.audio import Audio, resampled
from core.progress import Progress

log = logging.getLogger("sound")

# A scrub runs after the pointer like a tape under a hand: it arrives after about this long, at twice the speed at most.
_SCRUB_REACH_S = 0.06
_SCRUB_SPEED = 2.0


@dataclass(frozen=True)
class Passage:
    """What is played: from where, how fast, and what is repeated.

    speed : 1 as recorded, negative backwards
    loop : (start_s, end_s) to repeat, or None; only forwards
    """

    start_s: float
    speed: float = 1.0
    loop: tuple[float, float] | None = None

    def at(self, elapsed_s: np.ndarray | float) -> np.ndarray | float:
        """Return the time of the speech, seconds, that is heard ``elapsed_s`` after the start."""
        time_s = self.start_s + self.speed * elapsed_s
        if self.loop is None or self.speed < 0:
            return time_s
        first_s, end_s = self.loop
        wrapped = first_s + np.mod(np.subtract(time_s, first_s), end_s - first_s)
        return np.where(np.less(time_s, end_s), time_s, wrapped)


class Clock(Protocol):
    """Tells where playback is."""

    lost: bool

    def now_s(self) -> float:
        """Seconds of the speech that are heard now."""

    def stop(self) -> None:
        """Stop for good."""


class TimerClock:
    """Goes on without sound."""

    lost = False

    def __init__(self, passage: Passage) -> None:
        self._passage, self._began_s = passage, time.perf_counter()

    def now_s(self) -> float:
        """See `Clock.now_s`."""
        return float(self._passage.at(time.perf_counter() - self._began_s))

    def stop(self) -> None:
        """See `Clock.stop`."""


class SoundClock:
    """Plays through the default output device; its time is the stream's, less what has not been heard yet.

    Raises `OSError` or ``sounddevice.PortAudioError`` when there is no device.
    """

    def __init__(self, audio: Audio, passage: Passage) -> None:
        import sounddevice

        device = sounddevice.query_devices(kind="output")
        self._audio = resampled(audio, round(device["default_samplerate"]))
        self._passage = passage
        self._n_given = 0
        self._mark: tuple[float, float] | None = None
        self._stopping = False
        self.lost = False
        self._stream = sounddevice.OutputStream(
            samplerate=self._audio.rate_hz, channels=1, dtype="float32", callback=self._fill,
            finished_callback=self._on_finished,
        )  # fmt: skip
        self._stream.start()

    def now_s(self) -> float:
        """See `Clock.now_s`."""
        if self._mark is None:
            return self._passage.start_s
        heard_at, elapsed_s = self._mark
        return float(self._passage.at(max(elapsed_s + self._stream.time - heard_at, 0.0)))

    def stop(self) -> None:
        """See `Clock.stop`."""
        self._stopping = True
        self._stream.close()

    def _fill(self, out: np.ndarray, n_frames: int, times, _status) -> None:
        # some hosts leave the time at which the block is heard at 0
        heard_at = times.outputBufferDacTime or times.currentTime + self._stream.latency
        rate_hz = self._audio.rate_hz
        self._mark = heard_at, self._n_given / rate_hz
        places = self._passage.at((self._n_given + np.arange(n_frames)) / rate_hz) * rate_hz
        out[:, 0] = samples_at(self._audio.samples, places)
        self._n_given += n_frames

    def _on_finished(self) -> None:
        self.lost = not self._stopping


class ScrubSound:
    """What is heard while the playhead is dragged: the sound runs after it, and falls silent when it rests.

    Raises `OSError` or ``sounddevice.PortAudioError`` when there is no device.
    """

    def __init__(self, audio: Audio, time_s: float) -> None:
        import sounddevice

        device = sounddevice.query_devices(kind="output")
        self._tape = Tape(resampled(audio, round(device["default_samplerate"])), time_s)
        self._stream = sounddevice.OutputStream(
            samplerate=self._tape.rate_hz, channels=1, dtype="float32", callback=self._fill
        )
        self._stream.start()

    def move(self, time_s: float) -> None:
        """Run to another moment."""
        self._tape.target_s = time_s

    def stop(self) -> None:
        """Stop for good."""
        self._stream.close()

    def _fill(self, out: np.ndarray, n_frames: int, _times, _status) -> None:
        out[:, 0] = self._tape.read(n_frames)


class Tape:
    """Reads a sound at the speed at which a target is approached.

    target_s : where to; may change at any time
    """

    def __init__(self, audio: Audio, time_s: float) -> None:
        self._samples, self.rate_hz = audio.samples, audio.rate_hz
        self._place = time_s * audio.rate_hz
        self.target_s = time_s

    def read(self, n: int) -> np.ndarray:
        """Return the next ``n`` samples, float32; zero where the target is reached."""
        away = self.target_s * self.rate_hz - self._place
        speed = np.clip(away / (_SCRUB_REACH_S * self.rate_hz), -_SCRUB_SPEED, _SCRUB_SPEED)
        places = self._place + speed * np.arange(1, n + 1)
        self._place = float(places[-1])
        # slower than a tenth of the recorded speed there is only a rumble
        return samples_at(self._samples, places) * np.float32(min(abs(speed) / 0.1, 1.0) if abs(speed) > 0.02 else 0.0)


def samples_at(samples: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return what is at ``places``, in samples, between two of them linearly; silence outside; float32."""
    # places at the recorded speed are whole but for rounding, and shall give the recorded samples
    places = np.round(np.asarray(places, float), 6)
    low = np.floor(places).astype(np.int64)
    inside = (low >= 0) & (low < len(samples))
    low = np.where(inside, low, 0)
    share = (places - np.floor(places)).astype(np.float32)
    following = samples[np.minimum(low + 1, len(samples) - 1)]
    return np.where(inside, samples[low] + share * (following - samples[low]), np.float32(0.0)).astype(np.float32)


def open_clock(request: tuple[Audio, Passage], _progress: Progress) -> tuple[Clock, str]:
    """Return a clock that sounds, or one that does not and a sentence that says so; a job."""
    audio, passage = request
    try:
        import sounddevice

        clock = SoundClock(audio, passage)
    except OSError as error:  # no PortAudio library
        return _without_sound(passage, error)
    except sounddevice.PortAudioError as error:
        return _without_sound(passage, error)
    return clock, ""


def open_scrub(request: tuple[Audio, float], _progress: Progress) -> ScrubSound | None:
    """Return the sound of scrubbing, or None where there is no device; a job."""
    audio, time_s = request
    try:
        import sounddevice

        return ScrubSound(audio, time_s)
    except OSError:
        return None
    except sounddevice.PortAudioError:
        return None


def _without_sound(passage: Passage, error: Exception) -> tuple[Clock, str]:
    log.info("no sound: %s", error)
    return TimerClock(passage), SOUND_MISSING
