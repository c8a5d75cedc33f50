"""Blendshape weights on disk: Live Link Face's CSV, tables of weights, arrays with a list of names."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.blendshape_track import ARKIT_UNITS, BlendshapeTrack, arkit_name, checked_weights
from core.motion.frame_rate import check_rate_hz, rate_of_times
from core.motion.live_link_face import is_live_link_face, read_live_link_face
from core.motion.motion_track import RateUnknown
from core.motion.readers.column_names import is_frame, time_factor
from core.motion.readers.delimited import DelimitedText, first_repeated, is_number, read_delimited
from core.motion.readers.npy import read_npy, read_npz
from core.speech.text_file import read_text

SUFFIXES = (".csv", ".tsv", ".npy", ".npz")
# a table is one of blendshapes when it names this many of ARKit's
_LEAST_KNOWN = 5
_RATES = ("fps", "rate_hz", "frame_rate")


class NamesUnknown(UserFacingError):
    """The file holds weights without names; a list of names answers."""

    def __init__(self, path: object, n_shapes: int) -> None:
        super().__init__(
            f"'{path}' holds {n_shapes} weights a frame and does not name them.",
            "Give the list of names: a text file with one a line, or an .npy of texts.",
        )


def take_name(path: Path) -> str:
    """Return what the sound and the transcript of a take of weights are called.

    Facegood's files put a word before, and ours have two suffixes: ``take.livelink.csv``, ``take.curves.json``.
    """
    return path.stem.removeprefix("bs_value_").removesuffix(".livelink").removesuffix(".curves")


def is_blendshape_file(path: str | Path) -> bool:
    """Tell a file of weights from one of markers; raises `UserFacingError` when it cannot be read at all."""
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix == ".npy":
        return True
    if suffix == ".npz":
        return "weights" in read_npz(path, ("weights",))
    if suffix not in (".csv", ".tsv"):
        return False
    text = read_delimited(path)
    return is_blendshape_table(text)


def is_blendshape_table(text: DelimitedText) -> bool:
    """Tell whether a table is Live Link Face's, or names at least five of ARKit's units in its first line."""
    return is_live_link_face(text) or sum(arkit_name(cell) is not None for cell in text.cells(0)) >= _LEAST_KNOWN


def read_blendshapes(
    path: str | Path, names: str | Path | Sequence[str] | None = None, rate_hz: float | None = None
) -> BlendshapeTrack:
    """Read blendshape weights; names that are mostly ARKit's are brought to its spelling, others stay.

    path : Live Link Face's CSV; a .csv or .tsv with a line of names, and a column of times or frames or none; an .npy
        of shape (F, B); an .npz with ``weights``, ``names`` and ``fps``
    names : B names, or the file that lists them (see `read_shape_names`); an .npy has none of its own
    rate_hz : frames a second, for a file that does not tell

    Raises `UserFacingError` for what cannot be used, `NamesUnknown` and `RateUnknown`.
    """
    path = Path(path)
    listed = read_shape_names(names) if isinstance(names, str | Path) else None if names is None else tuple(names)
    suffix = path.suffix.lower()
    if suffix == ".npy":
        return _of_array(path, read_npy(path), listed, rate_hz)
    if suffix == ".npz":
        arrays = read_npz(path, ("weights", "names", *_RATES))
        if "weights" not in arrays:
            raise UserFacingError(f"'{path}' has no array 'weights'.")
        if listed is None and "names" in arrays:
            listed = _texts(arrays["names"], path)
        rates = [arrays[key] for key in _RATES if key in arrays]
        if rate_hz is None and rates and rates[0].size == 1 and rates[0].dtype.kind in "iuf":
            rate_hz = float(rates[0].reshape(()))
        return _of_array(path, arrays["weights"], listed, rate_hz)
    if suffix not in SUFFIXES:
        raise UserFacingError(f"'{path}' is no kind of file that holds blendshape weights.", "Use .csv, .npy or .npz.")
    text = read_delimited(path)
    return read_live_link_face(path, rate_hz) if is_live_link_face(text) else _of_table(text, rate_hz)


def read_shape_names(path: str | Path) -> tuple[str, ...]:
    """Read names of blendshapes: an .npy of texts, a .json list, or a text with one a line.

    Pickled arrays are refused. Raises `UserFacingError` for what is missing, is no list of names, or names one twice.
    """
    path = Path(path)
    if path.suffix.lower() == ".npy":
        return _texts(read_npy(path), path)
    text = read_text(path, "list of names")
    if path.suffix.lower() == ".json":
        try:
            data = json.loads(text)
        except (ValueError, RecursionError) as error:
            raise UserFacingError(f"The list of names '{path}' is no JSON.") from error
        if not isinstance(data, list) or not all(isinstance(name, str) for name in data):
            raise UserFacingError(f"'{path}' is no list of names.")
        return _unique(data, path)
    lines = (line.strip().rstrip(",;").strip('" ') for line in text.splitlines())
    return _unique([line for line in lines if line and not line.startswith("#")], path)


def _of_array(path: Path, array: np.ndarray, names: tuple[str, ...] | None, rate_hz: float | None) -> BlendshapeTrack:
    if array.ndim != 2 or array.dtype.kind not in "fiu" or 0 in array.shape:
        raise UserFacingError(f"'{path}' is no array of weights, frames by shapes.")
    if names is None:
        raise NamesUnknown(path, array.shape[1])
    if len(names) != array.shape[1]:
        raise UserFacingError(f"'{path}' holds {array.shape[1]} weights a frame, and there are {len(names)} names.")
    if rate_hz is None:
        raise RateUnknown(path)
    if array.dtype.kind == "f" and np.isinf(array).any():
        raise UserFacingError(f"'{path}' holds infinite weights.")
    weights, notes = checked_weights(array, path)
    return BlendshapeTrack(weights, _spelled(names, path), check_rate_hz(rate_hz, path), notes=notes)


def _of_table(text: DelimitedText, rate_hz: float | None) -> BlendshapeTrack:
    heads = text.cells(0)
    factors = [time_factor(head) for head in heads]
    columns = [c for c, head in enumerate(heads) if head and factors[c] is None and not is_frame(head)]
    if not columns or any(is_number(heads[c]) for c in columns):
        raise UserFacingError(f"'{text.path}', line 1: the first line does not name blendshapes.")
    names = _spelled([heads[c] for c in columns], text.path)
    times = [c for c, factor in enumerate(factors) if factor is not None][:1]
    table, lines = text.numbers(1, len(heads), [*columns, *times])
    if not len(table):
        raise UserFacingError(f"'{text.path}' has 0 frames.")
    if rate_hz is None:
        if not times:
            raise RateUnknown(text.path)
        rate_hz = rate_of_times(table[:, -1] * factors[times[0]], text.path, lines)
    values = table[:, : len(columns)]
    if np.isinf(values).any():
        raise UserFacingError(
            f"'{text.path}', line {lines[np.isinf(values).any(axis=1).argmax()]}: a weight is infinite."
        )
    weights, notes = checked_weights(values, text.path)
    return BlendshapeTrack(weights, names, check_rate_hz(rate_hz, text.path), notes=notes)


def _texts(array: np.ndarray, path: Path) -> tuple[str, ...]:
    if array.ndim != 1 or array.dtype.kind not in "US":
        raise UserFacingError(f"'{path}' is no list of names.")
    try:
        texts = [str(name) if isinstance(name, str) else name.decode("utf-8") for name in array.tolist()]
    except (UnicodeDecodeError, ValueError) as error:
        raise UserFacingError(f"The names in '{path}' are no text.") from error
    return _unique([text.strip() for text in texts], path)


def _unique(names: Sequence[str], path: Path) -> tuple[str, ...]:
    if not names or not all(names):
        raise UserFacingError(f"'{path}' lists no names, or an empty one.")
    twice = first_repeated(names)
    if twice is not None:
        raise UserFacingError(f"'{path}' names '{twice[:60]}' twice.")
    return tuple(names)


def _spelled(names: Sequence[str], path: Path) -> tuple[str, ...]:
    """ARKit's spelling, where most names are ARKit's; a studio's own list may share a name or two by chance."""
    known = [unit if (unit := arkit_name(name)) in ARKIT_UNITS else None for name in names]
    if 2 * sum(unit is not None for unit in known) < len(names):
        return _unique(names, path)
    return _unique([unit or name for unit, name in zip(known, names)], path)
