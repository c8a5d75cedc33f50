"""How far the aligner's boundaries lie from a corpus's own, part by part."""

from __future__ import annotations

import time
from pathlib import Path

from core.errors import UserFacingError
from core.evaluation.alignment import measure_demo, measure_grid
from core.progress import SILENT, Progress

PARTS = ("train", "tune", "test")
_SHARES = ("within_20ms", "within_50ms", "compared")


def bench_alignment(folder: Path | None, part: str, progress: Progress = SILENT) -> dict[str, object]:
    """Measure one part of a folder laid out like GRID, or without one of the demo corpus.

    Returns {corpus, split, seconds, rows}; raises `UserFacingError` for an unknown part or a broken folder.
    """
    if part not in PARTS:
        raise UserFacingError(f"There is no part '{part}'.", f"Choose one of {', '.join(PARTS)}.")
    began = time.perf_counter()
    rows = measure_demo(part, progress) if folder is None else measure_grid(folder, part, progress)
    corpus = "demo (synthetic voice)" if folder is None else folder.resolve().name
    return {"corpus": corpus, "split": part, "seconds": round(time.perf_counter() - began, 1), "rows": rows}


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    columns = ("n", "median_ms", "p90_ms", "bias_ms", *_SHARES)
    width = max(len(row["boundaries"]) for row in answer["rows"])
    lines = [f"{answer['corpus']}, {answer['split']} part, {answer['seconds']:.0f} s"]
    lines.append(" " * width + "".join(f"{name:>13}" for name in columns))
    for row in answer["rows"]:
        cells = "".join(f"{_cell(name, row.get(name)):>13}" for name in columns)
        lines.append(f"{row['boundaries']:{width}}{cells}")
    return "\n".join(lines)


def _cell(name: str, figure: float | None) -> str:
    if figure is None:
        return ""
    return f"{figure:.1%}" if name in _SHARES else f"{figure:g}"
