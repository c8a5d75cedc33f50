"""A face whose skin has moved: tongue, eyeballs and head take their own places in it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.face.face import Face
from core.face.pose import Eyeballs, Head, TongueShape


@dataclass(frozen=True)
class MovingParts:
    """Tongue, eyeballs and head of one face, found the first time they are asked for."""

    face: Face

    @cached_property
    def _head(self) -> Head:
        return Head.of(self.face)

    @cached_property
    def _eyeballs(self) -> Eyeballs:
        return Eyeballs.of(self.face)

    @cached_property
    def _tongue(self) -> TongueShape | None:
        return TongueShape.of(self.face)

    def place(
        self,
        moved: np.ndarray,
        head: tuple[np.ndarray, np.ndarray] | None = None,
        gaze: tuple[float, float] | np.ndarray | None = None,
        tongue: tuple[float, float, float] | np.ndarray | None = None,
    ) -> np.ndarray:
        """Return the vertices of one frame, mm, float32, shape (V, 3).

        moved : shape (V, 3), mm, how the skin has moved; changed
        head : rotation vector (radians) and translation (mm); eyes and teeth go with the head, the base of the neck
            stays. None keeps it still
        gaze : yaw to the character's left and pitch up, degrees; the eyeballs turn about their centres
        tongue : tip, back and advance, as `core.face.tongue.tongue_track` gives them; None lets the jaw carry it
        """
        if tongue is not None and self._tongue is not None:
            self._tongue.bend(moved, self.face.positions, *map(float, tongue))
        positions = self.face.positions + moved
        if gaze is not None:
            self._eyeballs.turn(positions, float(gaze[0]), float(gaze[1]))
        if head is not None:
            positions = self._head.move(positions, *head)
        return positions
