"""A trained face in one file: compressed arrays, no pickles, and what it was trained on."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face_file import UNREADABLE, read_arrays
from core.iface.classes import SpeechClasses
from core.iface.ear import FRAMES_AROUND, N_EAR_INPUTS
from core.iface.modern_face import ModernFace, n_told
from core.iface.motion_unit import MotionUnits, MotionUnitSet
from core.iface.paper_face import PaperFace
from core.iface.perceptrons import ACTIVATIONS, Perceptron
from core.iface.speaking import MOST_AHEAD
from core.iface.speech_features import N_CEPSTRA, N_FEATURES
from core.iface.unit_face import UnitFace
from core.media.swap_in import swapped_in

FORMAT, VERSION = "efase-iface", 2
MODEL_SUFFIX = ".npz"
MODERN, PAPER = "modern", "paper"
VARIANTS = (MODERN, PAPER)
_ANEW = "Train it anew with `efase train iface`."
_UNIT_SET = ("mean", "units", "variance", "coverage")
_MOST_BACK, _MOST_NETS = 1000, 1000
_LARGEST = 1e30  # single precision holds it


@dataclass(frozen=True, eq=False)
class FaceModel:
    """A trained face and where it comes from.

    variant : ``modern`` or ``paper``
    markers : names, one a marker of the face
    database : name of the database that it was trained on; content_hash : of that database; seed : of the training
    """

    face: UnitFace
    variant: str
    markers: tuple[str, ...]
    database: str
    content_hash: str
    seed: int


def save_model(model: FaceModel, path: Path) -> None:
    """Write ``model`` (.npz); raises `UserFacingError` when it cannot be written."""
    face, units = model.face, model.face.units
    head = {
        "format": FORMAT, "version": VERSION, "variant": model.variant, "markers": list(model.markers),
        "database": model.database, "content_hash": model.content_hash, "seed": model.seed,
        "expressions": list(face.expressions), "window": [face.n_back, face.n_ahead], "axes": units.n_axes,
    }  # fmt: skip
    arrays = {"neutral": face.neutral, "silence": face.silence}
    for k, unit_set in enumerate((units.utterance, *units.expressions.values())):
        arrays |= {f"units{k}_{name}": np.asarray(getattr(unit_set, name)) for name in _UNIT_SET}
    if isinstance(face, PaperFace):
        head |= {"phones": list(face.classes.phones)}
        arrays |= {f"classes_{name}": getattr(face.classes, name) for name in ("means", "factors", "log_scales")}
    for kind, perceptrons in _perceptrons(face).items():
        head[kind] = [[perceptron.activation, len(perceptron.weights)] for perceptron in perceptrons]
        for i, perceptron in enumerate(perceptrons):
            for j, (weights, offsets) in enumerate(zip(perceptron.weights, perceptron.offsets)):
                arrays |= {f"{kind}{i}_weights{j}": weights, f"{kind}{i}_offsets{j}": offsets}
    with swapped_in(path) as beside, beside.open("wb") as file:
        np.savez_compressed(file, head=np.str_(json.dumps(head)), **arrays)


def load_model(path: Path) -> FaceModel:
    """Read what `save_model` wrote; raises `UserFacingError` for what is missing, foreign, newer or damaged."""
    path = Path(path)
    try:
        arrays = read_arrays(path)
        head = json.loads(str(arrays["head"]))
        if head["format"] != FORMAT:
            raise UserFacingError(f"'{path}' holds no speaking face.", _ANEW)
        if head["version"] != VERSION:
            raise UserFacingError(f"'{path}' holds a speaking face of another version of the workstation.", _ANEW)
        return _read(head, arrays)
    except FileNotFoundError as error:
        raise UserFacingError(f"There is no speaking face at '{path}'.", _ANEW) from error
    except UNREADABLE as error:
        raise UserFacingError(f"'{path}' is no file of a speaking face, or it is damaged.", _ANEW) from error


def _perceptrons(face: UnitFace) -> Mapping[str, tuple[Perceptron, ...]]:
    if isinstance(face, PaperFace):
        return {"spoken": face.spoken, "expressive": face.expressive}
    return {"ears": face.ears, "nets": face.nets}


def _read(head: dict, arrays: dict[str, np.ndarray]) -> FaceModel:
    """Put a face together; raises one of `UNREADABLE` where its parts do not belong together."""
    _must(all(_is_sound(a) for name, a in arrays.items() if name not in ("head", "classes_log_scales")))
    markers, expressions = tuple(map(str, head["markers"])), tuple(map(str, head["expressions"]))
    neutral, silence = (arrays[name].astype(np.float32) for name in ("neutral", "silence"))
    n_axes, (n_back, n_ahead) = int(head["axes"]), (int(n) for n in head["window"])
    _must(0 < len(markers) == len(set(markers)) and neutral.shape == (len(markers), n_axes))
    _must(silence.shape == (N_FEATURES,) and len(set(expressions)) == len(expressions))
    _must(0 <= n_back <= _MOST_BACK and 0 <= n_ahead <= MOST_AHEAD)
    sets = [_unit_set(arrays, k, neutral.size) for k in range(1 + len(expressions))]
    units = MotionUnits(sets[0], dict(zip(expressions, sets[1:])), len(markers), n_axes)
    shared = (units, neutral, silence, n_back, n_ahead)
    n_window, n_spoken = n_back + 1 + n_ahead, len(sets[0].units)
    n_shown = [n_spoken + len(unit_set.units) for unit_set in sets[1:]]
    variant = str(head["variant"])
    if variant == PAPER:
        classes = _classes(tuple(map(str, head["phones"])), arrays)
        _must(len(head["spoken"]) == len(classes.phones) and len(head["expressive"]) == len(expressions))
        spoken = _read_perceptrons(head, arrays, "spoken", [(n_window * N_CEPSTRA, n_spoken)] * len(classes.phones))
        expressive = _read_perceptrons(head, arrays, "expressive", [(n_spoken, n) for n in n_shown])
        face: UnitFace = PaperFace(*shared, classes, spoken, expressive)
    else:
        _must(variant == MODERN and min(n_back, n_ahead) >= FRAMES_AROUND)
        _must(all(0 < len(head[kind]) <= _MOST_NETS for kind in ("ears", "nets")))
        (_, n_layers), *_ = head["ears"]
        n_phones = len(arrays[f"ears0_offsets{int(n_layers) - 1}"])
        ears = _read_perceptrons(head, arrays, "ears", [(N_EAR_INPUTS, n_phones)] * len(head["ears"]))
        sizes = [(n_told(n_window, n_phones), n_spoken + sum(n_shown))] * len(head["nets"])
        face = ModernFace(*shared, ears, _read_perceptrons(head, arrays, "nets", sizes))
    return FaceModel(face, variant, markers, str(head["database"]), str(head["content_hash"]), int(head["seed"]))


def _unit_set(arrays: dict[str, np.ndarray], k: int, n_coordinates: int) -> MotionUnitSet:
    mean, units, variance, coverage = (arrays[f"units{k}_{name}"].astype(float) for name in _UNIT_SET)
    _must(mean.shape == (n_coordinates,) and units.shape == (len(variance), n_coordinates))
    return MotionUnitSet(mean, units, variance, float(coverage))


def _classes(phones: tuple[str, ...], arrays: dict[str, np.ndarray]) -> SpeechClasses:
    means, factors, log_scales = (
        arrays[f"classes_{name}"].astype(float) for name in ("means", "factors", "log_scales")
    )
    shape = (len(phones), log_scales.shape[-1])
    _must(min(shape) > 0 and log_scales.shape == shape and means.shape == (*shape, N_CEPSTRA))
    _must(factors.shape == (*shape, N_CEPSTRA, N_CEPSTRA))
    _must(np.isfinite(log_scales).any(axis=1).all() and not np.isnan(log_scales).any() and log_scales.max() < np.inf)
    return SpeechClasses(phones, means, factors, log_scales)


def _read_perceptrons(
    head: dict, arrays: dict[str, np.ndarray], kind: str, sizes: Sequence[tuple[int, int]]
) -> tuple[Perceptron, ...]:
    return tuple(
        _perceptron(arrays, f"{kind}{i}", *layers, *size) for i, (layers, size) in enumerate(zip(head[kind], sizes))
    )


def _perceptron(
    arrays: dict[str, np.ndarray], name: str, activation: str, n_layers: int, n_inputs: int, n_outputs: int
) -> Perceptron:
    weights = [arrays[f"{name}_weights{j}"] for j in range(int(n_layers))]
    offsets = [arrays[f"{name}_offsets{j}"] for j in range(int(n_layers))]
    _must(activation in ACTIVATIONS and len(weights) > 0 and all(row.ndim == 1 for row in offsets))
    widths = [n_inputs, *(len(row) for row in offsets)]
    _must(widths[-1] == n_outputs and all(w.shape == (a, b) for w, a, b in zip(weights, widths, widths[1:])))
    return Perceptron.of_layers(weights, offsets, activation)


def _is_sound(array: np.ndarray) -> bool:
    return array.dtype.kind == "f" and bool((np.abs(array) < _LARGEST).all())  # NaN is not below anything


def _must(is_sound: bool) -> None:
    if not is_sound:
        raise ValueError("its parts do not belong together")
