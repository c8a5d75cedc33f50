"""The waveform keeps every extreme, however far it is zoomed out."""

from __future__ import annotations

import numpy as np
import pytest

from app.panels.timeline.lanes import TimeScale
from app.panels.timeline.wave import Peaks
from core.media.audio import Audio


def test_columns_hold_the_extremes_of_their_samples():
    rng = np.random.default_rng(3)
    samples = rng.uniform(-1, 1, 16_000).astype(np.float32)
    peaks = Peaks.of(Audio(samples, 16_000), block_s=0.001)
    edges_s = np.linspace(0.0, 0.96, 13)  # on block boundaries
    low, high = peaks.columns(edges_s)
    for k in range(12):
        part = samples[round(edges_s[k] * 16_000) : round(edges_s[k + 1] * 16_000)]
        assert (low[k], high[k]) == (part.min(), part.max())


def test_a_single_click_in_a_long_silence_is_not_lost():
    samples = np.zeros(48_000 * 60, np.float32)
    samples[48_000 * 41 + 7] = 0.9
    peaks = Peaks.of(Audio(samples, 48_000))
    _, high = peaks.columns(np.linspace(0.0, 60.0, 301))
    assert high.max() == pytest.approx(0.9)
    assert np.flatnonzero(high > 0.5).tolist() == [205]


@pytest.mark.parametrize("n_samples", [1, 31, 32, 33])
def test_the_shortest_sounds_can_be_drawn_wider_than_they_are(n_samples):
    peaks = Peaks.of(Audio(np.ones(n_samples, np.float32), 16_000))
    low, high = peaks.columns(np.linspace(0.0, 1.0, 50))
    assert len(low) == len(high) == 49
    assert high.max() == 1.0


def test_time_and_place_are_inverse():
    scale = TimeScale(1.25, 320.0, 72.0)
    for time_s in (0.0, 1.25, 7.5):
        assert scale.time_s(scale.x(time_s)) == pytest.approx(time_s)
    assert scale.x(1.25) == 72.0
