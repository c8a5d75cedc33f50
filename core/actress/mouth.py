"""What can be measured at a talker's mouth, whoever talks: lip gap, width, closure and speed of every phone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from core.motion.marker_set import MarkerSet
from core.speech.phoneme import PAU
from core.speech.transcript import Transcript

# Sampled positions are read between their samples by a cubic spline, in steps of this.
FINE_STEP_S = 0.005


class PhoneMeasure(NamedTuple):
    """One phone as the mouth makes it.

    gap_mm : mean distance of the inner lips over the middle half of the phone
    width_mm : mean distance of the mouth corners over the same time
    closure_mm : smallest distance of the inner lips within the phone
    speed_mm_s : greatest speed of opening or closing within the phone
    """

    gap_mm: float
    width_mm: float
    closure_mm: float
    speed_mm_s: float


@dataclass(frozen=True)
class MouthCourse:
    """Lip gap and mouth width over time, both float64, shape (n_frames,), mm; frame f is at f / rate_hz."""

    gap_mm: np.ndarray
    width_mm: np.ndarray
    rate_hz: float


def mouth_course(face: np.ndarray, markers: MarkerSet, rate_hz: float) -> MouthCourse:
    """Read gap and width off markers in head space, as the camera in front sees them (no depth).

    face : shape (n_frames, n_markers, 3), millimetres
    """
    upper, lower = markers.landmark("upper_lip"), markers.landmark("lower_lip")
    left, right = markers.landmark("mouth_corner_left"), markers.landmark("mouth_corner_right")
    gap_mm = face[:, upper, 1] - face[:, lower, 1]
    width_mm = np.linalg.norm(face[:, left, :2] - face[:, right, :2], axis=1)
    return MouthCourse(gap_mm, width_mm, rate_hz)


def measure_phones(transcript: Transcript, mouth: MouthCourse) -> list[tuple[str, PhoneMeasure]]:
    """Measure all phones but silence that lie within the course; (phone, measure) in their order."""
    times_s = np.arange(len(mouth.gap_mm)) / mouth.rate_hz
    gap_mm, width_mm = CubicSpline(times_s, mouth.gap_mm), CubicSpline(times_s, mouth.width_mm)
    speed_mm_s = gap_mm.derivative()
    measured = []
    for u in transcript.phonemes:
        if u.phone == PAU or u.end_s > times_s[-1]:
            continue
        within_s = np.arange(u.start_s, u.end_s, FINE_STEP_S)
        quarter_s = (u.end_s - u.start_s) / 4
        middle_s = within_s[np.abs(within_s - (u.start_s + u.end_s) / 2) <= quarter_s + FINE_STEP_S / 2]
        measure = PhoneMeasure(
            float(gap_mm(middle_s).mean()),
            float(width_mm(middle_s).mean()),
            float(gap_mm(within_s).min()),
            float(np.abs(speed_mm_s(within_s)).max()),
        )
        measured.append((u.phone, measure))
    return measured
