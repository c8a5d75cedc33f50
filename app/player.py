"""The transport: what time it is in the speech that plays, by the clock of the sound that is heard."""

from __future__ import annotations

import logging
import time
from typing import Protocol

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from app.jobs import JobRunner
from app.texts import SOUND_LOST, SOUND_MISSING
from core.media.audio import Audio, resampled
from core.progress import Progress

log = logging.getLogger("sound")

_TICK_MS = 16


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

    def __init__(self, start_s: float) -> None:
        self._start_s, self._began_s = start_s, time.perf_counter()

    def now_s(self) -> float:
        """See `Clock.now_s`."""
        return self._start_s + time.perf_counter() - self._began_s

    def stop(self) -> None:
        """See `Clock.stop`."""


class SoundClock:
    """Plays through the default output device; its time is the stream's, less what has not been heard yet.

    Raises `OSError` or ``sounddevice.PortAudioError`` when there is no device.
    """

    def __init__(self, audio: Audio, start_s: float) -> None:
        import sounddevice

        device = sounddevice.query_devices(kind="output")
        self._audio = resampled(audio, round(device["default_samplerate"]))
        self._start_s = start_s
        self._next = int(start_s * self._audio.rate_hz)
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
            return self._start_s
        heard_at, time_s = self._mark
        return max(self._start_s, time_s + self._stream.time - heard_at)

    def stop(self) -> None:
        """See `Clock.stop`."""
        self._stopping = True
        self._stream.close()

    def _fill(self, out: np.ndarray, n_frames: int, times, _status) -> None:
        # some hosts leave the time at which the block is heard at 0
        heard_at = times.outputBufferDacTime or times.currentTime + self._stream.latency
        self._mark = heard_at, self._next / self._audio.rate_hz
        block = self._audio.samples[self._next : self._next + n_frames]
        out[: len(block), 0] = block
        out[len(block) :] = 0.0
        self._next += n_frames

    def _on_finished(self) -> None:
        self.lost = not self._stopping


class Player(QObject):
    """Plays one sound, or silence of its length; ``moved`` says where, sixty times a second.

    moved(seconds), playing_changed(bool) : for the panes; noted(sentence) : for the status bar
    """

    moved = Signal(float)
    playing_changed = Signal(bool)
    noted = Signal(str)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self._audio: Audio | None = None
        self._position_s = 0.0
        self._clock: Clock | None = None
        self._playing = False
        self._tick = QTimer(self)
        self._tick.setInterval(_TICK_MS)
        self._tick.timeout.connect(self._on_tick)

    @property
    def is_playing(self) -> bool:
        """Whether it plays."""
        return self._playing

    @property
    def duration_s(self) -> float:
        """Length of what can be played."""
        return 0.0 if self._audio is None else self._audio.duration_s

    def set_audio(self, audio: Audio | None) -> None:
        """Play something else from now on."""
        if audio is not self._audio:
            self.pause()
            self._audio, self._position_s = audio, 0.0

    def play(self) -> None:
        """Play on from where it stands, or from the start when it stands at the end."""
        if self._audio is None or self._playing:
            return
        if self._position_s >= self.duration_s - 1e-3:
            self._position_s = 0.0
        self._playing = True
        self.playing_changed.emit(True)
        self._begin()

    def pause(self) -> None:
        """Stop where it is."""
        if not self._playing:
            return
        self._playing = False
        self._end_clock()
        self._tick.stop()
        self.playing_changed.emit(False)

    def toggle(self) -> None:
        """Play or pause."""
        if self._playing:
            self.pause()
        else:
            self.play()

    def seek(self, time_s: float) -> None:
        """Go to ``time_s``; it plays on if it played."""
        self._position_s = min(max(time_s, 0.0), self.duration_s)
        if self._playing:
            self._end_clock()
            self._begin()

    def _begin(self) -> None:
        # a sound server can take a tenth of a second to open a stream
        request = (self._audio, self._position_s)
        self._jobs.start("sound", "", request, _open_clock, self._on_clock, discarded=_stop_clock)

    def _on_clock(self, answer: tuple[Clock, str]) -> None:
        clock, note = answer
        if not self._playing:
            clock.stop()
            return
        self._clock = clock
        if note:
            self.noted.emit(note)
        self._tick.start()

    def _end_clock(self) -> None:
        self._jobs.cancel("sound")
        if self._clock is not None:
            self._clock.stop()
            self._clock = None

    def _on_tick(self) -> None:
        if self._clock is None:
            return
        if self._clock.lost:
            self._clock.stop()
            self._clock = TimerClock(self._position_s)
            self.noted.emit(SOUND_LOST)
        self._position_s = min(self._clock.now_s(), self.duration_s)
        self.moved.emit(self._position_s)
        if self._position_s >= self.duration_s:
            self.pause()


def _open_clock(request: tuple[Audio, float], _progress: Progress) -> tuple[Clock, str]:
    audio, start_s = request
    try:
        import sounddevice

        clock = SoundClock(audio, start_s)
    except OSError as error:  # no PortAudio library
        return _without_sound(start_s, error)
    except sounddevice.PortAudioError as error:
        return _without_sound(start_s, error)
    return clock, ""


def _stop_clock(answer: tuple[Clock, str]) -> None:
    answer[0].stop()


def _without_sound(start_s: float, error: Exception) -> tuple[Clock, str]:
    log.info("no sound: %s", error)
    return TimerClock(start_s), SOUND_MISSING
