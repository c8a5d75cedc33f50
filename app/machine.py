"""What figures were taken on: the processor, how fast it reads memory, and how much memory this process took."""

from __future__ import annotations

import contextlib
import os
import platform
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

_READ_ELEMENTS = 64 << 20  # 256 MiB of float32, which no cache holds
_STATUS = Path("/proc/self/status")


@dataclass(frozen=True)
class Machine:
    """The processor, and the fastest that all its cores together were seen to read memory, bytes a second."""

    processor: str
    cores: int
    read_bytes_per_s: float

    def as_dict(self) -> dict[str, object]:
        """Return it for ``--json``."""
        return {
            "processor": self.processor,
            "cores": self.cores,
            "read_gb_per_s": round(self.read_bytes_per_s / 1e9, 2),
            "python": platform.python_version(),
            "numpy": np.__version__,
        }


class MemoryReader:
    """Reads 256 MiB of float32 by all cores, again and again, and tells how fast that went."""

    def __init__(self) -> None:
        self.cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        data = np.ones(_READ_ELEMENTS, np.float32)
        self.n_bytes = data.nbytes
        self._parts = np.array_split(data, self.cores)
        self._pool = ThreadPoolExecutor(self.cores)

    def bytes_per_s(self, share: float = 1.0) -> float:
        """Read once; ``share`` of the data will do where many readings are taken."""
        parts = [part[: int(len(part) * share)] for part in self._parts]
        seconds = timed(lambda: list(self._pool.map(np.max, parts)))
        return self.n_bytes * share / seconds

    def machine(self, repeats: int = 7) -> Machine:
        """Return the machine, with the best of ``repeats`` readings."""
        return Machine(_processor(), self.cores, max(self.bytes_per_s() for _ in range(repeats)))

    def close(self) -> None:
        """End its threads and free its memory."""
        self._pool.shutdown()
        self._parts = []


def timed(work: Callable[[], object]) -> float:
    """Seconds that ``work`` takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def forget_peak() -> None:
    """Let `peak_mb` count from now on; without effect where the system keeps one peak for the whole life."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak_mb() -> float:
    """Largest resident size of this process, MiB, since `forget_peak` if the system can; 0 where it does not tell."""
    with contextlib.suppress(OSError):
        for line in _STATUS.read_text().splitlines():
            if line.startswith("VmHWM:"):
                return round(int(line.split()[1]) / 1024, 1)
    try:
        import resource
    except ImportError:
        return 0.0
    unit = 1 << 20 if sys.platform == "darwin" else 1 << 10
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / (1 << 20), 1)


def _processor() -> str:
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or platform.machine()
