"""Watches how long the main thread keeps the window waiting, and what it does meanwhile."""

from __future__ import annotations

import faulthandler
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
    wall_s : how long; cpu_s : how much of that the main thread itself computed; the rest it waited, for a processor,
        for Python's lock or for the display
    where : functions of ours that it was in, innermost first; empty for a short one
    """

    action: str
    wall_s: float
    cpu_s: float
    where: str


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
        self._stop = threading.Event()
        self._dump = tempfile.TemporaryFile("w+", encoding="utf-8")  # noqa: SIM115  closed by `stop`
        self._beat = QTimer(self, interval=round(1000 * BEAT_S))
        self._beat.setTimerType(Qt.TimerType.PreciseTimer)
        self._beat.timeout.connect(self._on_beat)
        self._looker = threading.Thread(target=self._look, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._last_s, self._last_cpu_s = time.perf_counter(), time.thread_time()
        self._beat.start()
        self._looker.start()

    def stop(self) -> None:
        """End."""
        self._stop.set()
        self._looker.join()
        self._dump.close()
        self._beat.stop()

    def _on_beat(self) -> None:
        now_s, cpu_s = time.perf_counter(), time.thread_time()
        seen = max(self._where, key=self._where.get) if self._where else ""
        late_s = max(now_s - self._last_s - BEAT_S, 0.0)
        self.blocks.append(Block(self.action, late_s, cpu_s - self._last_cpu_s, seen))
        self._where = {}
        self._last_s, self._last_cpu_s = time.perf_counter(), time.thread_time()

    def _look(self) -> None:
        while not self._stop.wait(_LOOK_EVERY_S):
            if time.perf_counter() - self._last_s > _LOOK_AFTER_S:
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
        ours = [f"{Path(found[1]).name}:{found[2]} {found[3]}" for found in lines if found and _is_ours(found[1])]
        return " < ".join(ours[:_DEPTH])


def _is_ours(path: str) -> bool:
    return any(part in _OURS for part in Path(path).parts[-5:-1]) and "site-packages" not in path
