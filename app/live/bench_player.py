"""Plays a sound through the default output in a process of its own and tells when each part was handed over.

``python -m app.live.bench_player FILE`` prints ``{"handed_over": [[samples, time], ...], "underflows": n}`` at the end,
how many samples had been given before each block, and `time.perf_counter` then, which processes of one machine share.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from pathlib import Path

_BLOCK_S = 0.010


def play(path: Path) -> dict[str, object]:
    """Play to the end; returns what is printed."""
    import sounddevice

    from app.live.priority import be_served_first
    from core.media.audio import load_audio

    audio = load_audio(path)
    given: list[tuple[int, float]] = []
    underflows, n, done = 0, 0, threading.Event()

    def fill(out, n_frames, _times, status) -> None:
        nonlocal underflows, n
        given.append((n, time.perf_counter()))
        underflows += bool(status.output_underflow)
        part = audio.samples[n : n + n_frames]
        out[:, 0] = 0.0
        out[: len(part), 0] = part
        n += n_frames
        if len(part) < n_frames:
            done.set()

    be_served_first()  # a player that is late would be counted as ours
    with sounddevice.OutputStream(
        samplerate=audio.rate_hz, channels=1, dtype="float32", blocksize=round(_BLOCK_S * audio.rate_hz), latency="low",
        callback=fill,
    ):  # fmt: skip
        done.wait()
        time.sleep(0.5)
    return {"handed_over": given, "underflows": underflows}


if __name__ == "__main__":
    print(json.dumps(play(Path(sys.argv[1]))))
    sys.stdout.flush()
    os._exit(0)
