"""The synthetic actress at work: a transcript and an emotion become the course of her 52 face units."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from scipy.ndimage import gaussian_filter1d

from core.actress.dynamics import follow
from core.actress.expression import blink_course, blink_times_s, expression, manners
from core.actress.gaze import gaze_course
from core.actress.gestures import gesture_score, tract_variables
from core.actress.randomness import Chance
from core.face.marker_units import MarkerUnits, load_marker_units
from core.speech.transcript import Transcript

# Articulators are moved in steps no longer than this.
LONGEST_STEP_S = 1 / 240
EFFORT_VARIATION = 0.05
# Skin and muscle do not follow what moves them at once: above some 20 Hz nothing of a face moves.
TISSUE_S = 0.008
# A smile gives way to lip rounding by this share.
SMILE_YIELDS = 0.45
# Lips that meet give a little: over this distance, and over this share of their way.
CONTACT_MM = 0.3
CONTACT_SHARE = 0.08


@cache
def bundled_marker_units() -> MarkerUnits:
    """Return the units of the default face at the actress's markers."""
    return load_marker_units()


def frame_times_s(duration_s: float, rate_hz: float) -> np.ndarray:
    """Return the times of all frames that begin within ``duration_s``; float64, shape (n_frames,)."""
    return np.arange(max(1, math.ceil(duration_s * rate_hz - 1e-6))) / rate_hz


def perform(transcript: Transcript, emotion: str, seed: str, rate_hz: float = 120.0) -> np.ndarray:
    """Act a transcript: articulation, expression and blinks.

    seed : names the variation of this performance; the same seed gives the same motion
    returns : float64, shape (n_frames, n_units), 0..1, columns as ``bundled_marker_units().names``; frame f is at
        f / rate_hz
    """
    names = bundled_marker_units().names
    manner = manners()[emotion]
    times_s = frame_times_s(transcript.duration_s, rate_hz)
    variables = _articulate(transcript, manner.effort, manner.pace, times_s, rate_hz, Chance(f"{seed} gestures"))

    units = expression(transcript, emotion, times_s, names, Chance(f"{seed} expression"))
    column = {name: u for u, name in enumerate(names)}
    for side in ("Left", "Right"):
        units[:, column[f"mouthSmile{side}"]] *= 1 - SMILE_YIELDS * np.clip(variables["round"], 0, 1)
    for variable in tract_variables():
        if variable.name == "closure":
            continue
        for unit, weight in variable.units.items():
            units[:, column[unit]] += weight * variables[variable.name]
    blink = blink_course(times_s, blinks_of(transcript, emotion, seed))
    for side in ("Left", "Right"):
        lid = column[f"eyeBlink{side}"]
        units[:, lid] += blink * (1 - units[:, lid])
    units = np.clip(units, 0, 1)
    _meet_lips(units, variables["closure"], column)
    return np.clip(units, 0, 1)


def blinks_of(transcript: Transcript, emotion: str, seed: str) -> np.ndarray:
    """Return when the blinks of a performance begin, in seconds; float64."""
    return blink_times_s(transcript.duration_s, manners()[emotion].seconds_between_blinks, Chance(f"{seed} blinks"))


def gaze(transcript: Transcript, emotion: str, seed: str, rate_hz: float = 120.0) -> np.ndarray:
    """Return where the eyes of a performance look; float64, shape (n_frames, 2), degrees: yaw (her left), pitch (up).

    The angles are those of the eyes in the head. ``seed`` as in `perform`.
    """
    manner = manners()[emotion]
    times_s = frame_times_s(transcript.duration_s, rate_hz)
    blinks_s = blinks_of(transcript, emotion, seed)
    chance = Chance(f"{seed} gaze")
    return gaze_course(times_s, manner.look_s, manner.away_share, manner.gaze_down_deg, blinks_s, chance)


def _articulate(
    transcript: Transcript, effort: float, pace: float, times_s: np.ndarray, rate_hz: float, chance: Chance
) -> dict[str, np.ndarray]:
    substeps = max(1, math.ceil(1 / rate_hz / LONGEST_STEP_S - 1e-9))
    step_s = 1 / (rate_hz * substeps)
    # beyond the last frame, so that smoothing has something to look at there
    margin = math.ceil(4 * TISSUE_S / step_s)
    fine_s = np.arange(len(times_s) * substeps + margin) * step_s
    effort *= 1 + EFFORT_VARIATION * float(chance.normal(1)[0])
    score = gesture_score(transcript, fine_s, effort, pace, chance)
    path = follow(score, step_s, start=score.targets[0])
    index = {variable.name: i for i, variable in enumerate(tract_variables())}
    path[:, index["closure"]] = _soft_contact(path[:, index["closure"]])
    path = gaussian_filter1d(path, TISSUE_S / step_s, axis=0, mode="nearest")[::substeps][: len(times_s)]
    return {name: path[:, i] for name, i in index.items()}


def _soft_contact(closure: np.ndarray) -> np.ndarray:
    """Stop a closing gesture at contact, 1, however far beyond it aims, without a kink."""
    way = 1 - closure
    return np.clip(1 - 0.5 * (np.sqrt(way**2 + CONTACT_SHARE**2) + way), 0, 1)


def _meet_lips(units: np.ndarray, closure: np.ndarray, column: dict[str, int]) -> None:
    """Let the lips take back the share ``closure`` of whatever opens them, and never pass through each other.

    Lip aperture is one tract variable that jaw and lips reach together: its opening in mm is linear in the units, so
    what the lips have to make up for is known exactly.

    units : float64, shape (n_frames, n_units), changed in place
    closure : float64, shape (n_frames,), 0..1
    """
    gap_mm = lip_gap_of_units_mm()
    parting = ("mouthLowerDownLeft", "mouthLowerDownRight")
    parting_mm = sum(gap_mm[column[name]] for name in parting)
    opening_mm = units @ gap_mm
    pressed_mm = 0.5 * (np.sqrt(opening_mm**2 + CONTACT_MM**2) - opening_mm)
    for name in parting:
        units[:, column[name]] += pressed_mm / parting_mm
    units[:, column["mouthClose"]] += closure * (opening_mm + pressed_mm) / -gap_mm[column["mouthClose"]]


@cache
def lip_gap_of_units_mm() -> np.ndarray:
    """Return by how many mm every unit opens the lips in their middle; float64, shape (n_units,)."""
    known = bundled_marker_units()
    upper, lower = known.markers.landmark("upper_lip"), known.markers.landmark("lower_lip")
    return (known.moves[:, upper, 1] - known.moves[:, lower, 1]).astype(float)
