"""A live session: sound from a source becomes frames, in a thread of its own; it outlives the devices it listens to."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from app.live.outgoing import Outgoing
from app.live.priority import be_served_first
from app.live.source import Block, Source
from app.live.take import Recorder, Take
from core.errors import UserFacingError
from core.iface.listening import DropoutWatch, LevelMeter
from core.iface.live import NEUTRAL, LiveFace, LiveFrame
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ

log = logging.getLogger("live")

_KEPT_FRAMES = 20 * 60 * RATE_HZ  # figures are of the last twenty minutes
_END_LIMIT_S = 5.0


@dataclass(frozen=True, eq=False)
class TimedFrame:
    """A frame, and when what it shows was said; times by `time.perf_counter`.

    said_s : when the sound at the frame's time was in the air, as far as the device tells; made_s : when it was made
    look_ahead_s : the part of the wait between the two that the face asks for; less than its look-ahead for a frame
        whose last window of sound ends before it
    """

    live: LiveFrame
    said_s: float
    made_s: float
    look_ahead_s: float

    @property
    def capture_s(self) -> float:
        """The part of the wait for sound that is no look-ahead: the device's buffer, its blocks, the resampler's."""
        return self.made_s - self.said_s - self.look_ahead_s - self.live.compute_s


class LiveSession:
    """Runs a face on one source after the other.

    emotion, intensity : what is asked for; they stay from source to source
    level : of the sound that comes in, or None before the first
    n_overflows : how often a device told of lost sound; drops : what was lost without a word, of this source
    """

    def __init__(
        self,
        face: SpeakingFace,
        heard: Callable[[TimedFrame], None],
        ended: Callable[[UserFacingError | None], None],
    ) -> None:
        """Take what is called, in the session's own thread, with each frame, and when a source ended or was lost."""
        self.face = face
        self._heard, self._ended = heard, ended
        self.emotion, self.intensity = NEUTRAL, 1.0
        self.outgoing: Outgoing | None = None
        self.level: LevelMeter | None = None
        self.drops: DropoutWatch | None = None
        self.n_overflows = self.n_clipped = self.n_faulty = self.n_frames = self.n_samples = 0
        self.last_block_s, self._n_sent_before = 0.0, 0
        self.waits: deque[tuple[float, float, float, float]] = deque(maxlen=_KEPT_FRAMES)
        self._source: Source | None = None
        self._thread: threading.Thread | None = None
        self._recorder: Recorder | None = None
        self._lock = threading.Lock()  # between the two threads that a recording belongs to

    # What is asked from other threads

    @property
    def is_running(self) -> bool:
        """Whether it listens."""
        return self._thread is not None and self._thread.is_alive()

    def start(self, source: Source, records: bool = False) -> None:
        """Listen to ``source`` from now on, instead of the one before; ``records`` from its first sample on."""
        self.stop()
        self._source, self.last_block_s = source, time.perf_counter()
        self._thread = threading.Thread(target=self._run, args=(source, records), name="live", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Listen no more; returns when the source is let go. A recording can be taken afterwards."""
        source, thread, self._source = self._source, self._thread, None
        if source is not None:
            source.close()
        if thread is not None and thread is not threading.current_thread():
            thread.join(_END_LIMIT_S)

    def ask(self, emotion: str, intensity: float) -> None:
        """Let the face go to an emotion at an intensity, 0..1; one that it does not have leaves it as it is."""
        if emotion == NEUTRAL or emotion in self.face.expressions:
            self.emotion, self.intensity = emotion, intensity

    def record(self) -> None:
        """Begin to record, from the next tenth of a second on."""
        with self._lock:
            if self.level is not None and self.is_running:
                self._recorder = Recorder(self._source.rate_hz, self.n_samples)

    @property
    def recorded_s(self) -> float | None:
        """Length of the recording that runs, or that ended with its device; None when there is none."""
        recorder = self._recorder
        return None if recorder is None else recorder.duration_s

    @property
    def recording_is_full(self) -> bool:
        """Whether the recording takes no more."""
        recorder = self._recorder
        return recorder is not None and recorder.is_full

    def end_recording(self) -> Take | None:
        """Return what was recorded, None when nothing is; raises `UserFacingError` when it is next to nothing."""
        with self._lock:
            recorder, self._recorder = self._recorder, None
        return None if recorder is None else recorder.take()

    def send_to(self, outgoing: Outgoing | None) -> None:
        """Send each frame to another program from now on, or none."""
        before, self.outgoing = self.outgoing, outgoing
        if before is not None:
            self._n_sent_before += before.n_sent
            before.close()

    def figures(self) -> dict[str, object]:
        """Return counts and waits of the frames so far, waits in milliseconds: {median, p99, longest} each."""
        parts = np.array(self.waits or [(np.nan,) * 4]) * 1000.0
        drops = self.drops
        return {
            "frames": self.n_frames,
            "waits_ms": {
                name: {"median": float(np.median(column)), "p99": float(np.percentile(column, 99)),
                       "longest": float(column.max())}
                for name, column in zip(("capture", "look_ahead", "compute", "total"), parts.T)
            } if self.waits else None,
            "overflows": self.n_overflows,
            "dropouts": 0 if drops is None else drops.dropouts,
            "lost_ms": 0.0 if drops is None else 1000.0 * drops.lost_s,
            "clipped_samples": self.n_clipped, "faulty_samples": self.n_faulty,
            "sent": self._n_sent_before + (0 if self.outgoing is None else self.outgoing.n_sent),
        }  # fmt: skip

    # The session's own thread

    def _run(self, source: Source, records: bool) -> None:
        be_served_first()
        failure: UserFacingError | None = None
        live: LiveFace | None = None
        began_s = 0.0  # when the first sample was in the air
        try:
            for block in source.blocks():
                if live is None:
                    live = LiveFace(self.face, source.rate_hz, self.emotion, self.intensity)
                    with self._lock:
                        self.level, self.drops = LevelMeter(source.rate_hz), DropoutWatch(source.rate_hz)
                        self.n_samples = 0
                        self._recorder = Recorder(source.rate_hz, 0) if records else None
                began_s = self._take(live, block, source.rate_hz)
            if live is not None and self._source is source:  # it ended by itself
                self._finish(live, began_s)
        except UserFacingError as error:
            failure = error
        except OSError as error:  # no process can be started, or its pipe broke
            failure = UserFacingError(str(error))
        if self._source is source:
            self._source = None
            self._ended(failure)

    def _take(self, live: LiveFace, block: Block, rate_hz: int) -> float:
        self.last_block_s = block.arrived_s
        self.n_overflows += block.overflowed
        clipped = self.level.clipped
        self.level.accept(block.samples)
        self.n_clipped += self.level.clipped - clipped
        self.drops.accept(len(block.samples), block.arrived_s)
        if live.asked != (wish := _wish(self.emotion, self.intensity)):
            live.ask(*wish)
        faulty = live.faulty
        frames = live.accept(block.samples)
        made_s = time.perf_counter()
        self.n_faulty += live.faulty - faulty
        with self._lock:
            if self._recorder is not None:
                self._recorder.accept(block.samples, frames)
            self.n_samples += len(block.samples)
        began_s = block.captured_s - self.n_samples / rate_hz
        self._give(frames, began_s, made_s)
        return began_s

    def _finish(self, live: LiveFace, began_s: float) -> None:
        frames = live.finish()
        made_s = time.perf_counter()
        with self._lock:
            if self._recorder is not None:
                self._recorder.accept(np.zeros(0, np.float32), frames)
        self._give(frames, began_s, made_s)

    def _give(self, frames: list[LiveFrame], began_s: float, made_s: float) -> None:
        ahead_s = self.face.n_ahead / RATE_HZ
        for frame in frames:
            said_s = began_s + frame.time_s
            asked_s = min(ahead_s, made_s - frame.compute_s - said_s)
            timed = TimedFrame(frame, said_s, made_s, asked_s)
            self.waits.append((timed.capture_s, asked_s, frame.compute_s, made_s - said_s))
            self.n_frames += 1
            self._heard(timed)
        outgoing = self.outgoing
        if outgoing is not None:
            for frame in frames:
                outgoing.send(frame.positions)


def _wish(emotion: str, intensity: float) -> tuple[str, float]:
    """What a `LiveFace` says that it was asked for."""
    return emotion, 0.0 if emotion == NEUTRAL else float(np.clip(intensity, 0.0, 1.0))
