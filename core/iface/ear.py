"""Phones first: small perceptrons tell from fine cepstra which phone is heard, the face moves by what they tell.

How sounds differ is learned three times as often as there are frames, and before it is learned how mouths move.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.iface.fine_cepstra import N_FINE
from core.iface.perceptrons import Perceptron
from core.iface.speech_features import FINE_PER_FRAME, N_CEPSTRA

AROUND = 6  # windows that are heard before and after one
FRAMES_AROUND = AROUND // FINE_PER_FRAME
N_EAR_INPUTS = (2 * AROUND + 1) * N_FINE


def fine_rows(features: np.ndarray) -> np.ndarray:
    """Return the fine cepstra of frames (see `SpeechFeatureStream`) one after the other, shape (3 · n_frames, 20)."""
    return features[:, N_CEPSTRA:].reshape(-1, N_FINE)


def ear_windows(fine: np.ndarray, every: int = 1) -> np.ndarray:
    """Return what is heard around windows, oldest first, float32, shape (n, 260).

    fine : float32, shape (n_windows, 20); the first and the last 6 are only heard around others
    every : 1 for each of them, 3 for the last one of each frame, the first two frames and the last two left out
    """
    around = np.lib.stride_tricks.sliding_window_view(fine, 2 * AROUND + 1, axis=0)[every - 1 :: every]
    return np.ascontiguousarray(around.transpose(0, 2, 1)).reshape(len(around), -1)


def phone_shares(ears: Sequence[Perceptron], features: np.ndarray) -> np.ndarray:
    """Return how likely each phone is, the mean over ``ears``, float32, shape (n_frames - 4, n_phones).

    features : shape (n_frames, 70); the first and the last two frames are only heard around others
    """
    heard = ear_windows(fine_rows(features), FINE_PER_FRAME)
    return sum(shares(ear(heard)) for ear in ears) / np.float32(len(ears))


def shares(outputs: np.ndarray) -> np.ndarray:
    """Return e to the power of ``outputs``, brought to a sum of 1 in each row."""
    raised = np.exp(outputs - outputs.max(axis=1, keepdims=True))
    return raised / raised.sum(axis=1, keepdims=True)
