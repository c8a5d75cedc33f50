"""Splits, and a face that is measured beside captures: a ridge regression stands in for the trained ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core.errors import UserFacingError
from core.iface.comparison import (
    Part,
    Yardstick,
    by_emotion,
    compare,
    estimates,
    split_by_frame,
    split_by_time,
    through_units,
)
from core.iface.heard_takes import database_takes, recorded_takes
from core.iface.lessons import units_of
from core.iface.measures import largest_displacements, nearness


class RidgeFace:
    """Displacements of each emotion by ridge regression on the ten cepstra of a frame."""

    n_ahead = 0

    def __init__(self, takes):
        self.neutral = np.zeros(takes[0].displacements.shape[1:], np.float32)
        self.weights = {}
        for emotion in {take.emotion for take in takes}:
            said = [take for take in takes if take.emotion == emotion]
            x = np.concatenate([_with_one(take.features)[take.used] for take in said])
            y = np.concatenate([take.displacements[take.used] for take in said]).reshape(len(x), -1)
            self.weights[emotion] = np.linalg.solve(x.T @ x + 0.01 * np.eye(x.shape[1]), x.T @ y)
        self.expressions = tuple(sorted(set(self.weights) - {"neutral"}))

    def motion(self, features, strengths):
        (emotion, strength), *others = [*strengths.items()] or [("neutral", 1.0)]
        assert strength == 1.0 and not others
        moved = _with_one(features) @ self.weights[emotion]
        return self.neutral + moved.reshape(-1, *self.neutral.shape)


def _with_one(features):
    return np.column_stack([features[:, :10], np.ones(len(features))]).astype(float)


def train(takes, markers, progress):
    progress.step(1.0, "ridge")
    return RidgeFace(takes)


@pytest.fixture(scope="module")
def takes(loud_database):
    return database_takes(loud_database)


@pytest.fixture(scope="module")
def part(takes, loud_database):
    return Part(takes, recorded_takes(loud_database, loud_database.held_out_recordings("test")))


def test_by_frame_every_frame_is_trained_on_or_tested_on(takes):
    used = takes[0].used.copy()
    used[3:9] = False
    takes = [replace(takes[0], used=used), *takes[1:]]
    part, again = split_by_frame(takes), split_by_frame(takes)
    for take, train_take, test_take, same in zip(takes, part.train, part.test, again.train):
        np.testing.assert_array_equal(train_take.used | test_take.used, take.used)
        assert not (train_take.used & test_take.used).any()
        np.testing.assert_array_equal(train_take.used, same.used)
    counts = [sum(take.used.sum() for take in half) for half in (part.train, part.test)]
    assert counts[0] == round(0.8 * sum(counts))
    assert all(take.used[1:-1].any() and not take.used[1:-1].all() for take in part.test)


def test_by_time_a_gap_parts_what_is_trained_on_from_what_is_tested_on(takes):
    part = split_by_time(takes, share=0.5, gap_s=0.2)
    for take, train_take, test_take in zip(takes, part.train, part.test):
        cut = round(0.5 * len(take))
        np.testing.assert_array_equal(np.flatnonzero(train_take.used), np.arange(cut - 6))
        np.testing.assert_array_equal(np.flatnonzero(test_take.used), np.arange(cut, len(take)))
    with pytest.raises(UserFacingError, match="'s00' is too short"):
        split_by_time(takes, gap_s=10.0)


def test_each_emotion_is_measured_on_its_own_frames(takes):
    largest = largest_displacements(np.concatenate([take.displacements for take in takes]))
    spoken = [take.displacements * (0.5 if take.emotion == "anger" else 1.0) for take in takes]
    found = by_emotion(takes, spoken, largest)
    assert list(found) == ["neutral", "anger"]
    assert found["neutral"].r == pytest.approx(1.0) and found["neutral"].mse == 0.0
    assert found["anger"].r == pytest.approx(1.0)
    assert found["anger"].spread_estimated == pytest.approx(found["anger"].spread / 2)
    rows = np.array([4, 5])
    calm = np.concatenate([take.displacements[:, rows] for take in takes if take.emotion == "anger"])
    assert by_emotion(takes, spoken, largest, rows)["anger"] == pytest.approx(
        nearness(calm.astype(float), calm / 2.0, largest[rows])
    )


def test_frames_that_are_not_used_are_not_measured(takes):
    largest = largest_displacements(np.concatenate([take.displacements for take in takes]))
    part = split_by_frame(takes)
    spoiled = [np.where(take.used[:, None, None], take.displacements, 1e3) for take in part.test]
    assert all(found.mse == 0.0 for found in by_emotion(part.test, spoiled, largest).values())


def test_what_motion_units_span_passes_through_them(takes):
    units = units_of(takes, 2, 2)
    once = through_units(takes, units)
    for take, again in zip(once, through_units(once, units)):
        np.testing.assert_allclose(again.displacements, take.displacements, atol=1e-4)
    off = sum(((t.displacements - o.displacements) ** 2).sum() for t, o in zip(takes, once))
    assert 0 < off < 0.1 * sum((t.displacements**2).sum() for t in takes)


def test_a_face_that_hears_is_nearer_than_one_that_guesses(part, loud_database):
    found = compare(train, part, loud_database.markers)
    np.testing.assert_array_equal(Yardstick.of(part.train, loud_database.markers).mouth, [3, 4, 5])
    for measured in (found.train, found.test):
        assert list(measured) == ["all markers", "lips and jaw", "tracked"]
        assert all(list(by) == ["neutral", "anger"] for by in measured.values())
    for emotion in ("neutral", "anger"):
        assert 0.4 < found.test["lips and jaw"][emotion].r < 1.0
        assert found.train["tracked"][emotion].r > found.train["all markers"][emotion].r
    deaf = [np.roll(moved, 17, axis=0) for moved in estimates(found.face, part.test)]
    largest = largest_displacements(np.concatenate([take.displacements for take in part.train]))
    for emotion, nearness_of_deaf in by_emotion(part.test, deaf, largest).items():
        assert nearness_of_deaf.r < found.test["all markers"][emotion].r - 0.1


def test_what_is_tested_on_sets_no_scale(part, loud_database):
    wild = [replace(take, displacements=take.displacements + 100.0) for take in part.test]
    found = [compare(train, Part(part.train, test), loud_database.markers) for test in (part.test, wild)]
    assert found[0].train == found[1].train
    spreads = [compared.test["all markers"]["neutral"].spread for compared in found]
    assert spreads[0] == pytest.approx(spreads[1], rel=1e-4)
