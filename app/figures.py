"""Figures of faces for papers and reports: the keyframes of figure 4, each motion unit by itself."""

from __future__ import annotations

from collections.abc import Sequence

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
_UNIT_AT = (-2.0, 0.0, 2.0)


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


def captured_figure(
    keyframes: Keyframes, rig: FaceRig, name: str, progress: Progress = SILENT, cell_px: tuple[int, int] = CELL_PX
) -> np.ndarray:
    """Return figure 4 as markers move a face, uint8, shape (height, width, 3); ``name`` is the database's."""
    poses = [rig.pose((shape - keyframes.neutral).astype(np.float32)) for shape in keyframes.shapes]
    cells = _cells(rig.face, poses, progress, cell_px)
    return _in_rows(cells, keyframes.names, texts.FIGURE_CAPTURED.format(name=name))


def units_figure(
    units: MotionUnits, rig: FaceRig, expression: str = NEUTRAL, progress: Progress = SILENT,
    cell_px: tuple[int, int] = CELL_PX,
) -> np.ndarray:  # fmt: skip
    """Return each unit at two standard deviations to either side of the mean, a column each."""
    mean = UnitPose.mean(units, expression)
    n_units = len(mean.deviations)
    poses = [rig.pose(mean.moved(i, at).deformation().astype(np.float32)) for at in _UNIT_AT for i in range(n_units)]
    cells = _cells(rig.face, poses, progress, cell_px)
    names = unit_names(units, expression)
    rows = [
        PictureRow(cells[r * n_units : (r + 1) * n_units], f"{at:+.0f} σ" if at else "0",
                   names if r == len(_UNIT_AT) - 1 else ())
        for r, at in enumerate(_UNIT_AT)
    ]  # fmt: skip
    return picture_grid(rows, texts.FIGURE_UNITS)


def unit_names(units: MotionUnits, expression: str = NEUTRAL) -> list[str]:
    """Return what the parameters of an expression are called: speech 1, speech 2, …, happiness 1, …"""
    n_spoken = units.n_parameters()
    names = [texts.SPEECH_UNIT.format(number=i + 1) for i in range(n_spoken)]
    return names + [f"{expression} {i + 1}" for i in range(units.n_parameters(expression) - n_spoken)]


def _cells(face, poses: Sequence[np.ndarray], progress: Progress, cell_px: tuple[int, int]) -> list[np.ndarray]:
    at_once = ((positions,) for positions in poses)
    return list(face_pictures((face,), at_once, len(poses), "face", *cell_px, progress))


def _in_rows(cells: Sequence[np.ndarray], names: Sequence[str], title: str) -> np.ndarray:
    starts = range(0, len(cells), _COLUMNS)
    rows = [PictureRow(cells[at : at + _COLUMNS], captions=_lettered(names[at : at + _COLUMNS], at)) for at in starts]
    return picture_grid(rows, title)


def _lettered(names: Sequence[str], first: int) -> list[str]:
    """(a) smile, (b) sad, (c) “a” …, as the paper writes them."""
    visemes = {name for name, keyframe in paper_keyframes().items() if keyframe.phone is not None}
    return [f"({chr(97 + first + n)}) {f'“{name}”' if name in visemes else name}" for n, name in enumerate(names)]
