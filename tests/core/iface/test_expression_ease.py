"""Expressions come and go without a jump, never too strong, and the same from keys as from spans."""

from __future__ import annotations

import numpy as np
import pytest

from core.iface.expression_ease import ExpressionEase, eased_strengths, spans_of
from core.speech.emotion import EmotionModifier

NAMES = ("happiness", "anger", "sadness")


def run(ease, n):
    return np.array([list(ease.step().values()) for _ in range(n)])


def test_a_change_sets_out_gently_never_overshoots_and_is_nearly_done_after_a_third_of_a_second():
    ease = ExpressionEase(NAMES)
    ease.ask({"anger": 0.8})
    anger = run(ease, 60)[:, 1]
    steps = np.diff(anger, prepend=0.0)
    assert (steps > 0).all() and anger.max() <= 0.8
    assert steps[1] > steps[0] and steps.argmax() > 0  # it gathers speed before it slows down
    assert steps.max() < 0.8 * 0.2
    assert 0.85 * 0.8 < anger[10] < 0.97 * 0.8
    assert anger[-1] == pytest.approx(0.8, abs=1e-6)


def test_wild_keys_never_leave_what_strengths_may_be():
    rng, ease = np.random.default_rng(1), ExpressionEase(NAMES)
    for _ in range(200):
        ease.ask(dict(zip(NAMES, rng.uniform(-0.5, 1.5, 3))))
        rows = run(ease, int(rng.integers(1, 6)))
        assert rows.min() >= 0.0 and rows.max() <= 1.0 and rows.sum(axis=1).max() <= 1.0 + 1e-12


def test_it_is_two_lags_one_behind_the_other():
    """Against scipy's filter of the same poles."""
    from scipy.signal import lfilter

    asked = np.repeat([0.0, 1.0, 0.3, 0.0], 25)
    ease, got = ExpressionEase(("anger",)), []
    for strength in asked:
        ease.ask({"anger": strength})
        got.append(ease.step()["anger"])
    step = 1 - np.exp(-1 / 30 / 0.09)
    lag = ([step], [1, step - 1])
    np.testing.assert_allclose(got, lfilter(*lag, lfilter(*lag, asked)), atol=1e-12)


def test_keys_kept_as_spans_give_the_strengths_that_were_shown():
    rng = np.random.default_rng(2)
    emotions, asked = ("neutral", *NAMES), []
    while len(asked) < 300:
        key = emotions[rng.integers(4)], float(rng.uniform(0.2, 1.0))
        asked += [key if key[0] != "neutral" else ("neutral", 0.0)] * int(rng.integers(1, 40))
    ease, shown = ExpressionEase(NAMES, {} if asked[0][0] == "neutral" else dict([asked[0]])), []
    for emotion, intensity in asked:
        ease.ask({emotion: intensity})
        shown.append(list(ease.step().values()))
    again = eased_strengths(NAMES, spans_of(asked), len(asked))
    np.testing.assert_allclose(np.stack([again[name] for name in NAMES], axis=1), shown, atol=1e-12)


def test_spans_are_one_for_each_run_and_none_for_neutral():
    asked = [("neutral", 0.0)] * 3 + [("anger", 1.0)] * 6 + [("anger", 0.5)] * 3 + [("neutral", 0.0)] * 2
    assert spans_of(asked) == (EmotionModifier(0.1, 0.3, "anger", 1.0), EmotionModifier(0.3, 0.4, "anger", 0.5))
    assert spans_of([]) == ()


def test_spans_that_overlap_are_scaled_and_strange_emotions_left_out():
    spans = [EmotionModifier(0.0, np.inf, "anger", 1.0), EmotionModifier(0.0, 9.0, "sadness", 1.0),
             EmotionModifier(0.0, 9.0, "boredom", 1.0)]  # fmt: skip
    strengths = eased_strengths(NAMES, spans, 5)
    np.testing.assert_allclose([strengths["anger"][0], strengths["sadness"][4]], 0.5)
    assert set(strengths) == set(NAMES)
    assert eased_strengths((), spans, 5) == {} and eased_strengths(NAMES, spans, 0)["anger"].shape == (0,)
