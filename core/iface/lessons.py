"""Takes as faces are trained on them: what is heard around each frame, and the motion units that it moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from core.errors import UserFacingError
from core.iface.heard_takes import HeardTake
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.iface.speech_features import N_CEPSTRA
from core.iface.unit_face import windows
from core.speech.emotion import EMOTIONS

_QUIETEST = 0.05  # of all frames are taken for silence


def usable_takes(takes: Sequence[HeardTake]) -> list[HeardTake]:
    """Return the takes that teach something: those with frames in use, of emotions with two frames or more.

    Raises `UserFacingError` when none is neutral: every expression is learned on top of neutral speech.
    """
    n_used: dict[str, int] = {}
    for take in takes:
        n_used[take.emotion] = n_used.get(take.emotion, 0) + int(take.used.sum())
    if n_used.get(NEUTRAL, 0) < 2:
        raise UserFacingError("There is no neutral speech to train on.", "Record some sentences without expression.")
    return [take for take in takes if n_used[take.emotion] >= 2 and take.used.any()]


def units_of(takes: Sequence[HeardTake], n_utterance: int | float, n_expression: int | float) -> MotionUnits:
    """Learn motion units from the used frames; see `MotionUnits.fit`."""
    emotions = [e for e in EMOTIONS if any(take.emotion == e for take in takes)]
    return MotionUnits.fit(
        {e: np.concatenate([t.displacements[t.used] for t in takes if t.emotion == e]) for e in emotions},
        n_utterance, n_expression,
    )  # fmt: skip


def silence_of(takes: Sequence[HeardTake]) -> np.ndarray:
    """Return the mean features of the quietest frames, float32, shape (70,); the first cepstrum is the log energy."""
    heard = np.concatenate([take.features for take in takes])
    return heard[heard[:, 0] <= np.quantile(heard[:, 0], _QUIETEST)].mean(axis=0).astype(np.float32)


def averaged(takes: Sequence[HeardTake]) -> list[HeardTake]:
    """Return ``takes`` with the first ten features only, the cepstra that the paper's face hears."""
    return [replace(take, features=take.features[:, :N_CEPSTRA]) for take in takes]


def heard_windows(takes: Sequence[HeardTake], n_back: int, n_ahead: int, silence: np.ndarray) -> np.ndarray:
    """Return what is heard around each used frame, float32, shape (n_used, (n_back + 1 + n_ahead) · n_features)."""
    before, after = np.broadcast_to(silence, (n_back, len(silence))), np.broadcast_to(silence, (n_ahead, len(silence)))
    laid = (windows(np.concatenate([before, t.features, after]), len(t))[t.used] for t in takes)
    return np.concatenate(list(laid)).astype(np.float32)


def shown_parameters(takes: Sequence[HeardTake], units: MotionUnits) -> np.ndarray:
    """Return the MUPs of the used frames of takes of one emotion, float64, shape (n_used, n_parameters)."""
    return np.concatenate([units.parameters(t.displacements[t.used], t.emotion) for t in takes])


def heard_in_noise(take: HeardTake, which: int) -> HeardTake:
    """Return ``take`` as it is heard in noise."""
    return replace(take, features=take.in_noise[which])
