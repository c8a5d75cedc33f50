"""How strong an emotion is: motions of pure emotions, blended frame by frame.

Deng and Neumann (2008) name emotion intensity as future work. An intensity within the search's penalty only reorders
whole motion nodes; here the same slots are solved for neutral speech and for the emotions painted on them, each pure,
and the frames are blended by the intensity. Intensity 0 is neutral, 1 is what a search for the pure emotions gives, and
what lies between moves on a straight line from one to the other.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.speech.emotion import EMOTION_INDEX
from core.synthesis.concatenate import SlotFrames

_NEUTRAL = EMOTION_INDEX["neutral"]


def is_mixed(emotions: np.ndarray) -> bool:
    """Whether some slot asks for anything but one pure emotion; ``emotions`` as in `SearchRequest`."""
    return bool((np.max(emotions, axis=1) < 1.0 - 1e-9).any())


def pure_layers(emotions: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Split a mix into searches for pure emotions.

    The first layer is neutral. The next asks, in each slot, for the strongest emotion painted there, a further one for
    the second strongest, and so on; a slot without one stays neutral.

    emotions : shape (n_slots, n_emotions), rows sum to 1
    returns : for each layer its pure emotions, shape (n_slots, n_emotions), one 1 a row, and its strength, shape
        (n_slots,); NaN where a layer has nothing painted and the strength is that of its surroundings. The neutral
        layer's strength is what the others leave
    """
    painted = np.array(emotions, float)
    painted[:, _NEUTRAL] = 0.0
    pure = np.eye(painted.shape[1])
    slots = np.arange(len(painted))
    layers = [(pure[np.full(len(painted), _NEUTRAL)], np.full(len(painted), np.nan))]
    order = np.argsort(-painted, axis=1, kind="stable")
    for rank in range(painted.shape[1] - 1):
        emotion = order[:, rank]
        strength = painted[slots, emotion]
        is_painted = strength > 0
        if not is_painted.any():
            break
        wanted = np.where(is_painted, emotion, _NEUTRAL)
        layers.append((pure[wanted], np.where(is_painted, strength, np.nan if rank == 0 else 0.0)))
    return layers


def frame_strengths(strengths: Sequence[np.ndarray], slots: SlotFrames, fade_frames: int) -> np.ndarray:
    """Strength of each layer at each frame, from `pure_layers`; float64, shape (n_layers, n_frames), columns sum to 1.

    A slot's strength holds over its frames, with straight fades of ``fade_frames`` about the boundaries where it
    changes; slots with NaN go from one neighbour's strength to the other's.
    """
    shares = []
    for strength in strengths[1:]:
        known = np.flatnonzero(~np.isnan(strength))
        per_slot = np.interp(np.arange(len(strength)), known, strength[known])
        per_frame = np.repeat(per_slot, np.maximum(slots.stop - slots.start, 0))
        per_frame = np.concatenate([per_frame, np.full(slots.n_frames - len(per_frame), per_slot[-1])])
        shares.append(_box_smoothed(per_frame, fade_frames))
    neutral = 1.0 - np.sum(shares, axis=0) if shares else np.ones(slots.n_frames)
    return np.stack([neutral, *shares])


def _box_smoothed(values: np.ndarray, width: int) -> np.ndarray:
    half = max(0, width // 2)
    padded = np.pad(values, half, mode="edge")
    sums = np.concatenate([[0.0], padded.cumsum()])
    return (sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (2 * half + 1)
