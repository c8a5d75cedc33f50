"""Lips of a face that heard beside the raw captures."""

from __future__ import annotations

import numpy as np

from core.evaluation.comparison import CapturedTruth
from core.iface.heard_takes import recorded_takes
from core.iface.lip_scores import captured_scores


class Parrot:
    """Says what it was given, sentence after sentence."""

    n_ahead = 0
    expressions = ("anger",)
    neutral = np.zeros((6, 3), np.float32)

    def __init__(self, said, faults=0.0):
        self._said, self._faults = iter(said), faults

    def motion(self, features, strengths):
        moved = next(self._said)
        assert len(moved) == len(features)
        off = self._faults * np.random.default_rng(1).normal(size=len(moved))
        return moved + off[:, None, None] * (np.arange(6) == 4)[None, :, None]


def test_captures_that_are_said_again_are_found_right_and_faults_show(loud_database):
    recordings = loud_database.held_out_recordings("test")
    said = [take.displacements for take in recorded_takes(loud_database, recordings)]
    right = captured_scores(Parrot(said), loud_database, recordings)
    assert right.lip_gap_r > 0.98 and right.error_mm2 < 0.3
    wrong = captured_scores(Parrot(said, 4.0), loud_database, recordings)
    assert wrong.lip_gap_r < 0.9 and wrong.error_mm2 > 5 * right.error_mm2
    truth = CapturedTruth.of(recordings[0], loud_database)
    assert truth.gap_mm(truth.positions).std() > 1.0  # there is something to follow
