"""What a brush leaves behind, compared with painting on a fine grid of moments."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from core.speech.emotion import EMOTIONS, EmotionModifier
from core.speech.emotion_painting import erased, painted

STEP_S = 0.125
N_MOMENTS = 32

intensities = st.sampled_from([0.0, 0.5, 1.0])
strokes = st.tuples(st.integers(0, N_MOMENTS - 1), st.integers(1, N_MOMENTS), st.sampled_from(EMOTIONS), intensities)


def on_grid(modifiers) -> np.ndarray:
    """Intensity of each emotion at each moment; there is one span of an emotion at a time."""
    grid = np.zeros((N_MOMENTS, len(EMOTIONS)))
    moments_s = (np.arange(N_MOMENTS) + 0.5) * STEP_S
    for modifier in modifiers:
        inside = (moments_s > modifier.start_s) & (moments_s < modifier.end_s)
        assert not grid[inside, EMOTIONS.index(modifier.emotion)].any(), "two spans of one emotion overlap"
        grid[inside, EMOTIONS.index(modifier.emotion)] = modifier.intensity
    return grid


@given(st.lists(strokes, max_size=12))
def test_strokes_equal_painting_moment_by_moment(made):
    modifiers: tuple[EmotionModifier, ...] = ()
    expected = np.zeros((N_MOMENTS, len(EMOTIONS)))
    for first, length, emotion, intensity in made:
        stop = min(first + length, N_MOMENTS)
        modifiers = painted(modifiers, first * STEP_S, stop * STEP_S, emotion, intensity)
        if emotion == "neutral":
            expected[first:stop] = 0.0
        else:
            expected[first:stop, EMOTIONS.index(emotion)] = intensity
    assert np.array_equal(on_grid(modifiers), expected)


def test_a_span_without_end_is_cut_in_two():
    whole = (EmotionModifier(0.0, math.inf, "anger", 1.0),)
    assert erased(whole, 1.0, 2.0) == (
        EmotionModifier(0.0, 1.0, "anger", 1.0), EmotionModifier(2.0, math.inf, "anger", 1.0),
    )  # fmt: skip


def test_touching_strokes_of_one_strength_are_one_span():
    modifiers = painted((), 0.0, 1.0, "sadness", 0.5)
    assert painted(modifiers, 1.0, 2.0, "sadness", 0.5) == (EmotionModifier(0.0, 2.0, "sadness", 0.5),)
