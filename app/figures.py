"""Figures of faces for papers and reports: the keyframes of figure 4, each motion unit by itself."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from app.pictures import FaceRig, face_pictures
from app.texts import units as texts
from core.face.default_face import character_face
from core.face.lip_contact import LipContact
from core.iface.keyframes import Keyframes
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.iface.paper_keyframes import drawn_units, paper_keyframes
from core.iface.unit_pose import UnitPose
from core.media.picture_grid import PictureRow, picture_grid
from core.progress import SILENT, Progress
from core.rig.rig import Rig

CELL_PX = (256, 320)
_COLUMNS = 4  # as in the paper
_UNIT_AT, _UNIT_COLUMNS = (-2.0, 0.0, 2.0), 9


def drawn_figure(character: str, progress: Progress = SILENT, cell_px: tuple[int, int] = CELL_PX) -> np.ndarray:
    """Return figure 4 as the units of a character draw it, uint8, shape (height, width, 3)."""
    rig = Rig.of(character_face(character, progress.part(0.0, 0.2)))
    moved = rig.moved(drawn_units(rig.names))
    lips = LipContact.of(rig.face)
    for one in moved:
        if lips is not None:
            lips.apply(one)
    cells = _cells(rig.face, [rig.neutral + one for one in moved], progress.part(0.2, 1.0), cell_px)
    return _in_rows(cells, tuple(paper_keyframes()), texts.FIGURE_DRAWN.format(face=character))


def marker_figure(
    keyframes: Keyframes, rig: FaceRig, title: str, drawn: Collection[str] = (), progress: Progress = SILENT,
    cell_px: tuple[int, int] = CELL_PX,
) -> np.ndarray:  # fmt: skip
    """Return figure 4 as markers move a face, uint8, shape (height, width, 3).

    drawn : keyframes that stand for captures that there are not, which is said under them
    """
    poses = [rig.pose((shape - keyframes.neutral).astype(np.float32)) for shape in keyframes.shapes]
    cells = _cells(rig.face, poses, progress, cell_px)
    notes = [texts.NOTE_DRAWN if name in drawn else "" for name in keyframes.names] if drawn else ()
    return _in_rows(cells, keyframes.names, title, notes)


def unit_poses(units: MotionUnits, expression: str = NEUTRAL) -> np.ndarray:
    """Return what `units_figure` draws: each unit two standard deviations below, at, and above the mean.

    returns : float32, shape (3, n_units, n_points, 3), mm from the neutral face
    """
    mean = UnitPose.mean(units, expression)
    return np.array(
        [[mean.moved(i, at).deformation() for i in range(len(mean.deviations))] for at in _UNIT_AT], np.float32
    )


def units_figure(
    poses: np.ndarray, names: Sequence[str], rig: FaceRig, progress: Progress = SILENT,
    cell_px: tuple[int, int] = CELL_PX,
) -> np.ndarray:  # fmt: skip
    """Return each unit to either side of its mean, a column each; see `unit_poses` and `unit_names`."""
    n_units = len(names)
    cells = _cells(rig.face, [rig.pose(pose) for at in poses for pose in at], progress, cell_px)
    rows = []
    for first in range(0, n_units, _UNIT_COLUMNS):
        stop = min(first + _UNIT_COLUMNS, n_units)
        for r, at in enumerate(_UNIT_AT):
            captions = names[first:stop] if r == len(_UNIT_AT) - 1 else ()
            rows.append(
                PictureRow(cells[r * n_units + first : r * n_units + stop], f"{at:+.0f} σ" if at else "0", captions)
            )
    return picture_grid(rows, texts.FIGURE_UNITS)


def unit_names(units: MotionUnits, expression: str = NEUTRAL) -> list[str]:
    """Return what the parameters of an expression are called: speech 1, speech 2, …, happiness 1, …"""
    n_spoken = units.n_parameters()
    names = [texts.SPEECH_UNIT.format(number=i + 1) for i in range(n_spoken)]
    return names + [f"{expression} {i + 1}" for i in range(units.n_parameters(expression) - n_spoken)]


def _cells(face, poses: Sequence[np.ndarray], progress: Progress, cell_px: tuple[int, int]) -> list[np.ndarray]:
    at_once = ((positions,) for positions in poses)
    return list(face_pictures((face,), at_once, len(poses), "face", *cell_px, progress))


def _in_rows(cells: Sequence[np.ndarray], names: Sequence[str], title: str, notes: Sequence[str] = ()) -> np.ndarray:
    starts = range(0, len(cells), _COLUMNS)
    spans = [slice(at, at + _COLUMNS) for at in starts]
    rows = [
        PictureRow(cells[span], captions=_lettered(names[span], span.start), notes=notes[span]) for span in spans
    ]  # fmt: skip
    return picture_grid(rows, title)


def _lettered(names: Sequence[str], first: int) -> list[str]:
    """(a) smile, (b) sad, (c) “a” …, as the paper writes them."""
    visemes = {name for name, keyframe in paper_keyframes().items() if keyframe.phone is not None}
    return [f"({chr(97 + first + n)}) {f'“{name}”' if name in visemes else name}" for n, name in enumerate(names)]
