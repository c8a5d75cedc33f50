"""How well maps keep neighbours, Isomap beside PCA; landmarks and placed frames beside the full way."""

from __future__ import annotations

import time

import numpy as np
from threadpoolctl import threadpool_limits

from app.machine import forget_peak, peak_mb
from core.manifold.isomap import PhonemeIsomap, PhonemeMap, geodesic_residual
from core.manifold.placing import place_frames
from core.manifold.preservation import N_NEIGHBORS, NeighbourPreservation, map_preservation
from core.motion.database import MotionDatabase
from core.motion.maps import cluster_frames
from core.progress import SILENT, Progress
from core.search.replicate import replicated
from core.speech.phoneme import PHONEME_INDEX

_FIGURES = ("shared", "trustworthiness", "continuity")
_LANDMARKS = (800, 400, 200)
_LARGEST = 4  # clusters whose maps are compared
_EVERY = 5  # one sentence in so many comes late


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


def bench_agreement(database: MotionDatabase, n_frames: int = 4000, progress: Progress = SILENT) -> dict[str, object]:
    """Return how well landmark maps and placed frames agree with the full Isomap, over the largest clusters.

    Of each cluster the first ``n_frames`` frames are taken. A row a way: the full method; landmarks, as many as large
    maps have and fewer; *grown*: the full map of four sentences in five, the frames of the fifth placed on it, and
    beside it the map of the same frames made anew. ``disparity`` is Procrustes' between a way's map and the full one.
    """
    rows = []
    phones = sorted(database.maps, key=lambda phone: -len(database.maps[phone].frames))[:_LARGEST]
    for i, phone in enumerate(phones):
        progress.step(i / len(phones), f"maps of /{phone}/")
        at = database.maps[phone].frames[:n_frames]
        captured = database.frames[at].astype(float)
        full, seconds = _timed_fit(captured)
        rows.append({"phone": phone, "frames": len(at), **_compared("full", full, full, captured, seconds)})
        for n_landmarks in _LANDMARKS:
            if n_landmarks < len(at):
                made, seconds = _timed_fit(captured, landmark_above=0, n_landmarks=n_landmarks)
                figures = _compared(f"{n_landmarks} landmarks", made, full, captured, seconds)
                rows.append({"phone": phone, "frames": len(at), **figures})
        starts = [sentence.start_frame for sentence in database.sentences]
        late = (np.searchsorted(starts, at, side="right") - 1) % _EVERY == _EVERY - 1
        if late.any() and not late.all():
            old, _ = _timed_fit(captured[~late])
            began = time.perf_counter()
            placed = np.empty((len(at), 2))
            placed[~late] = old
            placed[late] = place_frames(captured[~late], old, captured[late])
            figures = _compared(f"{late.sum()} placed", placed, full, captured, time.perf_counter() - began)
            rows.append({"phone": phone, "frames": len(at), **figures})
    return {"rows": rows}


def bench_large(database: MotionDatabase, n_frames: int = 20_000, progress: Progress = SILENT) -> dict[str, object]:
    """Make one map of ``n_frames``, by repeating the database until its largest cluster has as many; time and memory.

    ``peak_mb`` is that of this process, with all that it holds besides.
    """
    phone = max(database.maps, key=lambda phone: len(database.maps[phone].frames))
    times = 1 + n_frames // len(database.maps[phone].frames)
    frames, nodes = replicated(database.frames, database.nodes, times * len(database.nodes), database.rate_hz)
    at = cluster_frames(nodes, PHONEME_INDEX[phone])[:n_frames]
    captured = frames[at].astype(float)
    del frames
    progress.step(0.2, "making the map")
    forget_peak()
    began, cpu = time.perf_counter(), time.process_time()
    with threadpool_limits(1):
        made = PhonemeMap.make(at, captured)
    return {
        "phone": phone, "frames": len(at), "seconds": time.perf_counter() - began,
        "cpu_s": time.process_time() - cpu, "peak_mb": peak_mb(), "joined": made.n_joined,
        "residual_variance": made.residual_variance,
    }  # fmt: skip


def agreement_as_table(answer: dict) -> str:
    """Lay the rows of `bench_agreement` out for a terminal."""
    columns = ("residual_variance", "disparity", *_FIGURES, "seconds")
    lines = [f"{'phone':>6}{'frames':>8}{'way':>16}" + "".join(f"{name:>19}" for name in columns)]
    for row in answer["rows"]:
        cells = "".join(f"{row[name]:19.4f}" for name in columns)
        lines.append(f"{row['phone']:>6}{row['frames']:>8}{row['way']:>16}{cells}")
    return "\n".join(lines)


def large_in_words(answer: dict) -> str:
    """Say what `bench_large` found."""
    return (f"a map of {answer['frames']} frames of /{answer['phone']}/ in {answer['seconds']:.1f} s "
            f"({answer['cpu_s']:.1f} s of one processor), peak {answer['peak_mb']:.0f} MiB, residual variance "
            f"{answer['residual_variance']:.3f}")  # fmt: skip


def _timed_fit(captured: np.ndarray, **settings: int) -> tuple[np.ndarray, float]:
    began = time.perf_counter()
    with threadpool_limits(1):
        settings = {"landmark_above": len(captured), **settings}
        return PhonemeIsomap(**settings).fit(captured).embedding_, time.perf_counter() - began


def _compared(
    way: str, embedding: np.ndarray, full: np.ndarray, captured: np.ndarray, seconds: float
) -> dict[str, object]:
    from scipy.spatial import procrustes

    kept = NeighbourPreservation.of(captured, embedding)
    row = {"way": way, "residual_variance": geodesic_residual(captured, embedding), "seconds": seconds,
           "disparity": float(procrustes(full, embedding)[2])}  # fmt: skip
    return row | {name: getattr(kept, name) for name in _FIGURES}


def as_table(answer: dict) -> str:
    """Lay the figures out for a terminal."""
    columns = list(answer["mean"])
    lines = [f"{'phone':>6}{'frames':>8}" + "".join(f"{name:>24}" for name in columns)]
    for row in answer["rows"]:
        lines.append(f"{row['phone']:>6}{row['frames']:>8}" + "".join(f"{row[name]:24.3f}" for name in columns))
    lines.append(f"{'mean':>6}{'':8}" + "".join(f"{answer['mean'][name]:24.3f}" for name in columns))
    return "\n".join(lines)
