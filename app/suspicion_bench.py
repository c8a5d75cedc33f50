"""How well suspicion finds the faults that were planted in the demo corpus, beside chance and plain distance."""

from __future__ import annotations

import numpy as np

from core.actress.corpus import planted_faults
from core.actress.faults import KINDS
from core.errors import UserFacingError
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress
from core.suspicion.measure import area_under_curve, precision_at_planted
from core.suspicion.ranking import SuspicionList
from core.suspicion.rarity import cluster_distance


def bench_suspicion(database: MotionDatabase, progress: Progress = SILENT) -> dict[str, object]:
    """Rank the nodes of ``database``, then look up which of them are contaminated; returns counts and rows of figures.

    Raises `UserFacingError` when the database has none of the planted nodes.
    """
    found = SuspicionList.of(database, progress.part(0.0, 0.8))
    kind = planted_kinds(database)
    planted = kind != ""
    if not planted.any():
        raise UserFacingError("This database holds no planted fault to measure by.", "Leave --db away to measure.")
    distance = cluster_distance(np.asarray(database.frames, float), database.nodes, progress.part(0.8, 1.0))
    share = float(planted.mean())
    rows = [_row("suspicion", found.score, kind), _row("kNN distance", distance, kind)]
    rows.append({"ranking": "chance", "precision": share, "auc": 0.5,
                 **{f"{k} found": share for k in KINDS}, **{f"{k} auc": 0.5 for k in KINDS}})  # fmt: skip
    rows += [_row(f"{fault.value} alone", score, kind) for fault, score in found.by_fault.items()]
    named = [s for s in found.ranked[: int(planted.sum())] if planted[s.row]]
    right = sum(s.fault.value == kind[s.row] for s in named)
    return {"nodes": len(database.nodes), "planted": int(planted.sum()), "rows": rows,
            "kind named right": right / max(len(named), 1)}  # fmt: skip


def planted_kinds(database: MotionDatabase) -> np.ndarray:
    """Return the kind of fault planted in each node, str, shape (n_nodes,), "" for sound ones."""
    of_node = {fault.node: fault.kind for fault in planted_faults()}
    return np.array([of_node.get(database.nodes.name(n), "") for n in range(len(database.nodes))])


def _row(name: str, score: np.ndarray, kind: np.ndarray) -> dict[str, object]:
    """Figures of one ranking: over all planted nodes, and of each kind against the sound ones."""
    planted = kind != ""
    worst = np.zeros(len(score), bool)
    worst[np.argsort(-score, kind="stable")[: int(planted.sum())]] = True
    row = {"ranking": name, "precision": precision_at_planted(score, planted), "auc": area_under_curve(score, planted)}
    for one in KINDS:
        its, sound = kind == one, ~planted
        row[f"{one} found"] = float(worst[its].mean()) if its.any() else float("nan")
        row[f"{one} auc"] = area_under_curve(score[its | sound], its[its | sound]) if its.any() else float("nan")
    return row


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    rows = answer["rows"]
    columns = [name for name in rows[0] if name != "ranking"]
    lines = [
        f"{answer['planted']} planted of {answer['nodes']} nodes; kind named right {answer['kind named right']:.0%}"
    ]
    lines.append(f"{'':18}" + "".join(f"{name:>14}" for name in columns))
    lines += [f"{row['ranking']:18}" + "".join(f"{row[name]:14.3f}" for name in columns) for row in rows]
    return "\n".join(lines)
