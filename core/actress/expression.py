"""What feeling does to the face besides speech: held expressions, accents on stressed words, blinks."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache

import numpy as np

from core.actress.randomness import Chance
from core.actress.texts import DEMO_FOLDER
from core.speech.transcript import Transcript

VOWELS = frozenset(("aa", "ae", "ah", "ao", "aw", "ay", "eh", "er", "ey", "iy", "ow", "oy", "uw"))
# A vowel is taken as stressed when it is this much longer than the sentence's median vowel.
STRESS_RATIO = 1.3
ACCENT_WIDTH_S = 0.12
# Brows start a little before the syllable that they underline.
ACCENT_LEAD_S = 0.06

BLINK_CLOSE_S, BLINK_SHUT_S, BLINK_OPEN_S = 0.09, 0.025, 0.17

LEFT_RIGHT_VARIATION = 0.07
# No face holds a feeling still: it differs from one utterance to the next, swells and fades within one (never quite
# to nothing, never beyond what the skin bears), and its parts do not all follow.
STRENGTH_VARIATION = 0.18
SWELL, SWELL_HZ = 0.42, (0.15, 0.9)
INTENSITY_LIMITS = (0.3, 1.3)
PART_DRIFT = 0.15


@dataclass(frozen=True)
class Manner:
    """How an emotion moves (a row of ``manners.csv``)."""

    effort: float
    pace: float
    seconds_between_blinks: float
    look_s: float
    away_share: float
    gaze_down_deg: float
    nod_deg: float
    sway_deg: float
    pitch_deg: float


@cache
def manners() -> dict[str, Manner]:
    """Return the manner of each emotion."""
    with open(DEMO_FOLDER / "manners.csv", encoding="utf-8", newline="") as lines:
        return {
            row["emotion"]: Manner(**{name: float(row[name]) for name in Manner.__dataclass_fields__})
            for row in csv.DictReader(lines)
        }


@cache
def _expression_rows() -> tuple[dict[str, str], ...]:
    with open(DEMO_FOLDER / "expressions.csv", encoding="utf-8", newline="") as lines:
        return tuple(csv.DictReader(lines))


def stressed_times_s(transcript: Transcript) -> list[float]:
    """Return the middles of the vowels that stand out by their length, in seconds."""
    vowels = [u for u in transcript.phonemes if u.phone in VOWELS]
    if not vowels:
        return []
    median_s = float(np.median([u.end_s - u.start_s for u in vowels]))
    return [(u.start_s + u.end_s) / 2 for u in vowels if u.end_s - u.start_s > STRESS_RATIO * median_s]


def accent_course(transcript: Transcript, times_s: np.ndarray) -> np.ndarray:
    """Return how strongly stress is underlined over time, 0..1, a little ahead of it; float64, shape (n_frames,)."""
    quiet = np.ones(len(times_s))
    for at_s in stressed_times_s(transcript):
        quiet *= 1 - np.exp(-0.5 * ((times_s - at_s + ACCENT_LEAD_S) / ACCENT_WIDTH_S) ** 2)
    return 1 - quiet


def expression(
    transcript: Transcript, emotion: str, times_s: np.ndarray, unit_names: tuple[str, ...], chance: Chance
) -> np.ndarray:
    """Return what the emotion adds to the face units, 0..1; float64, shape (n_frames, n_units).

    A row of ``expressions.csv`` that names a unit without its side drives both sides, not quite equally.
    """
    units = np.zeros((len(times_s), len(unit_names)))
    accent = accent_course(transcript, times_s)
    intensity = intensity_course(times_s, chance)
    for row in _expression_rows():
        if row["emotion"] != emotion:
            continue
        course = float(row["level"]) * intensity
        if row["kind"] == "accent":
            course *= accent * chance.between(0.6, 1.1)
        else:
            course *= 1 + PART_DRIFT * chance.drift(times_s, *SWELL_HZ)
        for u, name in enumerate(unit_names):
            if name in (row["unit"], row["unit"] + "Left", row["unit"] + "Right"):
                units[:, u] += course * (1 + LEFT_RIGHT_VARIATION * float(chance.normal(1)[0]))
    return units


def intensity_course(times_s: np.ndarray, chance: Chance) -> np.ndarray:
    """Return how strongly an emotion is felt over one utterance, 1 on average; float64, shape (n_frames,)."""
    strength = 1 + STRENGTH_VARIATION * float(chance.normal(1)[0])
    low, high = INTENSITY_LIMITS
    wave = strength * (1 + SWELL * chance.drift(times_s, *SWELL_HZ))
    # a smooth clip: the limits are approached, not hit
    middle, half = (high + low) / 2, (high - low) / 2
    return middle + half * np.tanh((wave - middle) / half)


def blink_times_s(end_s: float, seconds_between: float, chance: Chance) -> np.ndarray:
    """Return when blinks begin before ``end_s``; the first may come at any time within the first interval."""
    begin_s = []
    at_s = chance.between(0.15, seconds_between)
    while at_s < end_s:
        begin_s.append(at_s)
        at_s += seconds_between * chance.between(0.6, 1.5)
    return np.array(begin_s)


def blink_course(times_s: np.ndarray, begin_s: np.ndarray) -> np.ndarray:
    """Return how far the lids are closed over time, 0..1; float64, shape (n_frames,). They fall faster than they rise.

    begin_s : times at which the lids begin to fall
    """
    closed = np.zeros(len(times_s))
    for at_s in begin_s:
        falling = np.clip((times_s - at_s) / BLINK_CLOSE_S, 0, 1)
        rising = np.clip((times_s - at_s - BLINK_CLOSE_S - BLINK_SHUT_S) / BLINK_OPEN_S, 0, 1)
        closed = np.maximum(closed, 0.5 * (np.cos(np.pi * rising) - np.cos(np.pi * falling)))
    return closed
