"""The maps of a database's phoneme clusters: made, and grown with it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np
from threadpoolctl import threadpool_limits

from core.manifold.isomap import PhonemeMap
from core.manifold.placing import grow_map
from core.motion.node import NodeTable
from core.progress import SILENT, Progress
from core.speech.phoneme import PHONEMES

_Job = tuple[Callable[..., PhonemeMap], tuple]
_FEWEST_TO_PLACE_ON = 3  # fewer frames span no plane
_WORTH_PROCESSES = 60_000  # frames; starting processes costs more than a small corpus


def cluster_frames(nodes: NodeTable, phoneme: int) -> np.ndarray:
    """Return the rows of all frames of a phoneme cluster, int64, node after node."""
    of_cluster = nodes.phoneme == phoneme
    start, length = nodes.start[of_cluster], nodes.n_frames[of_cluster]
    before = np.cumsum(length) - length
    return (np.repeat(start - before, length) + np.arange(length.sum())).astype(np.int64)


def make_maps(frames: np.ndarray, nodes: NodeTable, progress: Progress = SILENT) -> dict[str, PhonemeMap]:
    """Make the map of every phoneme cluster, largest first, on all cores when there is much to do."""
    return grown_maps({}, np.zeros(0, np.int64), frames, nodes, progress=progress)


def grown_maps(
    old: Mapping[str, PhonemeMap],
    came_from: np.ndarray,
    frames: np.ndarray,
    nodes: NodeTable,
    remake: bool = False,
    progress: Progress = SILENT,
) -> dict[str, PhonemeMap]:
    """Return the maps of a database that has grown or shrunk, of which only those that changed are computed.

    Frames that stay keep their places; new ones are placed among them. A cluster is mapped anew when it has no map to
    place on.

    old : the maps before
    came_from : int64, shape (n_frames,), the row of each of ``frames`` before, -1 for a new one
    remake : map anew every cluster that got or lost frames, now or since its map was made
    """
    n_before = max((int(m.frames.max(initial=0)) + 1 for m in old.values()), default=0)
    place = np.empty(n_before + 1, np.int64)  # one more, for new frames look up -1
    maps: dict[str, PhonemeMap] = {}
    jobs: dict[str, _Job] = {}
    for phoneme in np.unique(nodes.phoneme):
        phone, rows = PHONEMES[phoneme], cluster_frames(nodes, phoneme)
        before = old.get(phone)
        if before is None:
            jobs[phone] = _made, (rows, frames[rows])
            continue
        place.fill(-1)
        place[before.frames] = np.arange(len(before.frames))
        source = came_from[rows]
        kept = place[np.where(source < n_before, source, -1)]
        is_new = kept < 0
        kept = kept[~is_new]
        changed = bool(is_new.any()) or len(kept) < len(before.frames)
        if len(kept) < _FEWEST_TO_PLACE_ON or (remake and (changed or before.n_placed)):
            jobs[phone] = _made, (rows, frames[rows])
        elif is_new.any():
            jobs[phone] = _grown, (before, kept, rows, is_new, frames[rows])
        else:
            maps[phone] = grow_map(before, kept, rows, is_new, np.zeros((len(rows), 0)))
    for phone, made in _carried_out(jobs, len(frames) > _WORTH_PROCESSES):
        maps[phone] = made
        progress.step(len(maps) / (len(jobs) + len(maps)), f"map of /{phone}/ made")
    return {phone: maps[phone] for phone in sorted(maps)}


def _carried_out(jobs: Mapping[str, _Job], in_processes: bool) -> Iterable[tuple[str, PhonemeMap]]:
    from joblib import Parallel, delayed

    order = sorted(jobs, key=lambda phone: -len(jobs[phone][1][-1]))
    calls = (delayed(_mapped)(phone, *jobs[phone]) for phone in order)
    return Parallel(n_jobs=-1 if in_processes else 1, return_as="generator_unordered")(calls)


def _mapped(phone: str, make: Callable[..., PhonemeMap], arguments: tuple) -> tuple[str, PhonemeMap]:
    with threadpool_limits(1):
        return phone, make(*arguments)


def _made(rows: np.ndarray, frames: np.ndarray) -> PhonemeMap:
    return PhonemeMap.make(rows, frames.astype(float))


def _grown(before: PhonemeMap, kept: np.ndarray, rows: np.ndarray, is_new: np.ndarray, frames: np.ndarray):
    return grow_map(before, kept, rows, is_new, frames)
