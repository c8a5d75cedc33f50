"""How well the maps of a database keep neighbours, Isomap beside PCA."""

from __future__ import annotations

import numpy as np

from core.manifold.preservation import N_NEIGHBORS, map_preservation
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

_FIGURES = ("shared", "trustworthiness", "continuity")


def bench_maps(database: MotionDatabase, progress: Progress = SILENT) -> dict[str, object]:
    """Return figures of both maps for each phoneme, and their means weighted by frames."""
    rows = []
    for i, (phone, shown) in enumerate(database.maps.items()):
        stage = progress.part(i / len(database.maps), (i + 1) / len(database.maps))
        isomap, pca = map_preservation(shown, database.frames, stage)
        row: dict[str, object] = {"phone": phone, "frames": len(shown.frames), "joined": shown.n_joined}
        for name in _FIGURES:
            row[f"isomap {name}"], row[f"pca {name}"] = getattr(isomap, name), getattr(pca, name)
        rows.append(row)
    frames = np.array([row["frames"] for row in rows], float)
    mean = {
        f"{kind} {name}": float(np.average([row[f"{kind} {name}"] for row in rows], weights=frames))
        for name in _FIGURES
        for kind in ("isomap", "pca")
    }
    return {"neighbours": N_NEIGHBORS, "rows": rows, "mean": mean}


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    columns = list(answer["mean"])
    lines = [f"{'phone':>6}{'frames':>8}" + "".join(f"{name:>24}" for name in columns)]
    for row in answer["rows"]:
        lines.append(f"{row['phone']:>6}{row['frames']:>8}" + "".join(f"{row[name]:24.3f}" for name in columns))
    lines.append(f"{'mean':>6}{'':8}" + "".join(f"{answer['mean'][name]:24.3f}" for name in columns))
    return "\n".join(lines)
