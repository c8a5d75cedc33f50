"""Two motions of the same speech side by side, and each beside the capture of it, if it was captured."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from core.evaluation import measures
from core.evaluation.comparison import CapturedTruth, scores
from core.motion.recording import Recording
from core.motion.resample import resample
from core.speech.transcript import Transcript
from core.synthesis.marker_motion import MarkerMotion

CAPTURED = "captured"
GAP, WIDTH = "lip gap", "lip width"
DIFFERENCE, LIP_DIFFERENCE = "difference", "lip difference"
ERROR, LIP_ERROR = "error", "lip error"


class Course(NamedTuple):
    """One measure over time.

    measure : `GAP`, `WIDTH`, `DIFFERENCE` ...; of : whose, by name; nothing for what lies between the two
    values_mm : shape (n_frames,), NaN where the capture cannot be used
    """

    measure: str
    of: str
    values_mm: np.ndarray


@dataclass(frozen=True)
class Agreement:
    """How near ``of`` is to ``standard``, which is taken for a capture; None where the markers do not tell.

    rms_mm : root of the error of equation 12 (Deng and Neumann 2008); mean_mm : mean distance; both over all markers
        and frames, lip_* over those of the lips
    gap_r, width_r : Pearson's r of lip gap and lip width
    gap_variance_ratio, velocity_variance_ratio : of the lip gap, see `core.evaluation.comparison.Scores`
    """

    of: str
    standard: str
    rms_mm: float | None
    mean_mm: float | None
    lip_rms_mm: float | None
    lip_mean_mm: float | None
    gap_r: float | None
    width_r: float | None
    gap_variance_ratio: float | None
    velocity_variance_ratio: float | None


@dataclass(frozen=True, eq=False)
class SideBySide:
    """Two motions at the same frames.

    names : of the two, all different; `CAPTURED` for the capture itself
    motions : of the two, at the rate of the capture, or without one at the higher of their own
    transcript : what is said, for both
    truth : how the actor said it, or None
    """

    names: tuple[str, str]
    motions: tuple[MarkerMotion, MarkerMotion]
    transcript: Transcript
    truth: CapturedTruth | None = None

    @classmethod
    def of(
        cls,
        names: tuple[str, str],
        motions: tuple[MarkerMotion | None, MarkerMotion | None],
        transcript: Transcript,
        truth: CapturedTruth | None = None,
    ) -> SideBySide:
        """Bring two motions to the same frames, as `core.motion.resample` does; None stands for the capture."""
        made = [motion for motion in motions if motion is not None]
        if truth is None:
            rate_hz = max(motion.rate_hz for motion in made)
            n_frames = max(1, round(transcript.duration_s * rate_hz))
        else:
            rate_hz, n_frames = truth.rate_hz, len(truth.positions)

        def brought(motion: MarkerMotion | None) -> MarkerMotion:
            if motion is None:
                return MarkerMotion(truth.positions.astype(np.float32), rate_hz, truth.markers)
            positions = resample(motion.positions, motion.rate_hz, rate_hz, n_frames)
            return MarkerMotion(positions.astype(np.float32), rate_hz, motion.markers)

        return cls(names, (brought(motions[0]), brought(motions[1])), transcript, truth)

    @property
    def rate_hz(self) -> float:
        """Frames a second."""
        return self.motions[0].rate_hz

    @property
    def n_frames(self) -> int:
        """How many there are; frame f stands at f / rate_hz."""
        return len(self.motions[0].positions)

    @cached_property
    def _standards(self) -> dict[str, CapturedTruth]:
        """Each motion as if it had been captured, and the capture itself."""
        found = {}
        every = np.ones(self.n_frames, bool)
        for name, motion in zip(self.names, self.motions):
            markers = motion.markers
            as_recorded = Recording(name, "neutral", motion.positions, markers.names, motion.rate_hz, self.transcript)
            found[name] = CapturedTruth(as_recorded, markers, motion.positions.astype(float), every, None)
        return found if self.truth is None else found | {CAPTURED: self.truth}

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """Who is held against whom: the two, the capture last, and where it is neither, each against it."""
        one, other = self.names
        if one == CAPTURED:
            return ((other, one),)
        beside = () if self.truth is None or other == CAPTURED else ((one, CAPTURED), (other, CAPTURED))
        return ((one, other), *beside)

    @cached_property
    def agreements(self) -> tuple[Agreement, ...]:
        """Figures of all `pairs`."""
        return tuple(agreement(name, self._standards[name].positions, self._standards[standard], standard)
                     for name, standard in self.pairs)  # fmt: skip

    @cached_property
    def courses(self) -> tuple[Course, ...]:
        """All measures over time: gap and width of each, what lies between the two, errors of each but the capture."""
        standards, lips = self._standards, self.motions[0].markers.group("lips")
        found = []
        for measure, read in ((GAP, CapturedTruth.gap_mm), (WIDTH, CapturedTruth.width_mm)):
            for name, standard in standards.items():
                values_mm = read(standard, standard.positions)
                if values_mm is not None:
                    found.append(Course(measure, name, np.where(standard.usable, values_mm, np.nan)))
        for n, (name, against) in enumerate(self.pairs):
            of, whole, of_lips = (name, ERROR, LIP_ERROR) if n else ("", DIFFERENCE, LIP_DIFFERENCE)
            here, there = standards[name], standards[against]
            usable = here.usable & there.usable
            found.append(Course(whole, of, _apart_mm(here.positions, there.positions, usable)))
            if len(lips):
                found.append(Course(of_lips, of, _apart_mm(here.positions[:, lips], there.positions[:, lips], usable)))
        return tuple(found)


def agreement(of: str, positions: np.ndarray, standard: CapturedTruth, name: str) -> Agreement:
    """Measure ``positions``, mm, frame by frame those of ``standard``, as `efase evaluate` measures engines."""
    usable, lips = standard.usable, standard.markers.group("lips")
    found = scores([(standard, positions)])
    width, standard_width = standard.width_mm(positions), standard.width_mm(standard.positions)
    any_usable = bool(usable.any())
    rms = lip_rms = mean = width_r = None
    if any_usable:
        here, there = positions[usable], standard.positions[usable]
        rms, mean = float(np.sqrt(found.error_mm2)), measures.distance_mm(here, there)
        if len(lips):
            lip_rms = float(np.sqrt(measures.error_mm2(here[:, lips], there[:, lips])))
        if width is not None:
            width_r = measures.correlation(width[usable], standard_width[usable])
    return Agreement(of, name, rms, mean, lip_rms, found.lip_error_mm, found.lip_gap_r, width_r,
                     found.gap_variance_ratio, found.velocity_variance_ratio)  # fmt: skip


def _apart_mm(here: np.ndarray, there: np.ndarray, usable: np.ndarray) -> np.ndarray:
    """Root of equation 12 for every frame by itself."""
    return np.where(usable, np.sqrt(measures.errors_per_frame_mm2(here, there)), np.nan)
