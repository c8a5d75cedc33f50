"""`efase bench iface`: faces that hear, beside captures that they have not seen."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import NamedTuple

import numpy as np

from core.animeme.artist_curves import CurveReading, curve_files
from core.iface.ceiling import reached, said_again
from core.iface.comparison import Part, Trainer, Yardstick, compare, estimates, split_by_frame, split_by_time
from core.iface.heard_takes import HeardTake, database_takes, recorded_takes
from core.iface.lip_scores import captured_scores
from core.iface.model_file import MODERN, PAPER, VARIANTS
from core.iface.modern_training import train_modern_face
from core.iface.paper_training import train_paper_face
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ
from core.iface.told import told_estimates
from core.iface.training import N_NOISES, check_variant
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress

_AGAIN = ("again", "once more")  # seeds of the takes that the ceiling is measured on


def trainers(variants: Sequence[str] = VARIANTS) -> dict[str, Trainer]:
    """Return what trains the ``variants`` of the face; raises `UserFacingError` for one that there is not."""
    for variant in variants:
        check_variant(variant)
    return {variant: {PAPER: _train_paper, MODERN: _train_modern}[variant] for variant in variants}


def _train_paper(takes: Sequence[HeardTake], markers: MarkerSet, progress: Progress) -> SpeakingFace:
    return train_paper_face(takes, markers.rest, progress=progress)


def _train_modern(takes: Sequence[HeardTake], markers: MarkerSet, progress: Progress) -> SpeakingFace:
    return train_modern_face(takes, markers, progress=progress)


def bench_database(
    database: MotionDatabase, trainers: Mapping[str, Trainer], progress: Progress = SILENT
) -> dict[str, object]:
    """Measure by sentence, on what ``database`` holds out to test, and by frame as the paper did.

    By sentence the animemes stand beside, which are told the phones and their times: how far a face would come that
    hears every sound right. On sentences of the bundled actress the ceiling is measured too, by saying each twice again
    with other seeds. Returns the object of ``--json``. Raises `UserFacingError` for a database that holds nothing out,
    or is without sound.
    """
    recordings = database.held_out_recordings("test")
    takes = database_takes(database, progress.part(0.0, 0.1), N_NOISES)
    tune, test = (
        recorded_takes(database, database.held_out_recordings(split), progress.part(0.1, 0.15), N_NOISES)
        for split in ("tune", "test")
    )
    split = Part(takes, test)
    yardstick = Yardstick.of(takes, database.markers)
    twice = _said_twice(database, [recording.sentence for recording in recordings])
    faces, measured = _split(split, trainers, database.markers, progress.part(0.15, 0.6))
    for name, face in faces.items():
        measured["faces"][name]["lips"] = asdict(captured_scores(face, database, recordings))
        if twice:
            measured["faces"][name]["ceiling"] = _share(estimates(face, test), twice, yardstick)
    spoken = told_estimates(database, test, progress.part(0.6, 0.65))
    measured["told"] = {"test": _as_dict(yardstick.measure(test, spoken))}
    if twice:
        measured["told"]["ceiling"] = _share(spoken, twice, yardstick)
    _, by_frame = _split(split_by_frame([*takes, *tune, *test]), trainers, database.markers, progress.part(0.65, 1.0))
    return {
        "corpus": database.name, "synthetic": database.synthetic, "content_hash": database.content_hash,
        "splits": {"by sentence": measured, "by frame": by_frame},
    }  # fmt: skip


def bench_curves(
    paths: Sequence[Path], reading: CurveReading, trainers: Mapping[str, Trainer], progress: Progress = SILENT
) -> dict[str, object]:
    """Measure on takes of a studio's curves, moving the markers of the default face; the end of each take is the test.

    paths : files of curves, or folders of them; see `core.animeme.artist_curves.curve_files`

    Raises `UserFacingError` for curves that cannot be read; see `core.iface.curve_takes`.
    """
    from core.face.marker_units import load_marker_units
    from core.iface.curve_takes import curve_takes

    units = load_marker_units()
    takes = curve_takes(curve_files(paths, reading), reading, units, progress.part(0.0, 0.5), N_NOISES)
    kept = tuple(name for name, keep in zip(units.markers.names, units.kept) if keep)
    groups = {group: tuple(n for n in names if n in kept) for group, names in units.markers.groups.items()}
    markers = MarkerSet(kept, units.markers.rest[units.kept], groups)
    _, by_time = _split(split_by_time(takes), trainers, markers, progress.part(0.5, 1.0))
    names = ", ".join(take.name for take in takes)
    return {"corpus": f"curves of {names}", "synthetic": False, "splits": {"by time": by_time}}


def _split(
    part: Part, trainers: Mapping[str, Trainer], markers: MarkerSet, progress: Progress
) -> tuple[dict[str, SpeakingFace], dict[str, dict]]:
    faces, figures = {}, {}
    for i, (name, trainer) in enumerate(trainers.items()):
        began = time.perf_counter()
        found = compare(trainer, part, markers, progress.part(i / len(trainers), (i + 1) / len(trainers)))
        faces[name] = found.face
        figures[name] = {
            "seconds_to_train_and_measure": round(time.perf_counter() - began, 1),
            "train": _as_dict(found.train), "test": _as_dict(found.test),
        }  # fmt: skip
    speech_s = {half: _seconds(getattr(part, half)) for half in ("train", "test")}
    return faces, {"speech_s": speech_s, "faces": figures}


def _as_dict(found: Mapping[str, Mapping[str, NamedTuple]]) -> dict[str, dict[str, dict[str, float]]]:
    return {scope: {emotion: row._asdict() for emotion, row in by.items()} for scope, by in found.items()}


def _seconds(takes: Sequence[HeardTake]) -> dict[str, float]:
    seconds = dict.fromkeys((take.emotion for take in takes), 0.0)
    for take in takes:
        seconds[take.emotion] += float(take.used.sum()) / RATE_HZ
    return {emotion: round(found, 1) for emotion, found in seconds.items()}


def _said_twice(database: MotionDatabase, sentences: Sequence[str]) -> list[list[HeardTake]]:
    """The bundled actress says ``sentences`` twice; nothing for sentences of anybody else."""
    from core.actress.corpus import CORPUS_NAME, comparison_sentences

    spoken = {line.sentence: line for line in comparison_sentences()}
    if database.name != CORPUS_NAME or not spoken.keys() >= set(sentences):
        return []
    return [
        recorded_takes(database, [said_again(spoken[name], f"{name} {seed}") for name in sentences]) for seed in _AGAIN
    ]


def _share(
    spoken: Sequence[np.ndarray], twice: Sequence[Sequence[HeardTake]], yardstick: Yardstick
) -> dict[str, dict[str, dict[str, float]]]:
    return _as_dict({
        name: reached(spoken, twice, yardstick.largest_mm, points) for name, points in yardstick.scopes.items()
    })  # fmt: skip
