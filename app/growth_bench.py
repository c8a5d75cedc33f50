"""How the search grows with the database and the sentence, and how its certified gap falls with time."""

from __future__ import annotations

import itertools
import math
import os
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from app.bench import PAPER_LENGTHS, utterance
from app.machine import forget_peak, peak_mb, timed
from core.media.swap_in import swapped_in
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.search.relaxation import Round, find_path_by_relaxation
from core.search.replicate import replicated
from core.search.terms import TransitionTerms, default_weights
from core.search.transitions import TransitionCosts

SIZES = (5_558, 20_000, 50_000, 100_000)
_GAPS_AT_S = (5, 15, 60)
_PICTURE_PX = 1000


def bench_growth(
    database: MotionDatabase,
    sizes: Sequence[int] = SIZES,
    phonemes: Sequence[int] = PAPER_LENGTHS,
    limit_s: float = 60.0,
    progress: Progress = SILENT,
) -> dict[str, object]:
    """Search databases of several sizes, cold; returns {rows}, a row for each size and length, largest sizes last.

    The database is repeated with variation, or cut, to each size; nothing of the transition matrix is held. ``index_s``
    is what is computed beforehand once per database, ``index_mb`` its size; a row's ``rounds`` are seconds, gap and
    active nodes as they came; ``cpu_s`` is processor time, which other work on the machine disturbs less.
    """
    rows = []
    for i, n_nodes in enumerate(sizes):
        stage = progress.part(i / len(sizes), (i + 1) / len(sizes))
        stage.step(0.0, f"{n_nodes} motion nodes")
        frames, nodes = database.frames, database.nodes
        if n_nodes != len(nodes):
            frames, nodes = replicated(frames, nodes, n_nodes, database.rate_hz)
        weights = default_weights(frames, nodes, database.rate_hz)
        began = time.perf_counter()
        terms = TransitionTerms(frames, nodes, database.rate_hz)
        index_s = time.perf_counter() - began
        index = sum(a.nbytes for a in vars(terms).values() if isinstance(a, np.ndarray) and a is not frames)
        costs = TransitionCosts(terms, weights, budget_bytes=0)
        for k, length in enumerate(phonemes):
            stage.step(k / len(phonemes), f"{n_nodes} motion nodes, {length} phonemes")
            row = {"nodes": n_nodes, "phonemes": length, "index_s": index_s, "index_mb": index / 2**20}
            rows.append(row | _searched(costs, length, limit_s))
    return {"rows": rows}


def _searched(costs: TransitionCosts, length: int, limit_s: float) -> dict[str, object]:
    request = utterance(length)
    rounds: list[Round] = []
    found = []
    forget_peak()
    cpu = time.process_time()
    seconds = timed(
        lambda: found.append(find_path_by_relaxation(request, costs, limit_s=limit_s, on_round=rounds.append))
    )
    cpu_s = time.process_time() - cpu
    gaps = [1.0 - r.lower_bound / r.upper_bound if r.upper_bound else 0.0 for r in rounds]
    row: dict[str, object] = {"first_s": rounds[0].seconds, "first_gap": gaps[0]}
    for at_s in _GAPS_AT_S:
        known = [gap for r, gap in zip(rounds, gaps) if r.seconds <= at_s]
        row[f"gap_{at_s}s"] = min(known) if known else None
    return row | {
        "seconds": seconds, "cpu_s": cpu_s, "optimal": found[0].is_optimal, "gap": found[0].gap, "cost": found[0].cost,
        "peak_mb": peak_mb(), "rounds": [[r.seconds, gap, r.n_active] for r, gap in zip(rounds, gaps)],
    }  # fmt: skip


def as_table(answer: dict) -> str:
    """Lay the rows out for a terminal."""
    columns = ("nodes", "phonemes", "index_s", "index_mb", "first_s", "first_gap", "gap_5s", "gap_15s", "gap_60s",
               "seconds", "cpu_s", "gap", "peak_mb")  # fmt: skip
    lines = ["".join(f"{name:>10}" for name in columns)]
    for row in answer["rows"]:
        cells = ["" if row[name] is None else row[name] for name in columns]
        lines.append("".join(f"{f'{c:.3f}' if isinstance(c, float) else c:>10}" for c in cells))
    return "\n".join(lines)


def draw(answer: dict, folder: Path) -> list[Path]:
    """Write ``search-growth.png`` (seconds by database size) and ``search-gap.png`` (gap by time, longest sentence)."""
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    import pyqtgraph as pg

    pg.mkQApp()
    rows = answer["rows"]
    lengths = sorted({r["phonemes"] for r in rows})
    growth = {
        f"{length} phonemes": [(r["nodes"], r["seconds"]) for r in rows if r["phonemes"] == length]
        for length in lengths
    }
    gap = {
        f"{r['nodes']} nodes": _steps([(seconds, 100.0 * gap) for seconds, gap, _ in r["rounds"]])
        for r in rows
        if r["phonemes"] == lengths[-1]
    }
    return [
        _plot(pg, growth, "motion nodes", "seconds to the proved answer", True, folder / "search-growth.png"),
        _plot(pg, gap, "seconds", "certified gap, %", False, folder / "search-gap.png"),
    ]


def _steps(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Let each value hold until the next one comes."""
    held = [(later[0], value) for (_, value), later in itertools.pairwise(points)]
    return sorted(points + held, key=lambda point: (point[0], -point[1]))


def _ticks(values: Iterable[float]) -> list[tuple[float, str]]:
    """Label 1, 2 and 5 of each decade on a logarithmic axis."""
    values = [value for value in values if value > 0.0]
    decades = range(math.floor(math.log10(min(values))), math.ceil(math.log10(max(values))) + 1)
    return [(math.log10(step * 10.0**d), f"{step * 10.0**d:,.6g}") for d in decades for step in (1, 2, 5)]


def _plot(pg, curves: dict[str, list[tuple[float, float]]], x: str, y: str, log_y: bool, path: Path) -> Path:
    import pyqtgraph.exporters

    widget = pg.PlotWidget(background="w")
    widget.resize(_PICTURE_PX, int(0.6 * _PICTURE_PX))
    plot = widget.plotItem
    plot.addLegend(offset=(-20, 20) if not log_y else (60, 20), labelTextColor="k")
    plot.setLogMode(x=True, y=log_y)
    plot.getViewBox().setDefaultPadding(0.08)
    for side, name in (("bottom", x), ("left", y)):
        plot.setLabel(side, name, color="k")
        plot.getAxis(side).enableAutoSIPrefix(False)
        plot.getAxis(side).setPen("k")
        plot.getAxis(side).setTextPen("k")
    plot.getAxis("bottom").setHeight(50)
    plot.getAxis("bottom").setTicks([_ticks(point[0] for points in curves.values() for point in points)])
    if log_y:
        plot.getAxis("left").setTicks([_ticks(point[1] for points in curves.values() for point in points)])
    plot.showGrid(x=True, y=True, alpha=0.2)
    for i, (name, points) in enumerate(curves.items()):
        colour = pg.intColor(i, len(curves), maxValue=180)
        across, up = np.array(points, float).T
        plot.plot(across, up, pen=pg.mkPen(colour, width=2), symbol="o", symbolSize=7, symbolBrush=colour, name=name)
    exporter = pyqtgraph.exporters.ImageExporter(plot)
    exporter.parameters()["width"] = _PICTURE_PX
    with swapped_in(path) as beside:
        exporter.export(toBytes=True).save(str(beside), "PNG")
    return path
