"""Layers of pure emotions and how strong they are."""

import numpy as np
import pytest

from core.synthesis.concatenate import SlotFrames
from core.synthesis.emotion_strength import frame_strengths, is_mixed, pure_layers

SLOTS = SlotFrames(np.array([0, 20, 40, 40, 70]), np.array([20, 40, 40, 70, 90]))


def mix(*rows):
    return np.array(rows, float)


def test_pure_requests_are_not_mixed():
    assert not is_mixed(np.eye(4))
    assert is_mixed(mix([1, 0, 0, 0], [0.9, 0.1, 0, 0]))


def test_a_painted_span_is_one_layer_over_neutral():
    emotions = mix([1, 0, 0, 0], [0.4, 0, 0.6, 0], [0.4, 0, 0.6, 0], [1, 0, 0, 0], [1, 0, 0, 0])
    neutral, anger = pure_layers(emotions)
    assert np.array_equal(neutral[0], np.eye(4)[[0] * 5])
    assert np.array_equal(anger[0], np.eye(4)[[0, 2, 2, 0, 0]])
    shares = frame_strengths([neutral[1], anger[1]], SLOTS, 10)
    # beyond the span both layers are neutral, and go on as they are blended within it
    assert shares[1] == pytest.approx(np.full(90, 0.6))


@pytest.mark.parametrize("strength", [1.0, 0.25])
def test_shares_sum_to_one_and_full_strength_leaves_nothing_neutral(strength):
    rng = np.random.default_rng(1)
    emotions = strength * rng.dirichlet(np.ones(3), 5)
    emotions = np.column_stack([1.0 - emotions.sum(axis=1), emotions])
    layers = pure_layers(emotions)
    shares = frame_strengths([s for _, s in layers], SLOTS, 10)
    assert shares.sum(axis=0) == pytest.approx(np.ones(90))
    assert shares[0] == pytest.approx(np.full(90, 1.0 - strength))
    inner = [10, 30, 55, 80]
    for frame, slot in zip(inner, (0, 1, 3, 4)):
        asked = sum(share[frame] * layer[slot] for (layer, _), share in zip(layers, shares))
        assert asked == pytest.approx(emotions[slot], abs=1e-9)


def test_two_spans_of_one_emotion_each_share_a_layer():
    emotions = mix([0.5, 0.5, 0, 0], [0.5, 0.5, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 1, 0])
    layers = pure_layers(emotions)
    assert len(layers) == 2
    assert layers[1][0].argmax(axis=1).tolist() == [1, 1, 0, 2, 2]
    share = frame_strengths([s for _, s in layers], SLOTS, 10)[1]
    assert share[:34] == pytest.approx(0.5) and share[46:] == pytest.approx(1.0)
    assert (np.diff(share) >= -1e-12).all() and np.abs(np.diff(share)).max() < 0.06
