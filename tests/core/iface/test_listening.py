"""Levels, clipping, and sound that was lost without a word."""

from __future__ import annotations

import numpy as np
import pytest

from core.iface.listening import DropoutWatch, LevelMeter

RATE_HZ = 48_000


def test_the_level_of_a_sine_is_known():
    meter = LevelMeter(RATE_HZ)
    meter.accept(0.5 * np.sin(2 * np.pi * 1000 * np.arange(4800) / RATE_HZ))
    assert meter.peak_db == pytest.approx(-6.02, abs=0.01)
    assert meter.rms_db == pytest.approx(-9.03, abs=0.01)
    meter.accept(np.zeros(24_000))
    assert meter.rms_db == -90.0 and meter.peak_db == pytest.approx(-6.02 - 12.0, abs=0.01)


def test_clipped_samples_are_counted_and_exact_silence_is_timed():
    meter = LevelMeter(RATE_HZ)
    meter.accept(np.clip(3 * np.sin(np.arange(480) / 7), -1, 1))
    assert meter.clipped == int((np.abs(3 * np.sin(np.arange(480) / 7)) >= 0.999).sum()) > 100
    for _ in range(100):
        meter.accept(np.zeros(480))
    assert meter.silent_s == pytest.approx(1.0)
    meter.accept(np.r_[np.zeros(479), 1e-5])
    assert meter.silent_s == 0.0
    meter.accept(np.zeros(0))
    meter.accept(np.full(10, np.nan))
    assert np.isfinite([meter.rms_db, meter.peak_db]).all()


def arrivals(n_blocks, rng, clock=1.0):
    """When blocks of 10 ms come: up to 3 ms late each, by a clock that runs ``clock`` times as fast."""
    return 5.0 + clock * 0.01 * np.arange(1, n_blocks + 1) + rng.uniform(0, 0.003, n_blocks)


def watched(times_s):
    watch = DropoutWatch(RATE_HZ)
    for time_s in times_s:
        watch.accept(480, time_s)
    return watch


def test_sound_that_is_lost_is_counted_and_blocks_that_are_late_are_not():
    rng = np.random.default_rng(6)
    times_s = arrivals(3000, rng)
    late = times_s.copy()
    late[700:720] = late[719] + 0.001  # held up for 0.2 s, then all at once
    lossy = times_s.copy()
    lossy[1000:] += 0.030  # three blocks never came
    lossy[2000:] += 0.050
    rush = times_s.copy()
    rush[:150] = 5.0 + np.maximum(0.8, 0.01 * np.arange(1, 151) - 0.02)  # all that was gathered, and 20 ms too soon
    for quiet in (times_s, late, rush, arrivals(3000, rng, 1.0005), arrivals(3000, rng, 0.9995)):
        assert watched(quiet).dropouts == 0
    watch = watched(lossy)
    assert watch.dropouts == 2 and watch.lost_s == pytest.approx(0.080, abs=0.004)
