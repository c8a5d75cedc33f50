"""A dragged vowel, and whether its shape stays."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.animeme import form as forms
from core.animeme.dragging import dragged, wander_when_dragged

PRINTED = replace(forms.PRINTED, emotion_degree=-1)  # all that is said here is neutral


def test_dragging_moves_what_follows_and_nothing_before(babble):
    (transcript,) = babble(1)
    sung = dragged(transcript, 4, 2.0)
    said, was = sung.phonemes[4], transcript.phonemes[4]
    assert (said.start_s, said.end_s) == (was.start_s, pytest.approx(was.start_s + 2.0))
    assert sung.phonemes[:4] == transcript.phonemes[:4]
    for before, after in zip(transcript.phonemes[5:], sung.phonemes[5:]):
        assert after.end_s - after.start_s == pytest.approx(before.end_s - before.start_s)
    assert sung.duration_s == pytest.approx(sung.phonemes[-1].end_s)


def test_a_held_vowel_stays_and_a_printed_one_wanders(known_model, babble):
    model, transcripts = known_model(replace(PRINTED, spread="time", edge=1.25)), babble(4)
    held, printed = (wander_when_dragged(model, transcripts, "jawOpen", holds=holds) for holds in (True, False))
    assert held < 0.2 * printed
