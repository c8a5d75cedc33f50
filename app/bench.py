"""Measurements of the search, each beside a reference run in the same process."""

from __future__ import annotations

import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.actress.corpus import demo_sentences, transcript_of
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, find_path
from core.search.compute import DeviceReport, SearchKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.replicate import replicated
from core.search.session import SearchSession
from core.search.tables import SearchTables
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PHONEME_INDEX
from gpu.device import open_kernels

PAPER_LENGTHS = (14, 24, 53, 63)  # Deng and Neumann 2008, table 5
BACKENDS = ("reference", "numpy32", "numpy", "opencl", "glsl", "relaxation")
_PAINTED_SLOTS = 8


@dataclass(frozen=True)
class Machine:
    """What the figures were taken on; bandwidth is reading memory by all cores, bytes a second."""

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


def measure_machine(repeats: int = 7) -> Machine:
    """Measure how fast all cores together read 512 MiB of float32 that no cache holds; the best of ``repeats``."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    data = np.ones(128 << 20, np.float32)
    parts = np.array_split(data, cores)
    with ThreadPoolExecutor(cores) as pool:
        best = min(_timed(lambda: list(pool.map(np.max, parts))) for _ in range(repeats))
    return Machine(_processor(), cores, data.nbytes / best)


def bench_search(
    database: MotionDatabase,
    n_nodes: int | None = None,
    phonemes: Sequence[int] = PAPER_LENGTHS,
    backends: Sequence[str] = BACKENDS,
    repeats: int = 20,
    progress: Progress = SILENT,
) -> dict[str, object]:
    """Measure cold searches, edits and prices; returns {machine, rows}, times being medians of ``repeats``.

    n_nodes : the database is repeated with variation, or cut, to this many nodes
    """
    strangers = [name for name in backends if name not in BACKENDS]
    if strangers:
        raise UserFacingError(f"There is no backend '{strangers[0]}' to measure.", f"Known are {', '.join(BACKENDS)}.")
    progress.step(0.0, "measuring memory")
    machine = measure_machine()
    frames, nodes = database.frames, database.nodes
    if n_nodes is not None and n_nodes != len(nodes):
        frames, nodes = replicated(frames, nodes, n_nodes, database.rate_hz)
    weights = default_weights(frames, nodes, database.rate_hz)
    costs = TransitionCosts(TransitionTerms(frames, nodes, database.rate_hz), weights)
    build_s = _timed(lambda: costs.prepare(progress.part(0.05, 0.2)))
    rows = []
    for i, backend in enumerate(backends):
        stage = progress.part(0.2 + 0.8 * i / len(backends), 0.2 + 0.8 * (i + 1) / len(backends))
        try:
            measured = _Backend.open(backend, costs, machine, repeats)
        except UserFacingError as error:
            rows.append({"backend": backend, "nodes": len(nodes), "missing": error.message})
            continue
        for k, length in enumerate(phonemes):
            stage.step(k / len(phonemes), f"{backend}, {length} phonemes")
            rows.append({**measured.row(utterance(length)), "build_s": round(build_s, 3)})
        measured.kernels.release()
    _compare(rows)
    return {"machine": machine.as_dict(), "rows": rows}


def utterance(n_slots: int) -> SearchRequest:
    """Return a request of ``n_slots`` natural phonemes: the demo's own sentences, one after the other, as painted."""
    slots: list[tuple[int, int]] = []
    while len(slots) < n_slots:
        for spoken in demo_sentences():
            emotion = EMOTION_INDEX[spoken.emotion]
            said = [(PHONEME_INDEX[phone], emotion) for phone in transcript_of(spoken).phones]
            slots += said[1:] if slots else said  # a sentence ends and the next begins with one silence
    phonemes, emotions = np.array(slots[:n_slots]).T
    return SearchRequest(phonemes, np.eye(len(EMOTIONS))[emotions])


