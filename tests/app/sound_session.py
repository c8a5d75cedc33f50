"""Plays through the sound server that PULSE_SERVER names, beside its own recorder.

A process of its own, since PortAudio looks for devices once; `test_drift` runs it:
``python sound_session.py drift SECONDS`` or ``loss SERVER_PID``.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np

RATE_HZ = 48_000
CLICK_EVERY_S = 2.5
CHUNK_S = 0.005


def speech_with_clicks(duration_s: float):
    """A demo sentence over and over, quiet, and a click every 2.5 s; returns (sound, times of the clicks)."""
    from core.actress.corpus import demo_sentences
    from core.media.audio import Audio, load_audio, resampled

    spoken = resampled(load_audio(demo_sentences()[0].audio), RATE_HZ).samples
    n = round(duration_s * RATE_HZ)
    samples = 0.3 * np.resize(spoken, n).astype(np.float32)
    at_s = np.arange(CLICK_EVERY_S, duration_s - CLICK_EVERY_S / 2, CLICK_EVERY_S)
    for s in at_s:
        first = round(s * RATE_HZ)
        samples[first - 240 : first + 240] = 0.0
        samples[first : first + 24] = 1.0
    return Audio(samples, RATE_HZ), at_s


class Recorder:
    """Listens to the monitor and notes when each piece arrived."""

    def __init__(self) -> None:
        self.pieces: list[bytes] = []
        self.arrivals: list[tuple[int, float]] = []
        self._process = subprocess.Popen(
            ["parec", "-d", "out.monitor", "--format=s16le", f"--rate={RATE_HZ}", "--channels=1", "--latency-msec=5"],
            stdout=subprocess.PIPE,
        )  # fmt: skip
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    def _listen(self) -> None:
        n = 0
        while piece := os.read(self._process.stdout.fileno(), 1 << 16):
            self.pieces.append(piece)
            n += len(piece)
            self.arrivals.append((n // 2, time.perf_counter()))

    def stop(self) -> tuple[np.ndarray, np.ndarray]:
        """Return samples, and (samples so far, time) of each arrival."""
        self._process.terminate()
        self._process.wait()
        self._thread.join(5)
        data = b"".join(self.pieces)
        return np.frombuffer(data[: len(data) // 2 * 2], np.int16) / 32768, np.array(self.arrivals)


def drift(duration_s: float) -> dict:
    """Play, record, and compare the clock with what is heard, click by click."""
    from app.sound import Passage, SoundClock

    audio, click_s = speech_with_clicks(duration_s)
    recorder = Recorder()
    time.sleep(1.0)
    clock = SoundClock(audio, Passage(0.0))
    readings = []
    end = time.perf_counter() + duration_s + 0.5
    while time.perf_counter() < end:
        readings.append((time.perf_counter(), clock.now_s()))
        time.sleep(CHUNK_S)
    lost = clock.lost
    clock.stop()
    time.sleep(0.5)
    samples, arrivals = recorder.stop()
    readings = np.array(readings)
    late_s = []
    heard = np.flatnonzero(np.abs(samples) > 0.6)
    heard = heard[np.diff(heard, prepend=-RATE_HZ) > RATE_HZ / 10]
    # a sample was heard when it can have arrived at the earliest; pieces before and after tell when that was
    begun_s = arrivals[:, 1] - arrivals[:, 0] / RATE_HZ
    for index in heard:
        near = np.abs(arrivals[:, 0] - index) < 5 * RATE_HZ
        at = begun_s[near].min() + index / RATE_HZ
        late_s.append(np.interp(at, readings[:, 0], readings[:, 1]))
    return {"clicks": click_s.tolist(), "clock": late_s, "lost": bool(lost)}


def loss(server: int) -> dict:
    """Play in a player, take the server away, and see where the playhead goes."""
    from PySide6.QtCore import QCoreApplication, QEventLoop, QTimer

    from app.jobs import JobRunner
    from app.player import Player

    app = QCoreApplication([])
    jobs = JobRunner()
    player = Player(jobs)
    noted: list[str] = []
    player.noted.connect(noted.append)

    def live(seconds: float) -> None:
        loop = QEventLoop()
        QTimer.singleShot(round(1000 * seconds), loop.quit)
        loop.exec()

    audio, _ = speech_with_clicks(20.0)
    player.set_audio(audio)
    player.play()
    live(2.0)
    sounded = type(player._clock).__name__
    before_s = player._position_s
    os.kill(server, signal.SIGKILL)
    live(4.0)
    answer = {"clock": sounded, "before_s": before_s, "after_s": player._position_s, "noted": noted,
              "playing": player.is_playing, "then": type(player._clock).__name__}  # fmt: skip
    player.pause()
    jobs.shut_down()
    app.quit()
    return answer


if __name__ == "__main__":
    done = drift(float(sys.argv[2])) if sys.argv[1] == "drift" else loss(int(sys.argv[2]))
    print(json.dumps(done))
    sys.stdout.flush()
    os._exit(0)  # PortAudio does not come back from a server that was killed
