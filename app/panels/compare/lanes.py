"""What the graph of the compare window draws: lanes of lines over the same frames."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from app.texts import compare as texts
from core.evaluation.side_by_side import CAPTURED, DIFFERENCE, ERROR, GAP, LIP_DIFFERENCE, LIP_ERROR, WIDTH, SideBySide
from core.rig.control_track import ControlTrack


class Line(NamedTuple):
    """One line: whose it is, as a key of `app.texts.compare.GRAPH_NAMES`, and its values, shape (n_frames,)."""

    key: str
    values: np.ndarray


class Lane(NamedTuple):
    """Lines that share an axis; one that begins at 0 does so even where all lines are far above."""

    title: str
    unit: str
    lines: tuple[Line, ...]
    begins_at_0: bool = False


def lanes_of(
    beside: SideBySide, of_lips: bool, control: str = "", controls: Mapping[str, ControlTrack] | None = None
) -> tuple[Lane, ...]:
    """Return the lanes that have something to show, from gap to error.

    of_lips : errors of the lips alone; control : what the second lane shows instead of the lip width, out of the
        ``controls`` by motion
    """
    second = Lane(texts.WIDTH, texts.MM, _of_each(beside, WIDTH))
    if control:
        tracks = {} if controls is None else controls
        second = Lane(control, "", tuple(Line(_key(beside, name), track.column(control))
                                         for name, track in tracks.items()))  # fmt: skip
    between = tuple(
        Line(key, course.values_mm)
        for key, measure in (("face", DIFFERENCE), ("lips", LIP_DIFFERENCE))
        for course in beside.courses
        if course.measure == measure
    )
    error = Lane(texts.LIP_ERROR, texts.MM, _of_each(beside, LIP_ERROR), True)
    if not of_lips or not error.lines:
        error = Lane(texts.ERROR, texts.MM, _of_each(beside, ERROR), True)
    lanes = (Lane(texts.GAP, texts.MM, _of_each(beside, GAP)), second,
             Lane(texts.DIFFERENCE, texts.MM, between, True), error)  # fmt: skip
    return tuple(lane for lane in lanes if lane.lines)


def _of_each(beside: SideBySide, measure: str) -> tuple[Line, ...]:
    return tuple(Line(_key(beside, c.of), c.values_mm) for c in beside.courses if c.measure == measure)


def _key(beside: SideBySide, name: str) -> str:
    """Whose line it is: the capture is always drawn as such, also as one of the two."""
    if name == CAPTURED:
        return CAPTURED
    return ("one", "other")[beside.names.index(name)]