@dataclass
class _Backend:
    """One way to search, ready to be measured."""

    name: str
    solve: Callable[[SearchRequest], MotionPath]
    kernels: SearchKernels
    report: DeviceReport
    costs: TransitionCosts
    machine: Machine
    repeats: int

    @classmethod
    def open(cls, name: str, costs: TransitionCosts, machine: Machine, repeats: int) -> _Backend:
        kernels, _ = open_kernels(name if name in ("opencl", "glsl") else "numpy")
        kernels.prepare(costs.matrix)
        report = kernels.report
        if name == "reference":
            reference, report = _FloatReference(costs.matrix, np.float64), replace(report, api="numpy float64")
            return cls(name, lambda r: find_path(r, costs, reference), kernels, report, costs, machine, repeats)
        if name == "numpy32":
            reference, report = _FloatReference(costs.matrix, np.float32), replace(report, api="numpy float32")
            return cls(name, lambda r: find_path(r, costs, reference), kernels, report, costs, machine, repeats)
        if name == "relaxation":
            # the quickest kernels that are here keep the tables behind it
            kernels.release()
            kernels, _ = open_kernels("auto")
            kernels.prepare(costs.matrix)
            report = replace(kernels.report, backend="relaxation")
            return cls(name, lambda r: find_path_by_relaxation(r, costs), kernels, report, costs, machine, repeats)
        return cls(name, lambda r: find_path(r, costs, kernels), kernels, report, costs, machine, repeats)

    def row(self, request: SearchRequest) -> dict[str, object]:
        n_nodes = len(self.costs.terms.nodes)
        path = self.solve(request)
        cold_s = self._median(lambda: self.solve(request))
        row: dict[str, object] = {
            "phonemes": request.n_slots, "nodes": n_nodes, "backend": self.name, "device": self.report.device,
            "api": self.report.api, "software": self.report.software, "cold_s": cold_s,
        }  # fmt: skip
        if self.name not in ("relaxation", "reference", "numpy32"):
            bytes_read = (request.n_slots - 1) * n_nodes**2 * 4
            row["fraction_of_bandwidth"] = bytes_read / cold_s / self.machine.read_bytes_per_s
            row["bytes_moved"] = bytes_read
            row["middle_s"] = self._median(lambda: SearchTables(request, self.costs, self.kernels).best())
        if self.name not in ("reference", "numpy32"):
            row.update(self._edits(request))
        row.update(optimal=path.is_optimal, gap=path.gap, cost=path.cost, peak_mb=_peak_mb())
        return row

    def _edits(self, request: SearchRequest) -> dict[str, float]:
        """Times of a pin, of painting eight slots, of whole tables after a pin, and of the price table from nothing."""
        session = SearchSession(request, self.costs, self.kernels)
        prices_s = _timed(session.refresh)
        rng = np.random.default_rng(request.n_slots)
        n_nodes = len(self.costs.terms.nodes)
        pins, refreshes, paints = [], [], []
        for _ in range(self.repeats):
            slot = int(rng.integers(request.n_slots))
            same = np.flatnonzero(self.costs.terms.nodes.phoneme == request.phonemes[slot])
            node = int(rng.choice(same)) if len(same) else int(rng.integers(n_nodes))
            pinned = replace(request, pins={slot: node})
            pins.append(_timed(lambda: session.update(pinned)))  # noqa: B023 - called at once
            refreshes.append(_timed(session.refresh))
            session.update(request)
            session.refresh()
            first = int(rng.integers(max(1, request.n_slots - _PAINTED_SLOTS)))
            painted = request.emotions.copy()
            painted[first : first + _PAINTED_SLOTS] = np.eye(len(EMOTIONS))[rng.integers(len(EMOTIONS))]
            paints.append(_timed(lambda: session.update(replace(request, emotions=painted))))  # noqa: B023
            session.update(request)
            session.refresh()
        return {"pin_s": statistics.median(pins), "refresh_s": statistics.median(refreshes),
                "paint_s": statistics.median(paints), "prices_s": prices_s}  # fmt: skip

    def _median(self, work: Callable[[], object]) -> float:
        return statistics.median(_timed(work) for _ in range(self.repeats))


class _FloatReference:
    """The plain way to write the step: ``np.add`` into a reused buffer, then a row-wise argmin."""

    def __init__(self, matrix: np.ndarray, dtype: type) -> None:
        self._matrix = matrix.astype(dtype)
        self._sums = np.empty_like(self._matrix)

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        np.add(self._matrix, front.astype(self._matrix.dtype), out=self._sums)
        best = self._sums.argmin(axis=1)
        return self._sums[np.arange(len(best)), best].astype(float)


def _compare(rows: list[dict[str, object]]) -> None:
    """Put each row's speed beside the reference's of the same length."""
    reference = {row["phonemes"]: row["cold_s"] for row in rows if row["backend"] == "reference" and "cold_s" in row}
    for row in rows:
        if row.get("phonemes") in reference:
            row["speedup_vs_reference"] = reference[row["phonemes"]] / row["cold_s"]


def as_table(answer: dict) -> str:
    """Lay the rows out for a terminal."""
    columns = ("phonemes", "backend", "cold_s", "middle_s", "pin_s", "refresh_s", "paint_s", "prices_s",
               "fraction_of_bandwidth", "speedup_vs_reference", "gap", "peak_mb")  # fmt: skip
    lines = [f"{answer['machine']}", "  ".join(f"{name[:12]:>12}" for name in columns)]
    for row in answer["rows"]:
        if "missing" in row:
            lines.append(f"{row['backend']}: {row['missing']}")
            continue
        cells = [row.get(name, "") for name in columns]
        lines.append("  ".join(f"{f'{c:.4f}' if isinstance(c, float) else c:>12}" for c in cells))
    return "\n".join(lines)


def _timed(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def _peak_mb() -> float:
    """Largest resident size of this process so far, MiB; 0 where the system does not tell."""
    try:
        import resource
    except ImportError:
        return 0.0
    unit = 1 << 20 if sys.platform == "darwin" else 1 << 10
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / (1 << 20), 1)
