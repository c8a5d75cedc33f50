"""What must hold in a motion database before anything is computed from it: a file may come from anywhere."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable

import numpy as np

from core.motion.marker_set import MarkerSet
from core.motion.node import NIL, NodeTable
from core.motion.pca import MotionPca
from core.speech.emotion import EMOTION_INDEX, EMOTIONS
from core.speech.phoneme import PHONEME_INDEX, PHONEMES
from core.speech.transcript import Transcript

_RATES_HZ = (1.0, 10_000.0)
# mm, far beyond any face; larger numbers would overflow on the way to a picture
_LARGEST = 1e6


class Unsound(ValueError):
    """What does not hold in a database, as a clause."""


def stored(file, name: str, dtype: type) -> np.ndarray:
    """Return the numbers of dataset ``name``, which were written as ``dtype``.

    Raises `Unsound` when they are of another type, or when it does not lie in ``file`` itself, whole and as it was
    written: a link, a part kept in another file, or a size that the file cannot hold (a few bytes can promise
    terabytes).
    """
    import h5py

    at = file
    for part in name.split("/"):
        if not isinstance(at, h5py.Group) or not isinstance(at.get(part, getlink=True), h5py.HardLink):
            raise Unsound(f"'{name}' is not there")
        at = at[part]
    if not isinstance(at, h5py.Dataset) or at.shape is None or at.dtype != dtype:
        raise Unsound(f"'{name}' is no {np.dtype(dtype).name}")
    if at.is_virtual or at.external:
        raise Unsound(f"'{name}' lies in another file")
    if at.dtype.itemsize * math.prod(at.shape) > file.id.get_filesize():
        raise Unsound(f"'{name}' is larger than the file")
    return at[()]


def stored_text(file, name: str) -> str | bytes:
    """Return the one text of dataset ``name``; raises `Unsound` when it is none."""
    import h5py

    at = file.get(name)
    if not isinstance(at, h5py.Dataset) or at.shape != () or at.external or at.is_virtual:
        raise Unsound(f"'{name}' is no text")
    return at[()]


def plain_json(text: str | bytes) -> object:
    """Parse JSON; raises `Unsound` for the NaN and infinity that JSON does not have."""

    def refuse(name: str) -> None:
        raise Unsound(f"a description holds {name}")

    return json.loads(text, parse_constant=refuse)


def check_rate(rate_hz: float) -> None:
    """Check frames a second."""
    _require(_RATES_HZ[0] <= rate_hz <= _RATES_HZ[1], "its rate is no frame rate")


def check_captured(positions: np.ndarray, n_markers: int) -> None:
    """Check raw marker positions; a marker may be missing (NaN)."""
    _require(positions.ndim == 3 and positions.shape[1:] == (n_markers, 3), "its recordings do not fit the markers")
    _require(bool((np.isnan(positions) | (np.abs(positions) <= _LARGEST)).all()), "it holds numbers that are no motion")


def check_held_out(held_out: object) -> None:
    """Check that sentence names are listed by split."""
    _require(isinstance(held_out, dict), "its held-out sentences are no lists")
    for names in held_out.values():
        _require(
            isinstance(names, list) and all(isinstance(n, str) for n in names), "its held-out sentences are no lists"
        )


def check_motion(rate_hz: float, markers: MarkerSet, pca: MotionPca, frames: np.ndarray, tracks: np.ndarray) -> None:
    """Check rate, rest pose, principal components, and the frames with their head ``tracks``."""
    check_rate(rate_hz)
    _require(len(markers) > 0, "it has no marker")
    _require(all(isinstance(name, str) for name in markers.names), "a marker has no name")
    known = set(markers.names)
    _require(all(known.issuperset(members) for members in markers.groups.values()), "a group names no marker")
    _require(known.issuperset(markers.landmarks.values()), "a landmark names no marker")
    n_values, n_dims = 3 * len(markers), pca.basis.shape[-1]
    shapes = (pca.mean.shape, pca.basis.shape, pca.variance.shape)
    _require(n_dims > 0 and shapes == ((n_values,), (n_values, n_dims), (n_dims,)), "its components do not fit")
    _require(frames.ndim == 2 and frames.shape[1] == n_dims, "its frames do not fit the components")
    _require(tracks.shape == (len(frames), 6), "its head motion does not fit the frames")
    for array in (markers.rest, pca.mean, pca.basis, pca.coverage, frames, tracks):
        _require(_are_motion(array), "it holds numbers that are no motion")
    _require(bool(np.isfinite(pca.variance).all()), "its variances are not finite")


def _are_motion(array: np.ndarray) -> bool:
    # least and greatest, without the copies that a comparison of millions makes; NaN is neither
    return np.size(array) == 0 or bool(np.min(array) >= -_LARGEST and np.max(array) <= _LARGEST)


def check_nodes(nodes: NodeTable, n_frames: int) -> None:
    """Check that each motion node is a run of frames, of a phone, in a sentence, with neighbours that exist."""
    for name, dtype in NodeTable.COLUMNS.items():
        column = getattr(nodes, name)
        _require(column.dtype == dtype and column.shape == nodes.phoneme.shape[:1], f"its column '{name}' does not fit")
    n = len(nodes)
    _require(n > 0, "it has no motion node")
    limits = {
        "sentence": (0, len(nodes.sentence_names)), "order": (0, np.iinfo(np.int32).max), "phoneme": (0, len(PHONEMES)),
        "emotion": (0, len(EMOTIONS)), "previous": (0, len(PHONEMES)), "following": (0, len(PHONEMES)),
        "pre": (NIL, n), "suc": (NIL, n),
    }  # fmt: skip
    for name, (lowest, beyond) in limits.items():
        column = getattr(nodes, name)
        _require(bool(((column >= lowest) & (column < beyond)).all()), f"its column '{name}' is out of range")
    in_order = (nodes.start >= 0) & (nodes.start < nodes.stop) & (nodes.stop <= n_frames)
    _require(bool(in_order.all()), "motion nodes lie beyond the frames")


def check_sentences(names: Iterable[str], spans: Iterable[tuple[int, int]], n_frames: int) -> None:
    """Check that sentences have names of their own and lie within the frames."""
    names = list(names)
    _require(all(isinstance(name, str) for name in names) and len(set(names)) == len(names), "sentence names repeat")
    for start, stop in spans:
        _require(type(start) is type(stop) is int and 0 <= start <= stop <= n_frames, "a sentence lies beyond")


def check_spoken(emotion: str, transcript: Transcript) -> None:
    """Check emotion, phones and times of one sentence."""
    _require(emotion in EMOTION_INDEX, "a sentence has an unknown emotion")
    _require(all(u.phone in PHONEME_INDEX for u in transcript.phonemes), "a sentence has an unknown phone")
    times = [t for u in (*transcript.phonemes, *transcript.words) for t in (u.start_s, u.end_s)]
    for time_s in (*times, transcript.duration_s):
        _require(isinstance(time_s, int | float) and math.isfinite(time_s), "a sentence has no times")


def check_map(phone: str, frames: np.ndarray, embedding: np.ndarray, linear: np.ndarray, triangles: np.ndarray,
              n_frames: int) -> None:  # fmt: skip
    """Check the map of ``phone``: points in a plane, one a frame, and triangles between them."""
    place = f"the map of /{phone[:8]}/"
    _require(phone in PHONEME_INDEX, f"{place} belongs to no phone")
    n = len(frames) if frames.ndim == 1 else -1
    _require(embedding.shape == linear.shape == (n, 2), f"{place} does not fit its frames")
    _require(triangles.ndim == 2 and triangles.shape[1] == 3, f"{place} has no triangles")
    for rows, beyond in ((frames, n_frames), (triangles, n)):
        _require(bool(((rows >= 0) & (rows < beyond)).all()), f"{place} points beyond")
    _require(bool(np.isfinite(embedding).all() and np.isfinite(linear).all()), f"{place} is not finite")


def _require(holds: bool, otherwise: str) -> None:
    if not holds:
        raise Unsound(otherwise)
