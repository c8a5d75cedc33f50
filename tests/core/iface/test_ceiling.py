"""What sound cannot tell bounds R."""

from __future__ import annotations

import numpy as np
import pytest

from core.actress.corpus import comparison_sentences, record
from core.iface.ceiling import ceiling, reached, said_again
from core.iface.heard_takes import HeardTake
from core.iface.measures import nearness


def test_the_best_estimate_reaches_the_ceiling_and_no_other_does():
    rng = np.random.default_rng(1)
    told = rng.normal(size=(20_000, 3, 3))
    first, second = (told + 0.6 * rng.normal(size=told.shape) for _ in range(2))
    largest = np.array([1.0, 2.0, 3.0])
    top = ceiling([first, second], largest)
    assert top == pytest.approx(1 / np.sqrt(1.36), abs=0.005)
    assert nearness(first, told, largest).r == pytest.approx(top, abs=0.005)
    assert nearness(first, second, largest).r < top - 0.05


def test_takes_without_anything_in_common_leave_nothing_to_reach():
    rng = np.random.default_rng(2)
    first = rng.normal(size=(50, 2, 3))
    assert ceiling([first, -first], np.ones(2)) == 0.0
    with pytest.raises(ValueError, match="two takes"):
        ceiling([first], np.ones(2))


def test_with_the_sentences_own_seed_it_is_the_recording_of_the_corpus():
    spoken = comparison_sentences()[0]
    said, again = record(spoken), said_again(spoken, spoken.sentence)
    np.testing.assert_array_equal(again.positions, said.positions)
    assert (again.marker_names, again.transcript, again.emotion) == (said.marker_names, said.transcript, said.emotion)
    other = said_again(spoken, "another seed")
    assert other.positions.shape == said.positions.shape and other.transcript == said.transcript
    assert 0.5 < np.nanmax(np.abs(other.positions - said.positions)) < 60.0


def test_what_sound_tells_reaches_all_of_the_ceiling_emotion_by_emotion():
    rng = np.random.default_rng(3)
    told = [rng.normal(size=(4000, 3, 3)) for _ in range(4)]
    noise = {"neutral": 0.2, "anger": 1.0}
    emotions = ["neutral", "anger", "neutral", "anger"]

    def say():
        used = np.arange(4000) < 3900
        takes = []
        for moved, emotion in zip(told, emotions):
            seen = moved + noise[emotion] * rng.normal(size=moved.shape)
            seen[~used] = 1e3
            takes.append(HeardTake("s", emotion, None, None, seen, used))
        return takes

    found = reached(told, [say(), say()], np.ones(3))
    assert list(found) == ["neutral", "anger"]
    for emotion, (top, r, share) in found.items():
        assert top == pytest.approx(1 / np.sqrt(1 + noise[emotion] ** 2), abs=0.01)
        assert r == pytest.approx(top, abs=0.01) and share == pytest.approx(r / top)
    dull = [t + rng.normal(size=t.shape) for t in told]
    assert all(row.share < 0.8 for row in reached(dull, [say(), say()], np.ones(3), np.array([0, 2])).values())
