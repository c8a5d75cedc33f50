"""Emotions, and emotion modifiers over time (the soft constraint of the search)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError

EMOTIONS: tuple[str, ...] = ("neutral", "happiness", "anger", "sadness")
EMOTION_INDEX: dict[str, int] = {name: e for e, name in enumerate(EMOTIONS)}

# Names that other corpora use for the same four.
_SYNONYMS = {
    "joy": "happiness", "happy": "happiness", "smile": "happiness", "angry": "anger",
    "sad": "sadness", "none": "neutral", "calm": "neutral", "outofbreath": "neutral",
}  # fmt: skip


def emotion_named(name: str) -> str:
    """Return the emotion of our set that ``name`` means; raises `UserFacingError` for an unknown one."""
    key = name.strip().lower()
    key = _SYNONYMS.get(key, key)
    if key not in EMOTION_INDEX:
        raise UserFacingError(f"'{name}' is not an emotion.", f"Known are {', '.join(EMOTIONS)}.")
    return key


@dataclass(frozen=True)
class EmotionModifier:
    """One painted span: ``emotion`` at ``intensity`` (0..1) from ``start_s`` to ``end_s``, in seconds."""

    start_s: float
    end_s: float
    emotion: str
    intensity: float = 1.0


def emotion_weights(
    starts_s: Sequence[float], ends_s: Sequence[float], modifiers: Sequence[EmotionModifier]
) -> np.ndarray:
    """Mix of emotions that each phoneme slot asks for.

    A slot takes the modifiers that cover it, each by its share of the slot's time and its intensity; what is
    left is neutral. Where modifiers overlap beyond 1 they are scaled to sum to 1.

    starts_s, ends_s : seconds, length n_slots
    returns : float64, shape (n_slots, n_emotions); rows sum to 1
    """
    starts, ends = np.asarray(starts_s, float), np.asarray(ends_s, float)
    weights = np.zeros((len(starts), len(EMOTIONS)))
    duration = np.maximum(ends - starts, 1e-9)
    for modifier in modifiers:
        overlap = np.minimum(ends, modifier.end_s) - np.maximum(starts, modifier.start_s)
        share = np.clip(overlap, 0, None) / duration
        weights[:, EMOTION_INDEX[modifier.emotion]] += modifier.intensity * np.minimum(share, 1.0)
    painted = weights.sum(axis=1)
    weights /= np.maximum(painted, 1.0)[:, None]
    weights[:, 0] += np.clip(1.0 - painted, 0.0, None)
    return weights
