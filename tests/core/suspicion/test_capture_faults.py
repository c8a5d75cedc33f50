"""Each fault of a capture, put into a raw track of one marker, is found in its span and called by its name."""

from __future__ import annotations

import numpy as np
import pytest

from core.suspicion.capture_faults import Fault, capture_faults

RATE_HZ = 120.0
SPAN_FRAMES = 12
N_SPANS = 60
SPAN = 25
FIRST, STOP = SPAN * SPAN_FRAMES, (SPAN + 1) * SPAN_FRAMES


@pytest.fixture
def track():
    """A marker that swings by some millimetres at 2 to 4 Hz, seen with 0.1 mm of noise."""
    rng = np.random.default_rng(11)
    times_s = np.arange(N_SPANS * SPAN_FRAMES)[:, None] / RATE_HZ
    swing = np.array([3.0, 5.0, 2.0]) * np.sin(2 * np.pi * np.array([2.0, 3.1, 3.7]) * times_s)
    return swing + rng.normal(0, 0.1, swing.shape)


def worst(track):
    starts = np.arange(N_SPANS) * SPAN_FRAMES
    found = capture_faults(track, RATE_HZ, [(0, len(track))], starts, starts + SPAN_FRAMES)
    table = {fault: scores.score for fault, scores in found.items()}
    fault = max(table, key=lambda f: table[f].max())
    return fault, int(table[fault].argmax()), float(table[fault].max())


def test_a_reflection_for_two_frames_is_a_spike(track):
    track[FIRST + 5 : FIRST + 7] += [6.0, 8.0, 0.0]
    assert worst(track)[:2] == (Fault.SPIKE, SPAN)


def test_standing_elsewhere_through_the_span_is_a_swap(track):
    track[FIRST:STOP] += [0.0, 9.0, 4.0]
    assert worst(track)[:2] == (Fault.SWAP, SPAN)


def test_creeping_away_and_snapping_back_is_a_drift(track):
    track[FIRST:STOP] += np.linspace(0, 1, SPAN_FRAMES)[:, None] ** 1.5 * [7.0, 0.0, 5.0]
    assert worst(track)[:2] == (Fault.DRIFT, SPAN)


def test_standing_still_while_the_marker_moves_on_is_a_freeze(track):
    track[FIRST:STOP] = track[FIRST]
    assert worst(track)[:2] == (Fault.FREEZE, SPAN)


def test_a_sound_track_is_hardly_suspected(track):
    assert worst(track)[2] < 8  # the faults above score 30 and more
    for spoil in (6.0, -6.0):
        spoilt = track.copy()
        spoilt[FIRST + 4] += spoil
        assert worst(spoilt)[2] > 30
