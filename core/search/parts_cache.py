"""Priced transitions of large databases, kept in the cache folder from one start to the next.

A file is the SHA-256 of what follows, then the three parts of `TransitionParts`. Its name is a hash of all that they
are made from, so that it never goes stale; whatever is wrong with it, the transitions are priced anew.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import threading
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.folders import cache_dir
from core.media.swap_in import swapped_in
from core.motion.node import NodeTable
from core.progress import SILENT, Progress
from core.search.terms import TransitionTerms
from core.search.transitions import TransitionParts

VERSION = 1  # raise it when `core.search.terms` computes otherwise
LEAST_NODES = 1000  # fewer are priced in less time than a file takes
MOST_BYTES = 1 << 30  # of all files together; the ones that were used last stay
_DIGEST_BYTES = 32


def remembered_parts(terms: TransitionTerms, progress: Progress = SILENT) -> TransitionParts:
    """Return `TransitionParts.of` the terms, read from the cache where it has them; else they are kept for next time.

    They are written by a thread of its own; a cache that cannot be written costs only time.
    """
    n_nodes = len(terms.nodes)
    if n_nodes < LEAST_NODES or 12 * n_nodes**2 > MOST_BYTES:
        return TransitionParts.of(terms, progress)
    path = parts_path(terms)
    parts = read_parts(path, n_nodes)
    if parts is None:
        parts = TransitionParts.of(terms, progress)
        threading.Thread(target=keep_parts, args=(path, parts)).start()
    return parts


def parts_path(terms: TransitionTerms) -> Path:
    """Return the file of these terms."""
    digest = hashlib.sha256(f"parts {VERSION} numpy {np.__version__} {terms.rate_hz!r}".encode())
    digest.update(np.ascontiguousarray(terms.frames).tobytes())
    for name in NodeTable.COLUMNS:
        digest.update(np.ascontiguousarray(getattr(terms.nodes, name)).tobytes())
    return cache_dir() / "transitions" / f"{digest.hexdigest()[:32]}.parts"


def read_parts(path: Path, n_nodes: int) -> TransitionParts | None:
    """Return what a file holds; None when it is not there, damaged, or of another size."""
    try:
        if path.stat().st_size != _DIGEST_BYTES + 12 * n_nodes**2:
            return None
        with path.open("rb") as file:
            digest = file.read(_DIGEST_BYTES)
            values = np.fromfile(file, np.float32)
        os.utime(path)
    except OSError:
        return None
    if values.size != 3 * n_nodes**2 or hashlib.sha256(values).digest() != digest:
        return None
    return TransitionParts(*values.reshape(3, n_nodes, n_nodes))


def keep_parts(path: Path, parts: TransitionParts) -> None:
    """Write a file, and drop the ones that were used longest ago until all fit into `MOST_BYTES`."""
    arrays = parts.position_gap, parts.velocity_gap, parts.smoothing
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(array)
    with contextlib.suppress(OSError, UserFacingError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with swapped_in(path) as beside, beside.open("wb") as file:
            file.write(digest.digest())
            for array in arrays:
                array.tofile(file)
        _drop_oldest(path.parent)


def _drop_oldest(folder: Path) -> None:
    files = [(found.stat(), found) for found in folder.iterdir() if found.is_file()]
    total = 0
    for about, found in sorted(files, key=lambda entry: entry[0].st_mtime, reverse=True):
        total += about.st_size
        if total > MOST_BYTES:
            found.unlink(missing_ok=True)
