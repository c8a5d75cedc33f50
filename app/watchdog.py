"""Watches how long the main thread keeps the window waiting, and what it does meanwhile."""

from __future__ import annotations

import contextlib
import faulthandler
import os
import re
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer

BEAT_S = 0.005
# from here on the stack of the main thread is looked at
_LOOK_AFTER_S = 0.05
_LOOK_EVERY_S = 0.01
_DEPTH = 3
_LINE = re.compile(r'File "(.+)", line (\d+) in (\S+)')
_OURS = ("app", "core", "gpu")


@dataclass(frozen=True)
class Block:
    """A while in which the main thread answered nothing.

    action : what the animator was doing
    wall_s : how long; of that the main thread computed for cpu_s, and for queued_s it was ready to but the machine's
        processors did other things (0 where the system does not tell). The rest it waited for Python's lock, the
        graphics driver's threads or the display
    where : innermost function that it was in, and those of ours that called it; empty for a short one
    """

    action: str
    wall_s: float
    cpu_s: float
    queued_s: float
    where: str

    @property
    def own_s(self) -> float:
        """How long it would have been on a machine with a processor to spare for the main thread."""
        return max(self.wall_s - self.queued_s, 0.0)


class _MainThreadTimes:
    """What the thread that makes it has computed and queued for so far; read and closed by that thread."""

    def __init__(self) -> None:
        self._schedule = None
        with contextlib.suppress(OSError, AttributeError):
            self._schedule = os.open(f"/proc/self/task/{threading.get_native_id()}/schedstat", os.O_RDONLY)

    def read(self) -> tuple[float, float, float]:
        """Return now, computed and queued, in s."""
        queued_ns = 0 if self._schedule is None else int(os.pread(self._schedule, 64, 0).split()[1])
        return time.perf_counter(), time.thread_time(), 1e-9 * queued_ns

    def close(self) -> None:
        """End."""
        if self._schedule is not None:
            os.close(self._schedule)


class Watchdog(QObject):
    """A heart that beats every 5 ms on the main thread, and a thread that looks when it is late.

    action : what is being done now; the next late beats are put down to it
    blocks : one for each beat
    """

    def __init__(self) -> None:
        super().__init__()
        self.action = ""
        self.blocks: list[Block] = []
        self._where: dict[str, int] = {}
        self._main = threading.get_ident()
        self._times = _MainThreadTimes()
        self._stop = threading.Event()
        self._dump = tempfile.TemporaryFile("w+", encoding="utf-8")  # noqa: SIM115  closed by `stop`
        self._beat = QTimer(self, interval=round(1000 * BEAT_S))
        self._beat.setTimerType(Qt.TimerType.PreciseTimer)
        self._beat.timeout.connect(self._on_beat)
        self._looker = threading.Thread(target=self._look, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._last = self._times.read()
        self._beat.start()
        self._looker.start()

    def stop(self) -> None:
        """End."""
        self._stop.set()
        self._looker.join()
        self._dump.close()
        self._beat.stop()
        self._times.close()

    def _on_beat(self) -> None:
        now = self._times.read()
        wall_s, cpu_s, queued_s = (after - before for after, before in zip(now, self._last))
        seen = max(self._where, key=self._where.get) if self._where else ""
        late_s = max(wall_s - BEAT_S, 0.0)
        self.blocks.append(Block(self.action, late_s, cpu_s, min(queued_s, late_s), seen))
        self._where = {}
        self._last = self._times.read()

    def _look(self) -> None:
        while not self._stop.wait(_LOOK_EVERY_S):
            if time.perf_counter() - self._last[0] > _LOOK_AFTER_S:
                where = self._where_main_is()
                self._where[where] = self._where.get(where, 0) + 1

    def _where_main_is(self) -> str:
        # a frame object in hand would keep its painter alive beyond the end of the painting, which Qt does not survive
        self._dump.seek(0)
        self._dump.truncate()
        faulthandler.dump_traceback(self._dump)
        self._dump.seek(0)
        _, _, after = self._dump.read().partition(f"Thread 0x{self._main:016x}")
        lines = [_LINE.search(line) for line in after.split("Thread 0x")[0].split("Current thread")[0].splitlines()]
        frames = [found for found in lines if found]
        ours = [frame for frame in frames[1:] if _is_ours(frame[1])]
        told = [f"{Path(frame[1]).name}:{frame[2]} {frame[3]}" for frame in (*frames[:1], *ours[:_DEPTH])]
        return " < ".join(told)


def _is_ours(path: str) -> bool:
    return any(part in _OURS for part in Path(path).parts[-5:-1]) and "site-packages" not in path
