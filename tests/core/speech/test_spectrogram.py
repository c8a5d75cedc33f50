"""A spectrogram shows what is in the sound: tones at their pitch, clicks at their time, whatever the length."""

from __future__ import annotations

import numpy as np
import pytest

from core.media.audio import Audio
from core.speech.spectrogram import Spectrogram

RATE_HZ = 16_000


def tone(hz: float, seconds: float, rate_hz: int = RATE_HZ) -> Audio:
    return Audio(np.sin(2 * np.pi * hz * np.arange(round(seconds * rate_hz)) / rate_hz).astype(np.float32), rate_hz)


@pytest.mark.parametrize(("hz", "rate_hz"), [(500.0, RATE_HZ), (3000.0, RATE_HZ), (3000.0, 44_100)])
def test_a_tone_lies_at_its_pitch(hz, rate_hz):
    spectrogram = Spectrogram.of(tone(hz, 0.5, rate_hz))
    bands_hz = np.linspace(0.0, spectrogram.top_hz, len(spectrogram.levels))
    assert bands_hz[spectrogram.levels[:, 100].argmax()] == pytest.approx(hz, abs=70.0)


def test_a_click_lies_at_its_time():
    samples = np.zeros(RATE_HZ, np.float32)
    samples[4000] = 1.0
    spectrogram = Spectrogram.of(Audio(samples, RATE_HZ))
    loudest = spectrogram.levels.astype(int).sum(axis=0).argmax()
    assert loudest * spectrogram.column_s == pytest.approx(0.25, abs=spectrogram.column_s)


def test_a_long_sound_is_the_same_as_its_parts():
    rng = np.random.default_rng(5)
    samples = rng.normal(size=20 * RATE_HZ).astype(np.float32)
    long = Spectrogram.of(Audio(samples, RATE_HZ)).levels.astype(int)
    assert long.shape[1] == 10_000  # more than is worked on at once
    late = Spectrogram.of(Audio(samples[17 * RATE_HZ :], RATE_HZ)).levels.astype(int)
    # the loudest moment of each sets its scale, so they differ by one shift
    difference = (long[:, 8500 + 20 :] - late[:, 20:])[(long[:, 8520:] > 0) & (late[:, 20:] > 0)]
    assert np.ptp(difference) <= 2


@pytest.mark.parametrize("n_samples", [1, 20, 100])
def test_the_shortest_sounds_and_silence_have_one(n_samples):
    levels = Spectrogram.of(Audio(np.zeros(n_samples, np.float32), RATE_HZ)).levels
    assert levels.shape[1] >= 1
