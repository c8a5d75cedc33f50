"""The face that is posed by motion units or by keyframes, each following the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.jobs import JobRunner
from app.panels.units.work import CAPTURED, Learned, LearnRequest, learn
from app.texts import units as texts
from core.iface.keyframes import Keyframes
from core.iface.motion_unit import NEUTRAL
from core.iface.unit_pose import UnitPose


class UnitsDraft(QObject):
    """What is on show; a job that is cancelled or fails changes nothing.

    learned : None before the first answer
    pose : of the units; moved : the face on show, shape (n_markers, 3), mm from neutral
    weights : of the keyframes, empty where there are none
    by_keyframes : whether the face is that of the keyframes, which the units follow; off_mm : how near the one that
        follows comes, root mean square distance of a marker

    trouble : why there are none, in a sentence; else nothing

    changed() : something else is to be shown
    """

    changed = Signal()

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._jobs = jobs
        self.learned: Learned | None = None
        self.trouble = ""
        self.source, self.of_displacements, self.bounded = CAPTURED, True, False
        self._forget()

    def _forget(self) -> None:
        self.pose: UnitPose | None = None
        self.moved: np.ndarray | None = None
        self.weights = np.zeros(0)
        self.by_keyframes, self.off_mm = False, 0.0

    # What is learned

    def learn(self, request: LearnRequest | None) -> None:
        """Learn units anew; None is for no database."""
        if request is None:
            self._jobs.cancel("units")
            self._show_none("")
        else:
            self._jobs.start("units", texts.LEARNING, request, learn, self._on_learned,
                             lambda error: self._show_none(str(error)))  # fmt: skip

    def _show_none(self, trouble: str) -> None:
        self.learned, self.trouble = None, trouble
        self._forget()
        self.changed.emit()

    def _on_learned(self, learned: Learned) -> None:
        before, self.learned, self.trouble = self.learned, learned, ""
        if self.source not in learned.keyframes:
            self.source = next(iter(learned.keyframes), CAPTURED)
        same = before is not None and before.request.database is learned.request.database
        if same and self.pose is not None:
            # other units for the same face
            known = self.pose.expression in (NEUTRAL, *learned.units.expressions)
            expression = self.pose.expression if known else NEUTRAL
            self._take(UnitPose.nearest(learned.units, self.moved, expression, self.pose.intensity))
        else:
            self._take(UnitPose.mean(learned.units))

    # The face

    @property
    def keyframes(self) -> Keyframes | None:
        """The keyframes that are chosen, in the form that is chosen."""
        if self.learned is None or self.source not in self.learned.keyframes:
            return None
        return replace(self.learned.keyframes[self.source], of_displacements=self.of_displacements)

    def set_unit(self, unit: int, deviation: float) -> None:
        """Move one unit; the keyframes follow."""
        self._take(self.pose.moved(unit, deviation))

    def set_expression(self, expression: str, intensity: float) -> None:
        """Add the units of another expression, or this one more or less."""
        pose = self.pose
        if expression != pose.expression:
            spoken = pose.deviations[: pose.n_spoken]
            mean = UnitPose.mean(pose.units, expression)
            pose = replace(mean, deviations=np.concatenate([spoken, mean.deviations[pose.n_spoken :]]))
        self._take(replace(pose, intensity=intensity))

    def set_keyframe(self, row: int, weight: float) -> None:
        """Give one keyframe another weight; the units follow."""
        self.weights = self.weights.copy()
        self.weights[row] = weight
        self._follow_keyframes()

    def reset(self) -> None:
        """Show the mean face of the speech."""
        self._take(replace(self.pose, deviations=np.zeros_like(self.pose.deviations)))

    def rest(self) -> None:
        """Show what the units can of the neutral face."""
        at_rest = np.zeros((self.pose.units.n_points, self.pose.units.n_axes))
        self._take(UnitPose.nearest(self.pose.units, at_rest, self.pose.expression, self.pose.intensity))

    def set_form(self, source: str, of_displacements: bool, bounded: bool) -> None:
        """Choose other keyframes, or another form of their weights, for the face on show."""
        self.source, self.of_displacements, self.bounded = source, of_displacements, bounded
        if self.pose is not None:
            self._take(self.pose)

    def _take(self, pose: UnitPose) -> None:
        self.pose, self.moved, self.by_keyframes = pose, pose.deformation(), False
        keyframes = self.keyframes
        if keyframes is None:
            self.weights, self.off_mm = np.zeros(0), 0.0
        else:
            self.weights = keyframes.weights(self.moved + keyframes.neutral, self.bounded)
            self.off_mm = _off_mm(keyframes.faces(self.weights) - keyframes.neutral, self.moved)
        self.changed.emit()

    def _follow_keyframes(self) -> None:
        keyframes, pose = self.keyframes, self.pose
        self.moved, self.by_keyframes = keyframes.faces(self.weights) - keyframes.neutral, True
        self.pose = UnitPose.nearest(pose.units, self.moved, pose.expression, pose.intensity)
        self.off_mm = _off_mm(self.pose.deformation(), self.moved)
        self.changed.emit()


def _off_mm(found: np.ndarray, wanted: np.ndarray) -> float:
    return float(np.sqrt(np.square(found - wanted).sum(axis=-1).mean()))
