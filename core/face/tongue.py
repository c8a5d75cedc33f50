"""What the tongue does in speech, from phones and times: a track of its own, because no marker sees it."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np

from core.speech.phoneme import PAU
from core.speech.transcript import Transcript

TONGUE_FILE = Path(__file__).resolve().parents[2] / "resources" / "face" / "tongue.csv"
COLUMNS = ("tip", "back", "advance")

# A tongue tip takes about a tenth of a second from one target to the next.
OVERLAP_S = 0.032


@cache
def tongue_targets() -> dict[str, tuple[float, float, float, float]]:
    """Return for each phone of our set: tip height, height of the back, advance, and how firmly it is held.

    Heights run from 0 (as the jaw carries it) to 1 (at the ridge behind the upper teeth, at the palate), advance from
    -1 (drawn back) to 1 (between the teeth). From ``resources/face/tongue.csv``, where each row has its reason.
    """
    with open(TONGUE_FILE, encoding="utf-8", newline="") as file:
        return {
            row["phone"]: (float(row["tip"]), float(row["back"]), float(row["advance"]), float(row["hold"]))
            for row in csv.DictReader(file)
        }


def tongue_track(transcript: Transcript, rate_hz: float, n_frames: int) -> np.ndarray:
    """Return tip height, height of the back and advance in each frame; float32, shape (n_frames, 3).

    Frame f stands at f / rate_hz. Each phone pulls towards its target while it is said and a little before and after,
    the more firmly held the stronger; between them the track is smooth, and short phones undershoot.
    """
    targets = tongue_targets()
    time_s = np.arange(n_frames) / rate_hz
    pulled, total = np.zeros((n_frames, 3)), np.full(n_frames, 1e-6)
    pulled += 1e-6 * np.array(targets[PAU][:3])
    for utterance in transcript.phonemes:
        tip, back, advance, hold = targets[utterance.phone]
        rises = np.tanh((time_s - utterance.start_s) / OVERLAP_S)
        falls = np.tanh((time_s - utterance.end_s) / OVERLAP_S)
        pull = hold * np.maximum(rises - falls, 0.0) / 2
        pulled += pull[:, None] * np.array([tip, back, advance])
        total += pull
    return (pulled / total[:, None]).astype(np.float32)
