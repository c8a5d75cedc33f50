"""Articulatory gestures: which targets the actress's articulators are asked for, and when.

After the task dynamics of articulatory phonology (Saltzman and Munhall 1989): a phone is a handful of gestures, each
an interval in which one tract variable is drawn to a target with some stiffness. Gestures of neighbouring phones
overlap; where they compete for a variable, target and stiffness are their mean weighted by activation and strength.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache

import numpy as np

from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER
from core.speech.phoneme import PAU
from core.speech.transcript import PhonemeUtterance, Transcript

# Activation rises and falls over this time; a step would make the acceleration jump.
RAMP_S = 0.03
# Sealing lips takes this time, however hurried the phone.
SEAL_S = 0.1
# A weak pull to rest that is always there; alone it decides only where no gesture is active.
REST_STRENGTH = 0.05
# The table's name of the silence after all speech, before which no breath is taken.
END = "end"
# How much one utterance of a phone differs from the next.
TARGET_VARIATION = 0.06
TIMING_VARIATION_S = 0.006


@dataclass(frozen=True)
class TractVariable:
    """One thing the mouth can do (a row of ``variables.csv``) and the face units that do it at full value 1."""

    name: str
    rest: float
    stiffness_rad_s: float
    follows_effort: bool
    units: dict[str, float]


@dataclass(frozen=True)
class Gesture:
    """One gesture of a phone (a row of ``gestures.csv``).

    Active from ``lead_s`` before the fraction ``begin`` of the phone to ``lag_s`` after its fraction ``end``.
    """

    variable: str
    target: float
    strength: float
    stiffness_rad_s: float
    lead_s: float
    lag_s: float
    begin: float
    end: float

    @property
    def seals(self) -> bool:
        """Whether the lips are to meet for good: the target lies beyond their contact."""
        return self.variable == "closure" and self.target > 1.1


@dataclass(frozen=True)
class GestureScore:
    """What every tract variable is drawn to in every step; all float64, shape (n_steps, n_variables)."""

    targets: np.ndarray
    stiffness_rad_s: np.ndarray


@cache
def tract_variables() -> tuple[TractVariable, ...]:
    """Return the tract variables of the table, in its order."""
    with open(DEMO_FOLDER / "variables.csv", encoding="utf-8", newline="") as lines:
        return tuple(
            TractVariable(
                row["variable"],
                float(row["rest"]),
                float(row["stiffness_rad_s"]),
                row["follows_effort"] == "1",
                {unit: float(weight) for unit, weight in (pair.split("=") for pair in row["units"].split())},
            )
            for row in csv.DictReader(lines)
        )


@cache
def gestures_of_phones() -> dict[str, tuple[Gesture, ...]]:
    """Return the gestures of every phone, and of `END`."""
    table: dict[str, list[Gesture]] = {}
    with open(DEMO_FOLDER / "gestures.csv", encoding="utf-8", newline="") as lines:
        for row in csv.DictReader(lines):
            numbers = ("target", "strength", "stiffness_rad_s", "lead_s", "lag_s", "from", "to")
            gesture = Gesture(row["variable"], *(float(row[name]) for name in numbers))
            for phone in row["phones"].split():
                table.setdefault(phone, []).append(gesture)
    return {phone: tuple(gestures) for phone, gestures in table.items()}


def gesture_score(
    transcript: Transcript, times_s: np.ndarray, effort: float, pace: float, chance: Chance
) -> GestureScore:
    """Lay the gestures of a transcript over time.

    times_s : float64, shape (n_steps,), seconds, evenly spaced
    effort : how far movements reach, 1 is normal; closures and the like are as complete as ever
    pace : stiffness of all gestures, 1 is normal
    """
    variables = tract_variables()
    index = {variable.name: i for i, variable in enumerate(variables)}
    weight = np.full((len(times_s), len(variables)), REST_STRENGTH)
    targets = weight * [variable.rest for variable in variables]
    stiffness = weight * [variable.stiffness_rad_s for variable in variables]
    for p, utterance in enumerate(transcript.phonemes):
        last = p + 1 == len(transcript.phonemes)
        for gesture in gestures_of_phones()[END if last and utterance.phone == PAU else utterance.phone]:
            i = index[gesture.variable]
            reach = effort if variables[i].follows_effort else 1.0
            vary, shift = chance.normal(2)
            target = gesture.target * reach * (1 + TARGET_VARIATION * vary)
            pull = gesture.strength * _activation(gesture, utterance, shift * TIMING_VARIATION_S, times_s)
            weight[:, i] += pull
            targets[:, i] += pull * target
            stiffness[:, i] += pull * gesture.stiffness_rad_s * pace
    return GestureScore(targets / weight, stiffness / weight)


def _activation(gesture: Gesture, utterance: PhonemeUtterance, shift_s: float, times_s: np.ndarray) -> np.ndarray:
    """Return 0..1 over time: smooth on and off, never shorter than its ramps or, for a seal, `SEAL_S`."""
    duration_s = utterance.end_s - utterance.start_s
    on_s = utterance.start_s + gesture.begin * duration_s - gesture.lead_s + shift_s
    off_s = utterance.start_s + gesture.end * duration_s + gesture.lag_s + shift_s
    off_s = max(off_s, on_s + (SEAL_S if gesture.seals else RAMP_S))
    rise = np.clip((times_s - on_s) / RAMP_S + 0.5, 0, 1)
    fall = np.clip((off_s - times_s) / RAMP_S + 0.5, 0, 1)
    return _smoothstep(rise) * _smoothstep(fall)


def _smoothstep(x: np.ndarray) -> np.ndarray:
    return x * x * (3 - 2 * x)
