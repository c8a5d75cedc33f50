"""`efase bench iface`: faces that hear, beside captures that they have not seen."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np

from core.animeme.artist_curves import CurveReading
from core.iface.ceiling import reached, said_again
from core.iface.comparison import Compared, Part, Trainer, compare, estimates, mouth_rows, split_by_frame, split_by_time
from core.iface.heard_takes import HeardTake, database_takes, recorded_takes
from core.iface.lip_scores import captured_scores
from core.iface.measures import largest_displacements
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ
from core.motion.database import MotionDatabase
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress

_AGAIN = ("again", "once more")  # seeds of the takes that the ceiling is measured on
_More = Callable[[SpeakingFace], dict[str, object]]


def bench_database(
    database: MotionDatabase, trainers: Mapping[str, Trainer], progress: Progress = SILENT
) -> dict[str, object]:
    """Measure by sentence, on what ``database`` holds out to test, and by frame as the paper did.

    On sentences of the bundled actress the ceiling is measured too: each is said twice again, with other seeds. Returns
    the object of ``--json``. Raises `UserFacingError` for a database that holds nothing out, or is without sound.
    """
    recordings = database.held_out_recordings("test")
    takes = database_takes(database, progress.part(0.0, 0.1))
    tune, test = (
        recorded_takes(database, said, progress.part(0.1, 0.15))
        for said in (database.held_out_recordings("tune"), recordings)
    )
    twice = _said_twice(database, [recording.sentence for recording in recordings])

    def more(face: SpeakingFace) -> dict[str, object]:
        lips = asdict(captured_scores(face, database, recordings))
        return {"lips": lips, **({"ceiling": _share(face, takes, twice, database.markers)} if twice else {})}

    by_sentence = _split(Part(takes, test), trainers, database.markers, more, progress.part(0.15, 0.6))
    by_frame = _split(split_by_frame([*takes, *tune, *test]), trainers, database.markers, None, progress.part(0.6, 1.0))
    return {
        "corpus": database.name, "synthetic": database.synthetic, "content_hash": database.content_hash,
        "splits": {"by sentence": by_sentence, "by frame": by_frame},
    }  # fmt: skip


def bench_curves(
    files: Sequence[Path], reading: CurveReading, trainers: Mapping[str, Trainer], progress: Progress = SILENT
) -> dict[str, object]:
    """Measure on takes of a studio's curves, moving the markers of the default face; the end of each take is the test.

    Raises `UserFacingError` for curves that cannot be read; see `core.iface.curve_takes`.
    """
    from core.face.marker_units import load_marker_units
    from core.iface.curve_takes import curve_takes

    units = load_marker_units()
    takes = curve_takes(files, reading, units, progress.part(0.0, 0.5))
    kept = tuple(name for name, keep in zip(units.markers.names, units.kept) if keep)
    groups = {group: tuple(n for n in names if n in kept) for group, names in units.markers.groups.items()}
    markers = MarkerSet(kept, units.markers.rest[units.kept], groups)
    part = split_by_time(takes)
    names = ", ".join(take.name for take in takes)
    return {
        "corpus": f"curves of {names}", "synthetic": False,
        "splits": {"by time": _split(part, trainers, markers, None, progress.part(0.5, 1.0))},
    }  # fmt: skip


def _split(
    part: Part, trainers: Mapping[str, Trainer], markers: MarkerSet, more: _More | None, progress: Progress
) -> dict[str, object]:
    faces = {}
    for i, (name, trainer) in enumerate(trainers.items()):
        began = time.perf_counter()
        found = compare(trainer, part, markers, progress.part(i / len(trainers), (i + 1) / len(trainers)))
        faces[name] = {"seconds_to_train_and_measure": round(time.perf_counter() - began, 1), **_as_dict(found)}
        if more is not None:
            faces[name] |= more(found.face)
    speech_s = {half: _seconds(getattr(part, half)) for half in ("train", "test")}
    return {"speech_s": speech_s, "faces": faces}


def _as_dict(found: Compared) -> dict[str, object]:
    return {
        half: {
            scope: {emotion: measured._asdict() for emotion, measured in by.items()}
            for scope, by in getattr(found, half).items()
        }
        for half in ("train", "test")
    }


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
    face: SpeakingFace, train: Sequence[HeardTake], twice: Sequence[Sequence[HeardTake]], markers: MarkerSet
) -> dict[str, dict[str, dict[str, float]]]:
    largest_mm = largest_displacements(np.concatenate([take.displacements[take.used] for take in train]))
    spoken = estimates(face, twice[0])

    def of(points: np.ndarray | None) -> dict[str, dict[str, float]]:
        return {emotion: row._asdict() for emotion, row in reached(spoken, twice, largest_mm, points).items()}

    mouth = mouth_rows(markers)
    return {"all markers": of(None), **({"lips and jaw": of(mouth)} if len(mouth) else {})}
