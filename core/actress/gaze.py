"""Where she looks: a track of its own, since no marker sits on an eye."""

from __future__ import annotations

import numpy as np

from core.actress.randomness import Chance

# Saccades are short; amplitude adds to their time (the main sequence: about 2 ms a degree).
SACCADE_S, SACCADE_S_PER_DEG = 0.021, 0.0022
# She talks to somebody: most looks stay near the listener's face, some wander while a thought forms.
NEAR_DEG, AWAY_DEG = 1.6, 8.0
TREMOR_DEG = 0.06


def gaze_course(
    times_s: np.ndarray, look_s: float, away_share: float, down_deg: float, blinks_s: np.ndarray, chance: Chance
) -> np.ndarray:
    """Return the angles of both eyes in the head; float64, shape (n_frames, 2), degrees: yaw (her left), pitch (up).

    look_s : mean length of a look
    away_share : share of the looks that leave the listener, 0..1
    down_deg : by how much they hang
    blinks_s : times of blinks; the eyes like to move under closing lids
    """
    end_s = times_s[-1] if len(times_s) else 0.0
    starts_s, now_s = [], chance.between(0.0, look_s)
    while now_s < end_s:
        starts_s.append(now_s)
        now_s += look_s * chance.between(0.35, 1.65)
    starts_s = sorted({*starts_s, *(float(at_s) for at_s in blinks_s)})

    angles = np.zeros((len(times_s), 2))
    here = np.array([0.0, -down_deg]) + NEAR_DEG * chance.normal(2)
    angles += here
    for at_s in starts_s:
        wide = chance.between(0, 1) < away_share
        spread = np.array([1.0, 0.6]) * (AWAY_DEG if wide else NEAR_DEG)
        there = np.array([0.0, -down_deg]) + spread * np.clip(chance.normal(2), -2, 2)
        length_s = SACCADE_S + SACCADE_S_PER_DEG * float(np.linalg.norm(there - here))
        part = np.clip((times_s - at_s) / length_s, 0, 1)
        angles += (part * part * (3 - 2 * part))[:, None] * (there - here)
        here = there
    angles += TREMOR_DEG * np.stack([chance.drift(times_s, 1.0, 6.0) for _ in range(2)], axis=1)
    return angles
