"""Phrases of the paper's lengths, whatever sentences there are."""

from __future__ import annotations

import pytest

from core.evaluation.phrase_times import PAPER_TIMES_S, phrase_of, phrase_times_s
from core.speech.transcript import PhonemeUtterance, Transcript

SHORT = Transcript(
    tuple(PhonemeUtterance(p, 0.1 * i, 0.1 * i + 0.1) for i, p in enumerate(("pau", "b", "aa"))), (), 0.3
)


@pytest.mark.parametrize("n", [1, 3, 4, 14, 63])
def test_a_phrase_has_the_length_asked_for_and_no_gap(n):
    phrase = phrase_of([SHORT], n)
    assert phrase.phones == (("pau", "b", "aa") * 21)[:n]
    assert phrase.phonemes[0].start_s == 0.0 and phrase.duration_s == pytest.approx(0.1 * n)
    for before, after in zip(phrase.phonemes, phrase.phonemes[1:]):
        assert after.start_s == pytest.approx(before.end_s)


def test_every_length_of_table_5_is_timed_three_times():
    class Counter:
        name, lengths = "counter", []

        def prepare(self, progress=None):
            raise AssertionError("preparing is not timed")

        def synthesise(self, speech, progress=None):
            self.lengths.append(len(speech.transcript.phonemes))

    taken = phrase_times_s(Counter(), [SHORT])
    assert list(taken) == list(PAPER_TIMES_S) == [14, 24, 53, 63]
    assert Counter.lengths == [14] * 3 + [24] * 3 + [53] * 3 + [63] * 3
    assert all(0 <= seconds < 0.1 for seconds in taken.values())
