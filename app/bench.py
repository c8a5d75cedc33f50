"""Measurements of the search, each beside a reference run in the same process."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from app.machine import MemoryReader, forget_peak, peak_mb, timed
from core.actress.corpus import demo_sentences, transcript_of
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.search.best_path import MotionPath, find_path
from core.search.compute import DeviceReport, NumpyKernels, SearchKernels
from core.search.constraints import SearchRequest
from core.search.relaxation import find_path_by_relaxation
from core.search.replicate import replicated
from core.search.session import SearchSession
from core.search.solve import solve
from core.search.tables import SearchTables
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts
from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PHONEME_INDEX
from gpu.device import describe, open_kernels

PAPER_LENGTHS = (14, 24, 53, 63)  # Deng and Neumann 2008, table 5
BACKENDS = ("reference", "numpy32", "numpy", "opencl", "glsl", "middle", "relaxation")
_PAINTED_SLOTS = 8
_MOST_S = 20.0  # a median is taken of fewer runs when they would take longer
_FEWEST = 3
# every row has them; None where a way of searching has no such thing
_FIELDS = ("phonemes", "nodes", "backend", "device", "api", "driver", "software", "cold_s", "pin_s", "refresh_s",
           "second_pin_s", "paint_s", "prices_s", "build_s", "bytes_moved", "read_gb_per_s", "fraction_of_bandwidth",
           "speedup_vs_reference", "optimal", "gap", "cost", "peak_mb", "repeats", "edit_repeats", "tables_on",
           "missing")  # fmt: skip


def bench_search(
    database: MotionDatabase,
    n_nodes: int | None = None,
    phonemes: Sequence[int] = PAPER_LENGTHS,
    backends: Sequence[str] = BACKENDS,
    repeats: int = 20,
    progress: Progress = SILENT,
) -> dict[str, object]:
    """Measure cold searches, edits and prices; returns {machine, rows}.

    Times are medians of ``repeats`` runs, or of as many as 20 s allow; ``repeats`` and ``edit_repeats`` of a row tell.
    The memory's speed is measured between the runs of a row, so that a busy machine slows both.

    n_nodes : the database is repeated with variation, or cut, to this many nodes
    """
    strangers = [name for name in backends if name not in BACKENDS]
    if strangers:
        raise UserFacingError(f"There is no backend '{strangers[0]}' to measure.", f"Known are {', '.join(BACKENDS)}.")
    progress.step(0.0, "measuring memory")
    memory = MemoryReader()
    machine = memory.machine()
    frames, nodes = database.frames, database.nodes
    if n_nodes is not None and n_nodes != len(nodes):
        frames, nodes = replicated(frames, nodes, n_nodes, database.rate_hz)
    weights = default_weights(frames, nodes, database.rate_hz)
    costs = TransitionCosts(TransitionTerms(frames, nodes, database.rate_hz), weights)
    build_s = timed(lambda: costs.prepare(progress.part(0.05, 0.2)))
    rows = []
    for i, backend in enumerate(backends):
        stage = progress.part(0.2 + 0.8 * i / len(backends), 0.2 + 0.8 * (i + 1) / len(backends))
        forget_peak()
        try:
            way = _Way.open(backend, costs)
        except UserFacingError as error:
            rows.append({"backend": backend, "nodes": len(nodes), "missing": error.message})
            continue
        for k, length in enumerate(phonemes):
            stage.step(k / len(phonemes), f"{backend}, {length} phonemes")
            rows.append({**_row(way, utterance(length), memory, repeats), "build_s": build_s})
        way.kernels.release()
    memory.close()
    _compare(rows)
    return {"machine": machine.as_dict(), "rows": [{name: row.get(name) for name in _FIELDS} for row in rows]}


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
class _Way:
    """One way to search, ready to be measured.

    kernels : keep the tables of its session
    bytes_of : what a cold search of so many slots reads of the matrix; None where that is not the measure
    has_session : whether edits are measured; the reference and its float32 twin only know cold searches
    """

    name: str
    solve: Callable[[SearchRequest], MotionPath]
    kernels: SearchKernels
    report: DeviceReport
    costs: TransitionCosts
    bytes_of: Callable[[int], int] | None = None
    has_session: bool = True

    @classmethod
    def open(cls, name: str, costs: TransitionCosts) -> _Way:
        """Open a way by its name; raises `UserFacingError` when it cannot be had here."""
        if not costs.is_held:
            if name != "relaxation":
                raise UserFacingError(
                    f"The transitions of {len(costs.terms.nodes)} motion nodes are beyond the memory budget."
                )
            kernels = NumpyKernels()
            return cls(name, lambda r: solve(r, costs, lambda: kernels), kernels, kernels.report, costs,
                       has_session=False)  # fmt: skip
        matrix_bytes = costs.matrix.nbytes
        if name in ("reference", "numpy32"):
            dtype = np.float64 if name == "reference" else np.float32
            plain = _PlainKernels(costs.matrix, dtype)
            return cls(name, lambda r: find_path(r, costs, plain), plain, plain.report, costs,
                       lambda n_slots: (n_slots - 1) * plain.matrix_bytes, has_session=False)  # fmt: skip
        kernels, _ = open_kernels(name if name in ("numpy", "opencl", "glsl") else "auto")
        kernels.prepare(costs.matrix)
        if name == "relaxation":
            return cls(name, lambda r: find_path_by_relaxation(r, costs), kernels, NumpyKernels.report, costs)
        if name == "middle":
            return cls(name, lambda r: _meet_in_the_middle(r, costs, kernels), kernels, kernels.report, costs,
                       lambda n_slots: n_slots // 2 * matrix_bytes)  # fmt: skip
        return cls(name, lambda r: find_path(r, costs, kernels), kernels, kernels.report, costs,
                   lambda n_slots: (n_slots - 1) * matrix_bytes)  # fmt: skip


def _meet_in_the_middle(request: SearchRequest, costs: TransitionCosts, kernels: SearchKernels) -> MotionPath:
    # several paths that cost the same are settled by the plain search
    return SearchTables(request, costs, kernels).best() or find_path(request, costs, kernels)


def _row(way: _Way, request: SearchRequest, memory: MemoryReader, repeats: int) -> dict[str, object]:
    path = way.solve(request)
    seconds, readings = [], []
    began = time.perf_counter()
    while len(seconds) < repeats and (len(seconds) < _FEWEST or time.perf_counter() - began < _MOST_S):
        seconds.append(timed(lambda: way.solve(request)))
        readings.append(memory.bytes_per_s(0.5))
    cold_s, read_bytes_per_s = statistics.median(seconds), statistics.median(readings)
    row: dict[str, object] = {
        **way.report.as_dict(), "backend": way.name, "phonemes": request.n_slots, "nodes": len(way.costs.terms.nodes),
        "cold_s": cold_s, "repeats": len(seconds), "read_gb_per_s": read_bytes_per_s / 1e9,
        "optimal": path.is_optimal, "gap": path.gap, "cost": path.cost,
    }  # fmt: skip
    if way.bytes_of is not None:
        row["bytes_moved"] = way.bytes_of(request.n_slots)
        row["fraction_of_bandwidth"] = row["bytes_moved"] / cold_s / read_bytes_per_s
    if way.has_session:
        row.update(_edits(way, request, repeats), tables_on=describe(way.kernels))
    return {**row, "peak_mb": peak_mb() - memory.n_bytes / (1 << 20)}


def _edits(way: _Way, request: SearchRequest, repeats: int) -> dict[str, float | int]:
    """Times of edits and of the tables behind them, medians.

    pin_s : to the answer after one pin; refresh_s : until tables and prices are whole again
    second_pin_s : to the answer after one more pin elsewhere, before the tables are whole again
    paint_s : to the answer after another emotion over eight slots; prices_s : all prices, from nothing
    """
    session = SearchSession(request, way.costs, way.kernels)
    nodes = way.costs.terms.nodes
    prices_s = timed(session.refresh)
    rng = np.random.default_rng(request.n_slots)

    def node_for(slot: int) -> int:
        same = np.flatnonzero(nodes.phoneme == request.phonemes[slot])
        return int(rng.choice(same)) if len(same) else int(rng.integers(len(nodes)))

    def back() -> None:
        session.update(request)
        session.refresh()

    names = ("pin_s", "refresh_s", "second_pin_s", "paint_s")
    seconds: dict[str, list[float]] = {name: [] for name in names}
    began, done = time.perf_counter(), 0
    while done < repeats and (not done or time.perf_counter() - began < _MOST_S):
        slot, other = (int(p) for p in rng.integers(request.n_slots, size=2))
        pinned = replace(request, pins={slot: node_for(slot)})
        seconds["pin_s"].append(timed(lambda: session.update(pinned)))  # noqa: B023 - called at once
        seconds["refresh_s"].append(timed(session.refresh))
        back()
        twice = replace(pinned, pins={other: node_for(other), **pinned.pins})
        session.update(pinned)
        seconds["second_pin_s"].append(timed(lambda: session.update(twice)))  # noqa: B023
        back()
        first = int(rng.integers(max(1, request.n_slots - _PAINTED_SLOTS)))
        emotions = request.emotions.copy()
        emotions[first : first + _PAINTED_SLOTS] = np.eye(len(EMOTIONS))[rng.integers(len(EMOTIONS))]
        seconds["paint_s"].append(timed(lambda: session.update(replace(request, emotions=emotions))))  # noqa: B023
        back()
        done += 1
    medians = {name: statistics.median(seconds[name]) for name in names}
    return {**medians, "prices_s": prices_s, "edit_repeats": done}


class _PlainKernels:
    """The plain way to write the step: ``np.add`` into a reused buffer, then a row-wise argmin."""

    def __init__(self, matrix: np.ndarray, dtype: type) -> None:
        self.report = replace(NumpyKernels.report, api=f"{NumpyKernels.report.api}, {np.dtype(dtype).name}")
        self._matrix = matrix.astype(dtype)
        self._sums = np.empty_like(self._matrix)

    @property
    def matrix_bytes(self) -> int:
        return self._matrix.nbytes

    def min_plus(self, front: np.ndarray) -> np.ndarray:
        np.add(self._matrix, front.astype(self._matrix.dtype), out=self._sums)
        best = self._sums.argmin(axis=1)
        return self._sums[np.arange(len(best)), best].astype(float)

    def release(self) -> None:
        self._matrix = self._sums = np.zeros((0, 0))


def _compare(rows: list[dict[str, object]]) -> None:
    """Put each row's speed beside the reference's of the same length."""
    reference = {row["phonemes"]: row["cold_s"] for row in rows if row["backend"] == "reference" and "cold_s" in row}
    for row in rows:
        if row.get("phonemes") in reference:
            row["speedup_vs_reference"] = reference[row["phonemes"]] / row["cold_s"]


def as_table(answer: dict) -> str:
    """Lay the rows out for a terminal."""
    columns = ("phonemes", "backend", "cold_s", "pin_s", "second_pin_s", "refresh_s", "paint_s", "prices_s",
               "fraction_of_bandwidth", "speedup_vs_reference", "gap", "peak_mb", "repeats")  # fmt: skip
    lines = [f"{answer['machine']}", "  ".join(f"{name[:12]:>12}" for name in columns)]
    for row in answer["rows"]:
        if row["missing"]:
            lines.append(f"{row['backend']}: {row['missing']}")
            continue
        cells = ["" if row[name] is None else row[name] for name in columns]
        lines.append("  ".join(f"{f'{c:.4f}' if isinstance(c, float) else c:>12}" for c in cells))
    return "\n".join(lines)
