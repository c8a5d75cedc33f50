"""What is heard is what stands at the time that the clock tells."""

from __future__ import annotations

import numpy as np
import pytest

from app.sound import Passage, Tape, samples_at
from core.media.audio import Audio

RATE_HZ = 8000


def test_at_the_recorded_speed_the_samples_are_the_recorded_ones():
    samples = np.random.default_rng(1).normal(size=500).astype(np.float32)
    places = Passage(0.01).at(np.arange(300) / RATE_HZ) * RATE_HZ
    assert np.array_equal(samples_at(samples, places), samples[80:380])


def test_backwards_the_samples_come_in_reverse_and_outside_is_silence():
    samples = np.arange(1, 101, dtype=np.float32)
    places = Passage(99 / RATE_HZ, -1.0).at(np.arange(150) / RATE_HZ) * RATE_HZ
    heard = samples_at(samples, places)
    assert np.array_equal(heard[:100], samples[::-1])
    assert not heard[100:].any()


def test_a_loop_repeats_its_span():
    passage = Passage(0.5, 2.0, (0.4, 0.9))
    assert passage.at(np.array([0.0, 0.1, 0.25, 0.5])) == pytest.approx([0.5, 0.7, 0.5, 0.5])


def test_a_tape_arrives_at_its_target_and_falls_silent():
    tone = np.sin(2 * np.pi * 400 * np.arange(RATE_HZ) / RATE_HZ).astype(np.float32)
    tape = Tape(Audio(tone, RATE_HZ), 0.2)
    tape.target_s = 0.4
    heard = np.concatenate([tape.read(64) for _ in range(60)])
    assert np.abs(heard[:800]).max() > 0.5
    assert not tape.read(64).any()
    tape.target_s = 0.1
    assert np.abs(tape.read(64)).max() > 0.1  # and runs back
