"""What sound cannot tell bounds R."""

from __future__ import annotations

import numpy as np
import pytest

from core.actress.corpus import comparison_sentences, record
from core.iface.ceiling import ceiling, said_again
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
