"""Motion units of a database in figures and pictures, as `efase units` asks for them."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.demo import open_named
from app.figures import drawn_figure, marker_figure, unit_names, unit_poses, units_figure
from app.pictures import FaceRig
from app.texts import units as texts
from core.errors import UserFacingError
from core.face.characters import CHARACTERS, DEFAULT
from core.face.default_face import FaceUnavailable, character_face
from core.face.face import Face
from core.iface.coverage import covered_by_count
from core.iface.keyframes import Keyframes
from core.iface.motion_unit import NEUTRAL, PAPER_UTTERANCE, MotionUnits, MotionUnitSet
from core.iface.paper_keyframes import captured_keyframes, drawn_keyframes
from core.iface.units_of_database import spoken_deformations, units_of_database
from core.media.image_sequence import write_png
from core.media.swap_in import check_target
from core.motion.curation import CurationList
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

CAPTURED, DRAWN = "captured", "drawn"
_LISTED = 12
_MEASURED_FRAMES = 100


@dataclass(frozen=True)
class UnitsJob:
    """Everything that `efase units` was told.

    utterance, expression : how many units, or the share (below 1) that they shall cover
    keyframes : `CAPTURED` or `DRAWN`; face : a character
    picture : where the keyframes are drawn, as figure 4; units_picture : each unit to either side of its mean
    """

    database: Path | None = None
    utterance: int | float = PAPER_UTTERANCE
    expression: int | float = 2
    keyframes: str = CAPTURED
    face: str = DEFAULT
    picture: Path | None = None
    units_picture: Path | None = None


def run(job: UnitsJob, progress: Progress = SILENT) -> dict[str, object]:
    """Do the job and return the object of ``--json``; raises `UserFacingError` before anything is written."""
    outputs = [path for path in (job.picture, job.units_picture) if path is not None]
    _check(job, outputs)
    database = open_named(job.database, progress.part(0.0, 0.2))
    removed = frozenset(CurationList.of(database).read())
    units = units_of_database(database, job.utterance, job.expression, removed)
    moved = spoken_deformations(database, removed)
    shares = covered_by_count({NEUTRAL: moved[NEUTRAL]} | {e: moved[e] for e in units.expressions}, job.utterance)
    face = None
    with contextlib.suppress(FaceUnavailable):  # figures can be told without it
        face = character_face(job.face, progress.part(0.2, 0.3))
    keyframes, missing = _keyframes(job, database, face, removed)
    names = (NEUTRAL, *units.expressions)
    every = np.concatenate([moved[name] for name in names])
    answer = {
        "database": database.name,
        "synthetic": database.synthetic,
        "markers": len(database.markers),
        "frames": {name: len(moved[name]) for name in names},
        "database_covers": database.pca.coverage,
        "utterance": _in_figures(units.utterance, shares[NEUTRAL]),
        "expressions": {e: _in_figures(m, shares[e]) for e, m in units.expressions.items()},
        "units_off_mm": {name: _off_mm(moved[name], _through_units(units, name, moved[name])) for name in names},
        "keyframes": {"source": job.keyframes, "names": list(keyframes.names), "drawn": list(missing),
                      "off_mm": _keyframes_off_mm(keyframes, every)},
        "outputs": [str(path) for path in outputs],
    }  # fmt: skip
    if outputs:
        _draw(job, database, units, keyframes, missing, progress.part(0.3, 1.0))
    return answer


def in_words(answer: dict) -> str:
    """Return ``answer`` of `run` as a table to read."""
    sets = {NEUTRAL: answer["utterance"], **answer["expressions"]}
    lines = [f"{answer['database']}: {sum(answer['frames'].values())} frames of speech, {answer['markers']} markers"]
    for name, found in sets.items():
        what = "of neutral speech" if name == NEUTRAL else "of what they leave"
        lines.append(f"{name:<10} {found['count']:>2} units cover {found['covered']:.2%} {what}")
    lines.append("")
    lines.append("units  " + "".join(f"{name:>11}" for name in sets))
    most = max(len(found["covered_by_count"]) for found in sets.values())
    for n in range(1, min(_LISTED, most - 1) + 1):
        cells = [found["covered_by_count"][min(n, len(found["covered_by_count"]) - 1)] for found in sets.values()]
        lines.append(f"{n:>5}  " + "".join(f"{cell:>11.2%}" for cell in cells))
    keyframes = answer["keyframes"]
    lines.append("")
    lines.append(f"{len(keyframes['names'])} keyframes ({keyframes['source']}), how far they stay from the captures:")
    for form, off in keyframes["off_mm"].items():
        lines.append(f"  {form:<14} {off['unbounded']:.2f} mm, {off['bounded']:.2f} mm with weights in 0 to 1")
    if keyframes["drawn"] and keyframes["source"] == CAPTURED:
        lines.append(f"  not captured, so drawn: {', '.join(keyframes['drawn'])}")
    return "\n".join([*lines, *answer["outputs"]])


def _check(job: UnitsJob, outputs: list[Path]) -> None:
    if job.keyframes not in (CAPTURED, DRAWN):
        raise UserFacingError(f"Keyframes are {CAPTURED} or {DRAWN}, not '{job.keyframes[:40]}'.")
    if job.face not in CHARACTERS:
        raise UserFacingError(f"There is no character '{job.face[:60]}'.", f"Choose one of {', '.join(CHARACTERS)}.")
    for path in outputs:
        if path.suffix.lower() != ".png":
            raise UserFacingError(f"'{path}' is no .png, as which pictures are written.")
        check_target(path)
    if len(outputs) != len({path.resolve() for path in outputs}):
        raise UserFacingError(f"'{outputs[0]}' was named for both pictures.")


def _keyframes(
    job: UnitsJob, database: MotionDatabase, face: Face | None, removed: frozenset[str]
) -> tuple[Keyframes, tuple[str, ...]]:
    if job.keyframes == CAPTURED:
        return captured_keyframes(database, face, removed=removed)
    if face is None:
        face = character_face(job.face)
    keyframes = drawn_keyframes(face, database.markers)
    return keyframes, keyframes.names


def _in_figures(units: MotionUnitSet, shares: np.ndarray) -> dict[str, object]:
    return {"count": len(units.units), "covered": units.coverage, "std_mm": np.sqrt(units.variance).tolist(),
            "covered_by_count": shares.tolist()}  # fmt: skip


def _through_units(units: MotionUnits, expression: str, moved: np.ndarray) -> np.ndarray:
    return units.deformations(units.parameters(moved, expression), expression)


def _keyframes_off_mm(keyframes: Keyframes, moved: np.ndarray) -> dict[str, dict[str, float]]:
    """How far mixes of keyframes stay from captured frames, in both forms, with and without bounds."""
    frames = moved[:: max(1, len(moved) // _MEASURED_FRAMES)]
    off = {}
    for form, of_displacements in (("as printed", False), ("displacements", True)):
        mixing = Keyframes(keyframes.names, keyframes.shapes, keyframes.neutral, of_displacements)
        off[form] = {
            name: _off_mm(frames, mixing.faces(mixing.weights(frames + mixing.neutral, bounded)) - mixing.neutral)
            for name, bounded in (("unbounded", False), ("bounded", True))
        }
    return off


def _off_mm(wanted: np.ndarray, found: np.ndarray) -> float:
    """Root mean square distance of a marker."""
    return float(np.sqrt(np.square(wanted - found).sum(axis=-1).mean()))


def _draw(
    job: UnitsJob, database: MotionDatabase, units: MotionUnits, keyframes: Keyframes, missing: tuple[str, ...],
    progress: Progress,
) -> None:  # fmt: skip
    rig = FaceRig.of(job.face, database.markers, progress=progress.part(0.0, 0.2))
    if job.picture is not None:
        stage = progress.part(0.2, 0.6)
        if job.keyframes == DRAWN:
            picture = drawn_figure(job.face, stage)
        else:
            title = texts.FIGURE_CAPTURED.format(name=database.name)
            picture = marker_figure(keyframes, rig, title, missing, stage)
        write_png(job.picture, picture)
    if job.units_picture is not None:
        expression = next(iter(units.expressions), NEUTRAL)
        poses, names = unit_poses(units, expression), unit_names(units, expression)
        write_png(job.units_picture, units_figure(poses, names, rig, progress.part(0.6, 1.0)))
